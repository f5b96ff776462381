//! The file of counts, and what a line of it counts.

use core::fmt::Write as _;

use heapless::String;
use semihosting::fs::File;
use semihosting::io::Write as _;

const LINE_BYTES: usize = 160;

/// Calls of a kind.
#[derive(Clone, Copy, Default)]
pub(crate) struct Tally {
    pub(crate) calls: u32,
    /// Instructions.
    pub(crate) sum: u64,
    /// Instructions of one call.
    pub(crate) worst: u32,
}

impl Tally {
    pub(crate) fn add(&mut self, instructions: u32) {
        self.calls += 1;
        self.sum += u64::from(instructions);
        self.worst = self.worst.max(instructions);
    }
}

/// The number format and its functions, as a scene names them.
#[derive(Clone, Copy)]
pub(crate) struct Name {
    pub(crate) precision: &'static str,
    pub(crate) math: &'static str,
}

/// The file of counts.
pub(crate) struct Table(File);

impl Table {
    /// Of that name.
    pub(crate) fn create(name: &core::ffi::CStr) -> Self {
        Self(File::create(name).expect("a writable folder"))
    }

    pub(crate) fn line(&mut self, text: core::fmt::Arguments<'_>) {
        let mut line: String<LINE_BYTES> = String::new();
        writeln!(line, "{text}").expect("longer than any line of the table");
        self.0.write_all(line.as_bytes()).expect("a writable file");
    }
}
