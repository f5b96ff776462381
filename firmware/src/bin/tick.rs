#![no_std]
#![no_main]
//! What interrupts and link can reach: sampling, tick and main loop, with recorder, drop log and flash driver, over registers of no
//! chip. Linked to be looked at, never run. A panic handler or soft-float f64 among its symbols is reachable: `cargo xtask budget`.

use core::panic::PanicInfo;

use touchdown_core::event::Notice;
use touchdown_core::oversampling::ConverterConfig;
use touchdown_core::sample::Sample;
use touchdown_firmware::board::silicon::{Bus, CycleDelay, SpiRegisters};
use touchdown_firmware::board::{Abilities, Board};
use touchdown_firmware::drop_log::DropLog;
use touchdown_firmware::intake::Intake;
use touchdown_firmware::main_loop::MainLoop;
use touchdown_firmware::platform::Platform;
use touchdown_firmware::tick::TickTask;
use touchdown_firmware::w25q::W25q;
use touchdown_protocol::controller::Shown;
use touchdown_protocol::link::{Frame, Refusal};

/// Registers that notices and outputs go to.
struct Bare(&'static [u8]);

const REGISTER: *mut u8 = 0x4000_0000 as *mut u8;

fn read() -> u8 {
    // SAFETY: never run.
    unsafe { REGISTER.read_volatile() }
}

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
        plants::in_tick(self.0, outputs.bits());
        write(outputs.bits());
    }

    fn config(&self) -> &[u8] {
        self.0
    }

    fn feed(&mut self) {
        write(0);
    }
}

/// A panic each, where the index is too large. The tick reaches the first, an order that the link's parser took the
/// second, and the flash driver the third, from what it is to write.
#[cfg(feature = "plants")]
mod plants {
    /// And f64 in software.
    #[inline(never)]
    pub fn in_tick(bytes: &[u8], index: u8) {
        let byte = bytes[usize::from(index)];
        let quotient = f64::from(byte) / f64::from(index) + f64::from(byte) * 1e-3;
        super::write((quotient as u64 ^ quotient.to_bits()) as u8);
    }

    #[inline(never)]
    pub fn behind_link(block: &[u8]) {
        super::write(block[usize::from(super::read()) + 40]);
    }

    #[inline(never)]
    pub fn in_flash(bytes: &[u8]) {
        super::write(bytes[usize::from(super::read())] ^ 1);
    }
}

/// Registers of flash.
struct BareSpi;

impl SpiRegisters for BareSpi {
    type Wait = CycleDelay<168>;

    fn select(&mut self, is_on: bool) {
        write(is_on.into());
    }

    fn exchange(&mut self, byte: u8) -> u8 {
        #[cfg(feature = "plants")]
        plants::in_flash(&[byte]);
        write(byte);
        read()
    }
}

type BareLog = DropLog<W25q<Bus<BareSpi>, CycleDelay<168>>, 42>;

struct BarePlatform {
    tick: TickTask<'static, Bare>,
    log: Option<BareLog>,
}

impl Platform for BarePlatform {
    type Board = Bare;
    type Log = BareLog;

    fn abilities(&self) -> Abilities {
        Abilities {
            converter: ConverterConfig {
                rate: f32::from(read()),
                full_scale: 4_095,
            },
            cycles: f32::from(read()),
            tachometers: false,
        }
    }

    fn hold<T>(&mut self, act: impl FnOnce(&mut TickTask<'static, Bare>) -> T) -> T {
        act(&mut self.tick)
    }

    fn receive(&mut self) -> Option<u8> {
        // Any byte: without the 0 that ends a frame no parser would be linked.
        (read() > 0).then(read)
    }

    fn send(&mut self, frame: &Frame) -> bool {
        frame.iter().for_each(|it| write(*it));
        true
    }

    fn is_idle(&mut self) -> bool {
        read() > 0
    }

    fn is_sent(&mut self) -> bool {
        read() > 0
    }

    fn log(&mut self) -> &mut Option<BareLog> {
        &mut self.log
    }

    fn store(&mut self, block: &[u8]) -> Result<(), Refusal> {
        #[cfg(feature = "plants")]
        plants::behind_link(block);
        block.iter().for_each(|it| write(*it));
        Ok(())
    }

    fn age_us(&mut self) -> u32 {
        read().into()
    }

    fn unknown(&mut self) -> u64 {
        read().into()
    }

    fn forget_reset(&mut self) {
        write(0);
    }

    fn reset(&mut self) {
        write(0);
    }
}

/// All the linker keeps hangs on this.
#[unsafe(no_mangle)]
extern "C" fn _start(
    intake: &mut Intake<'static>,
    platform: &mut BarePlatform,
    main_loop: &mut MainLoop,
    sample: &Sample,
    lost: u32,
) {
    if intake.take((*sample).into(), lost) {
        write(0);
    }
    while platform.tick.step() {}
    main_loop.turn(platform);
}

#[panic_handler]
fn panic(_: &PanicInfo) -> ! {
    loop {
        write(1);
    }
}
