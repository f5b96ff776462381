#![cfg_attr(target_os = "none", no_std, no_main)]
//! The tick, the forecast below it, and nothing else: linked to be looked at, never run. A panic handler or soft-float f64 among its
//! symbols is reachable from them: `cargo xtask budget`.

#[cfg(target_os = "none")]
mod image {
    use core::panic::PanicInfo;

    use touchdown_core::event::{Notice, Notices};
    use touchdown_core::forecast::ForecastTask;
    use touchdown_core::sample::Sample;
    use touchdown_firmware::app::App;
    use touchdown_firmware::board::Board;
    use touchdown_firmware::recorder::Recorder;
    use touchdown_firmware::tick::tick;
    use touchdown_protocol::controller::Shown;

    /// Registers that notices and outputs go to.
    struct Bare(&'static [u8]);

    const REGISTER: *mut u8 = 0x4000_0000 as *mut u8;

    fn write(byte: u8) {
        // SAFETY: never run.
        unsafe { REGISTER.write_volatile(byte) }
    }

    impl Board for Bare {
        fn report(&mut self, notice: &Notice) {
            write(matches!(notice, Notice::Declared(_)) as u8);
        }

        fn drive(&mut self, shown: Shown) {
            let outputs = shown.outputs;
            #[cfg(feature = "plants")]
            plant(self.0, outputs.bits());
            write(outputs.bits());
        }

        fn config(&self) -> &[u8] {
            self.0
        }

        fn service(&self) -> bool {
            false
        }

        fn feed(&mut self) {
            write(0);
        }
    }

    /// A panic where the index is too large, and f64 in software.
    #[cfg(feature = "plants")]
    fn plant(bytes: &[u8], index: u8) {
        let byte = bytes[usize::from(index)];
        let quotient = f64::from(byte) / f64::from(index) + f64::from(byte) * 1e-3;
        write((quotient as u64 ^ quotient.to_bits()) as u8);
    }

    /// All the linker keeps hangs on this.
    #[unsafe(no_mangle)]
    extern "C" fn _start(
        app: &mut App,
        recorder: &mut Recorder<'static>,
        config: &'static &'static [u8],
        sample: &Sample,
        lost: u32,
        notices: &mut Notices,
        forecast_task: &mut ForecastTask,
    ) {
        tick(app, recorder, &mut Bare(config), sample, lost, notices);
        if let Some(outlook) = forecast_task.work(&app.forecast_input(forecast_task.wants_input()))
        {
            recorder.hear(&outlook);
        }
    }

    #[panic_handler]
    fn panic(_: &PanicInfo) -> ! {
        loop {
            write(1);
        }
    }
}

#[cfg(not(target_os = "none"))]
fn main() {
    println!("touchdown-tick is never run: cargo xtask budget looks at it");
}
