#![cfg_attr(target_os = "none", no_std, no_main)]
//! The image for silicon; on the desktop it says how to build and flash itself.

#[cfg(target_os = "none")]
mod image {
    use core::panic::PanicInfo;

    use cortex_m_rt::{ExceptionFrame, entry, exception};
    use defmt_rtt as _;
    use stm32f4::stm32f405::interrupt;
    use touchdown_firmware::{board::f405, memory::Memory};

    #[entry]
    fn main() -> ! {
        static mut MEMORY: Memory = Memory::empty();
        f405::main(MEMORY)
    }

    #[interrupt]
    fn ADC() {
        f405::on_converted();
    }

    #[exception]
    fn PendSV() {
        f405::on_waiting();
    }

    #[panic_handler]
    fn panic(info: &PanicInfo) -> ! {
        f405::on_panic(info)
    }

    // The runtime asks for unsafe functions; there is nothing unsafe in them.
    #[exception]
    unsafe fn HardFault(frame: &ExceptionFrame) -> ! {
        f405::on_hard_fault(frame.pc(), frame.lr())
    }

    #[exception]
    unsafe fn DefaultHandler(number: i16) -> ! {
        f405::on_stray_interrupt(number)
    }
}

#[cfg(not(target_os = "none"))]
fn main() {
    println!(
        "touchdown-firmware is an image for the STM32F405.\n\
         Build it:  cargo xtask firmware\n\
         Flash it:  cargo xtask flash"
    );
}
