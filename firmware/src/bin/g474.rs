#![cfg_attr(target_os = "none", no_std, no_main)]
//! The image for an STM32G474; on the desktop it says how to build itself.

#[cfg(target_os = "none")]
mod image {
    use core::panic::PanicInfo;

    use cortex_m_rt::{ExceptionFrame, entry, exception};
    use defmt_rtt as _;
    use stm32g4::stm32g474::interrupt;
    use touchdown_firmware::{board::g474, memory::Memory};

    #[entry]
    fn main() -> ! {
        static mut MEMORY: Memory = Memory::empty();
        g474::main(MEMORY)
    }

    #[interrupt]
    fn EXTI0() {
        g474::on_converted();
    }

    #[exception]
    fn PendSV() {
        g474::on_waiting();
    }

    #[panic_handler]
    fn panic(info: &PanicInfo) -> ! {
        g474::on_panic(info)
    }

    // The runtime asks for unsafe functions; there is nothing unsafe in them.
    #[exception]
    unsafe fn HardFault(frame: &ExceptionFrame) -> ! {
        g474::on_hard_fault(frame.pc(), frame.lr())
    }

    #[exception]
    unsafe fn DefaultHandler(number: i16) -> ! {
        g474::on_stray_interrupt(number)
    }
}

#[cfg(not(target_os = "none"))]
fn main() {
    println!(
        "touchdown-g474 is an image for the STM32G474.\n\
         Build it:  cargo xtask firmware touchdown-g474"
    );
}
