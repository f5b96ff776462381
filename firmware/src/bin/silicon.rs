#![cfg_attr(target_os = "none", no_std, no_main)]
//! The image for silicon; on the desktop it says how to build and flash itself.

#[cfg(target_os = "none")]
mod image {
    use cortex_m_rt::{entry, exception};
    use defmt_rtt as _;
    use stm32f4::stm32f405::interrupt;
    use touchdown_firmware::board::f405::{F405, TASKS, start};
    use touchdown_firmware::board::silicon::{self, Chip as _};
    use touchdown_firmware::memory::Memory;

    #[entry]
    fn main() -> ! {
        static mut MEMORY: Memory = Memory::empty();
        silicon::run(start(MEMORY))
    }

    #[interrupt]
    fn ADC() {
        TASKS.on_converted();
    }

    #[exception]
    fn PendSV() {
        TASKS.on_waiting();
    }

    touchdown_firmware::last_acts!(F405::drop_outputs);
}

#[cfg(not(target_os = "none"))]
fn main() {
    println!(
        "touchdown-firmware is an image for the STM32F405.\n\
         Build it:  cargo xtask firmware\n\
         Flash it:  cargo xtask flash"
    );
}
