//! The record of a crash, in memory that neither a reset nor the start of the program clears, and the
//! end of a program that crashed.

use core::mem::MaybeUninit;
use core::panic::PanicInfo;
use core::ptr::addr_of_mut;

use cortex_m::peripheral::SCB;

use crate::crash::{Cause, Crash, FaultStatus, WORDS};

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

/// What the core says of the fault that it is in.
fn fault_status() -> FaultStatus {
    /// ARMv7-M, CFSR: bus fault address valid.
    const BFARVALID: u32 = 1 << 15;
    // SAFETY: reads only.
    let block = unsafe { &*SCB::PTR };
    let configurable = block.cfsr.read();
    let is_valid = configurable & BFARVALID != 0;
    FaultStatus {
        configurable,
        hard: block.hfsr.read(),
        address: if is_valid { block.bfar.read() } else { 0 },
    }
}

/// By `drop_outputs` takes the current off, leaves the record and resets.
fn stop(drop_outputs: fn(), crash: impl FnOnce() -> Crash) -> ! {
    cortex_m::interrupt::disable();
    drop_outputs();
    write(crash().encode());
    SCB::sys_reset()
}

/// The end of a program that panics.
pub fn on_panic(drop_outputs: fn(), info: &PanicInfo) -> ! {
    stop(drop_outputs, || Crash::of_panic(info))
}

/// Likewise after a fault of the core at `pc`, called from `lr`.
pub fn on_hard_fault(drop_outputs: fn(), pc: u32, lr: u32) -> ! {
    stop(drop_outputs, || Crash {
        cause: Cause::HardFault,
        place: pc,
        detail: lr,
        status: fault_status(),
    })
}

/// Likewise after an interrupt that nothing serves.
pub fn on_stray_interrupt(drop_outputs: fn(), number: i16) -> ! {
    stop(drop_outputs, || Crash {
        cause: Cause::StrayInterrupt,
        place: number as u32,
        detail: 0,
        status: FaultStatus::default(),
    })
}
