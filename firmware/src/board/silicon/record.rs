//! The record of a crash, in memory that neither a reset nor the start of the program clears, and the
//! end of a program that crashed.

use core::mem::MaybeUninit;
use core::panic::PanicInfo;
use core::ptr::addr_of_mut;

use cortex_m::peripheral::SCB;
use touchdown_protocol::controller::Outputs;

use super::{Chip, OutputRegisters as _};
use crate::crash::{Cause, Crash, WORDS};

#[unsafe(link_section = ".uninit.crash")]
static mut RECORD: MaybeUninit<[u32; WORDS]> = MaybeUninit::uninit();

/// The record of the last crash, if it has not been cleared.
pub fn read() -> Option<Crash> {
    // SAFETY: any words are valid ones, volatile so that none is assumed; whoever writes does so in
    // main before interrupts are on, in a critical section, or never returns.
    let words = unsafe { addr_of_mut!(RECORD).cast::<[u32; WORDS]>().read_volatile() };
    Crash::decode(&words)
}

/// Clears it.
pub fn clear() {
    write([0; WORDS]);
}

fn write(words: [u32; WORDS]) {
    // SAFETY: as in `read`.
    unsafe {
        addr_of_mut!(RECORD)
            .cast::<[u32; WORDS]>()
            .write_volatile(words)
    }
}

/// With what the core says of the fault that it is in.
fn with_fault_status(crash: Crash) -> Crash {
    /// ARMv7-M, CFSR: bus fault address valid.
    const BFARVALID: u32 = 1 << 15;
    // SAFETY: reads only.
    let block = unsafe { &*SCB::PTR };
    let configurable = block.cfsr.read();
    let is_valid = configurable & BFARVALID != 0;
    let address = if is_valid { block.bfar.read() } else { 0 };
    Crash {
        status: [configurable, block.hfsr.read(), address],
        ..crash
    }
}

/// Takes the current off the outputs, leaves the record and resets.
fn stop<C: Chip>(crash: impl FnOnce() -> Crash) -> ! {
    cortex_m::interrupt::disable();
    C::Outputs::drive(Outputs::SAFE);
    write(crash().encode());
    SCB::sys_reset()
}

/// The end of a program that panics.
pub fn on_panic<C: Chip>(info: &PanicInfo) -> ! {
    stop::<C>(|| Crash::of_panic(info))
}

/// Likewise after a fault of the core at `pc`, called from `lr`.
pub fn on_hard_fault<C: Chip>(pc: u32, lr: u32) -> ! {
    stop::<C>(|| with_fault_status(Crash::new(Cause::HardFault, pc, lr)))
}

/// Likewise after an interrupt that nothing serves.
pub fn on_stray_interrupt<C: Chip>(number: i16) -> ! {
    stop::<C>(|| Crash::new(Cause::StrayInterrupt, number as u32, 0))
}
