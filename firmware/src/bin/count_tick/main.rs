#![cfg_attr(target_os = "none", no_std, no_main)]
//! The image that counts the instructions of a tick in the emulator; on the desktop it says how to build itself.

#[cfg(target_os = "none")]
mod count;
#[cfg(target_os = "none")]
mod scenes;

#[cfg(target_os = "none")]
mod image {
    use cortex_m_rt::{ExceptionFrame, entry, exception};
    use defmt_semihosting as _;
    use panic_probe as _;
    use stm32f4 as _;

    use crate::count::{self, Memory};

    #[entry]
    fn main() -> ! {
        static mut MEMORY: Memory = Memory::EMPTY;
        count::main(MEMORY)
    }

    // The runtime asks for an unsafe function; there is nothing unsafe in it.
    #[exception]
    unsafe fn HardFault(_: &ExceptionFrame) -> ! {
        semihosting::process::abort()
    }
}

#[cfg(not(target_os = "none"))]
fn main() {
    println!(
        "touchdown-count-tick is an image for QEMU's netduinoplus2 (STM32F405).\n\
         Build it:  cargo xtask firmware\n\
         Use it:    cargo xtask budget"
    );
}
