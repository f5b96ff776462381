#![no_std]
#![no_main]
//! The image that counts the instructions of a tick in the emulator.

mod count;
mod scenes;

use cortex_m_rt::{ExceptionFrame, entry, exception};
use defmt_semihosting as _;
use panic_probe as _;
use stm32f4 as _;

use count::Memory;

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
