//! Counts the instructions that a piece of code takes on the target, exactly.
//!
//! With `-icount shift=4` each instruction takes 16 ns of the emulated time, in which SysTick goes
//! down by 2.688 at 168 MHz: the difference of two readings, off by less than one, gives the whole
//! number. Up to 6 241 000 instructions between two readings; SysTick has 24 bits.

use core::ffi::CStr;
use core::fmt::{Arguments, Write as _};
use core::hint::black_box;

use cortex_m::Peripherals;
use cortex_m::peripheral::SYST;
use cortex_m::peripheral::syst::SystClkSource;
use heapless::String;
use semihosting::fs::File;
use semihosting::io::Write as _;

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

const LINE_BYTES: usize = 160;

/// Calls of a kind.
#[derive(Clone, Copy, Default)]
pub struct Tally {
    /// How many.
    pub calls: u32,
    /// Instructions.
    pub sum: u64,
    /// Instructions of one call.
    pub worst: u32,
}

impl Tally {
    /// One call more.
    pub fn add(&mut self, instructions: u32) {
        self.calls += 1;
        self.sum += u64::from(instructions);
        self.worst = self.worst.max(instructions);
    }
}

/// The number format and its functions, as a scene names them.
#[derive(Clone, Copy)]
pub struct Name {
    /// `f32` or `f64`.
    pub precision: &'static str,
    /// Whose functions.
    pub math: &'static str,
}

/// The file of counts.
pub struct Table(File);

impl Table {
    /// Of that name. It begins with the compiler, to which the counts belong.
    ///
    /// # Panics
    /// Where the folder cannot be written.
    pub fn create(name: &CStr) -> Self {
        let mut table = Self(File::create(name).expect("a writable folder"));
        table.line(format_args!("compiler,{}", env!("COMPILER")));
        table
    }

    /// Writes a line.
    ///
    /// # Panics
    /// Where the file cannot be written.
    pub fn line(&mut self, text: Arguments<'_>) {
        let mut line: String<LINE_BYTES> = String::new();
        writeln!(line, "{text}").expect("longer than any line of the table");
        self.0.write_all(line.as_bytes()).expect("a writable file");
    }
}
