#![cfg_attr(target_os = "none", no_std, no_main)]
//! The image for an STM32G474; on the desktop it says how to build itself.

#[cfg(target_os = "none")]
mod image {
    use cortex_m_rt::{entry, exception};
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

    touchdown_firmware::last_acts!(g474::drop_outputs);
}

#[cfg(not(target_os = "none"))]
fn main() {
    println!(
        "touchdown-g474 is an image for the STM32G474.\n\
         Build it:  cargo xtask firmware touchdown-g474"
    );
}
