#![no_std]
#![no_main]
//! The image for an STM32F405.

use cortex_m_rt::{entry, exception};
use defmt_rtt as _;
use stm32f4::stm32f405::interrupt;
use touchdown_firmware::board::f405::{F405, start};
use touchdown_firmware::board::silicon::{self, Chip as _};
use touchdown_firmware::memory::Memory;

#[entry]
fn main() -> ! {
    static mut MEMORY: Memory = Memory::empty();
    silicon::run(start(MEMORY))
}

#[interrupt]
fn ADC() {
    F405::tasks().on_converted();
}

#[exception]
fn PendSV() {
    F405::tasks().on_waiting();
}

touchdown_firmware::last_acts!(F405::drop_outputs);
