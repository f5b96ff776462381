#![no_std]
#![no_main]
//! The image that stops on purpose, by the very handlers of the one for silicon, and tells after the reset what
//! record was left. QEMU logs what it writes to the pins and the watchdog, which are not emulated.

use cortex_m_rt::entry;
use defmt_semihosting as _;
use semihosting::experimental::env;
use stm32f4::stm32f405::{Interrupt, NVIC, interrupt};
use touchdown_firmware::board::f405;

/// Exit status: 0 told of a crash, 2 nothing to do.
#[entry]
fn main() -> ! {
    if let Some(left) = f405::rehearse() {
        defmt::info!(
            "{=u8} {=u32:#x} {=u32:#x} {=u32:#x} {=u32:#x}",
            left.cause as u8,
            left.place,
            left.detail,
            left.status[0],
            left.status[1]
        );
        semihosting::process::exit(0);
    }
    let arguments = env::args::<64>();
    match arguments
        .as_ref()
        .ok()
        .and_then(|it| it.into_iter().next()?.ok())
    {
        Some("panic") => panic!("as asked"),
        Some("fault") => cortex_m::asm::udf(),
        Some("interrupt") => {
            // SAFETY: nothing serves it, which is what is asked for.
            unsafe { NVIC::unmask(Interrupt::EXTI0) };
            NVIC::pend(Interrupt::EXTI0);
            cortex_m::asm::dsb();
            cortex_m::asm::isb();
        }
        Some("overflow") => {
            deeper(1);
        }
        _ => {}
    }
    semihosting::process::exit(2);
}

/// Calls itself until the stack is used up.
#[inline(never)]
fn deeper(depth: u32) -> u32 {
    let frame = core::hint::black_box([depth; 64]);
    match frame[0] {
        0 => 0,
        depth => deeper(core::hint::black_box(depth + 1)) + frame[1],
    }
}

touchdown_firmware::last_acts!(f405::F405);

#[interrupt]
fn ADC() {}
