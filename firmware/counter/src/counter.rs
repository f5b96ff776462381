//! Counts the instructions that a piece of code takes, exactly.
//!
//! With `-icount shift=4` each instruction takes 16 ns of the emulated time, in which SysTick goes
//! down by 2.688 at 168 MHz: the difference of two readings, off by less than one, gives the whole
//! number. Up to 6 241 000 instructions between two readings; SysTick has 24 bits.

use core::hint::black_box;

use cortex_m::Peripherals;
use cortex_m::peripheral::SYST;
use cortex_m::peripheral::syst::SystClkSource;

const RELOAD: u32 = 0x00ff_ffff;
/// Ticks in 1000 instructions.
const TICKS: u32 = 2_688;

/// The counter, and what taking a reading costs.
pub struct Counter {
    overhead: u32,
}

impl Counter {
    /// Starts SysTick.
    ///
    /// # Panics
    /// The second time: there is one SysTick.
    pub fn take() -> Self {
        let mut timer = Peripherals::take().expect("the first time").SYST;
        timer.set_clock_source(SystClkSource::Core);
        timer.set_reload(RELOAD);
        timer.clear_current();
        timer.enable_counter();
        let mut counter = Self { overhead: 0 };
        counter.overhead = counter.count(|| ()).1;
        counter
    }

    /// What `work` gives, and the instructions it took. None of the count is left to run between two later readings.
    #[inline(always)]
    pub fn count<T>(&self, work: impl FnOnce() -> T) -> (T, u32) {
        let before = SYST::get_current();
        let result = black_box(work());
        let after = SYST::get_current();
        let ticks = before.wrapping_sub(after) & RELOAD;
        let instructions = (u64::from(ticks) * 1_000 + u64::from(TICKS) / 2) / u64::from(TICKS);
        (result, black_box(instructions as u32) - self.overhead)
    }
}
