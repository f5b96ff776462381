#![no_std]
#![no_main]
//! The image for the emulator, QEMU's netduinoplus2 (STM32F405).

use cortex_m_rt::{ExceptionFrame, entry, exception};
use defmt_semihosting as _;
use panic_probe as _;
use stm32f4::stm32f405::interrupt;
use touchdown_firmware::board::qemu;
use touchdown_firmware::memory::Memory;

#[entry]
fn main() -> ! {
    static mut MEMORY: Memory = Memory::empty();
    qemu::main(MEMORY)
}

#[interrupt]
fn TIM2() {
    qemu::on_timer();
}

#[exception]
fn PendSV() {
    qemu::on_waiting();
}

// It would else spin for ever. The runtime asks for an unsafe function; there is nothing unsafe in it.
#[exception]
unsafe fn HardFault(_: &ExceptionFrame) -> ! {
    semihosting::process::abort()
}
