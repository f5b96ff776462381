//! What an interrupt and the main loop share.

use core::cell::UnsafeCell;
use core::sync::atomic::{AtomicBool, Ordering, compiler_fence};

use cortex_m::Peripherals;
use cortex_m::interrupt::InterruptNumber;
use cortex_m::peripheral::NVIC;
use cortex_m::peripheral::scb::SystemHandler;
use cortex_m::register::basepri;

/// Of the sampling interrupt: only what logs holds it off, for a few microseconds. The four upper bits count.
const SAMPLING: u8 = 0x40;
/// Of PendSV, in which ticks run.
const TICK: u8 = 0x80;

/// Puts PendSV in its place, and above it the interrupt of sampling, which comes from now on.
pub fn unmask(core: &mut Peripherals, sampling: impl InterruptNumber) {
    // SAFETY: what the handlers need is in place, nothing that is held is in use yet, and sampling is above.
    unsafe {
        core.SCB.set_priority(SystemHandler::PendSV, TICK);
        core.NVIC.set_priority(sampling, SAMPLING);
        NVIC::unmask(sampling);
    }
}

/// A value for one at a time: who acts on it holds off the tick, and not the sampling.
pub struct Held<T> {
    value: UnsafeCell<Option<T>>,
    in_use: AtomicBool,
}

// SAFETY: one core; `with` lets nobody in while somebody is.
unsafe impl<T> Sync for Held<T> {}

impl<T> Held<T> {
    /// Nothing yet.
    pub const fn new() -> Self {
        Self {
            value: UnsafeCell::new(None),
            in_use: AtomicBool::new(false),
        }
    }

    /// Puts it in its place, once.
    #[inline(never)]
    pub fn put(&'static self, value: T) {
        // SAFETY: before the interrupts that use it are on.
        unsafe { *self.value.get() = Some(value) };
    }

    /// Acts on it, if it is there and nobody else does.
    #[inline]
    pub fn with<R>(&'static self, act: impl FnOnce(&mut T) -> R) -> Option<R> {
        let before = basepri::read();
        if before == 0 {
            // SAFETY: holds off what has no part in keeping memory safe.
            unsafe { basepri::write(TICK) };
        }
        compiler_fence(Ordering::SeqCst);
        let result = if self.in_use.swap(true, Ordering::Acquire) {
            None
        } else {
            // SAFETY: `in_use` was not set, so no other reference is alive.
            let result = unsafe { (*self.value.get()).as_mut() }.map(act);
            self.in_use.store(false, Ordering::Release);
            result
        };
        compiler_fence(Ordering::SeqCst);
        // SAFETY: as it was.
        unsafe { basepri::write(before) };
        result
    }
}
