//! The file of counts, and what a line of it counts.

use core::fmt::Write as _;

use heapless::String;
use semihosting::fs::File;
use semihosting::io::Write as _;

/// Counts of instructions belong to the compiler that made them.
pub const COMPILER: &str = env!("COMPILER");

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
    /// Of that name.
    ///
    /// # Panics
    /// Where the folder cannot be written.
    pub fn create(name: &core::ffi::CStr) -> Self {
        Self(File::create(name).expect("a writable folder"))
    }

    /// Writes a line.
    ///
    /// # Panics
    /// Where the file cannot be written.
    pub fn line(&mut self, text: core::fmt::Arguments<'_>) {
        let mut line: String<LINE_BYTES> = String::new();
        writeln!(line, "{text}").expect("longer than any line of the table");
        self.0.write_all(line.as_bytes()).expect("a writable file");
    }
}
