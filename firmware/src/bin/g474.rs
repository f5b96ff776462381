#![no_std]
#![no_main]
//! The image for an STM32G474.

use cortex_m_rt::{entry, exception};
use defmt_rtt as _;
use stm32g4::stm32g474::interrupt;
use touchdown_firmware::board::g474::{G474, start};
use touchdown_firmware::board::silicon::{self, Chip as _};
use touchdown_firmware::memory::Memory;

#[entry]
fn main() -> ! {
    static mut MEMORY: Memory = Memory::empty();
    silicon::run(start(MEMORY))
}

#[interrupt]
fn EXTI0() {
    G474::tasks().on_converted();
}

#[exception]
fn PendSV() {
    G474::tasks().on_waiting();
}

touchdown_firmware::last_acts!(G474::drop_outputs);
