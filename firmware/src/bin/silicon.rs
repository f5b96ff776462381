#![cfg_attr(target_os = "none", no_std, no_main)]
//! The image for silicon; on the desktop it says how to build and flash itself.

#[cfg(target_os = "none")]
mod image {
    use cortex_m_rt::entry;
    use defmt_rtt as _;
    use panic_probe as _;
    use stm32f4::stm32f405::interrupt;
    use touchdown_firmware::board::default_config;
    use touchdown_firmware::board::f405::{self, Outbox};

    #[entry]
    fn main() -> ! {
        static mut OUTBOX: Outbox = Outbox::new();
        f405::main(&default_config(), OUTBOX)
    }

    #[interrupt]
    fn ADC() {
        f405::on_converted();
    }
}

#[cfg(not(target_os = "none"))]
fn main() {
    println!(
        "touchdown-firmware is an image for the STM32F405.\n\
         Build it:  cargo xtask firmware\n\
         Flash it:  probe-rs run --chip STM32F405RGTx \
         target/thumbv7em-none-eabihf/release/touchdown-firmware"
    );
}
