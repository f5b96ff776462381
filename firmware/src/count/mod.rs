//! How many instructions the model and the functions below it take on the target: an image for the
//! emulator that writes a table of counts to the file `counts.csv` of the desktop, by semihosting.
//!
//! One count a line; the desktop makes means of them (`tests/instructions.rs`). "Worst" is the worst
//! that was met. The functions' arguments and results are there as well, as the bits of an f64.

mod drop;
mod functions;
#[cfg(feature = "rungs")]
mod rungs;
pub mod tick;

use core::fmt::Write as _;

use heapless::String;
use semihosting::fs::File;
use semihosting::io::Write as _;
use touchdown_core::model::Precision;

#[cfg(feature = "rungs")]
pub use self::rungs::Every;
pub use crate::board::qemu::Counter;

const LINE_BYTES: usize = 160;

/// Calls of a kind.
#[derive(Clone, Copy, Default)]
struct Tally {
    calls: u32,
    /// Instructions.
    sum: u64,
    /// Instructions of one call.
    worst: u32,
}

impl Tally {
    fn add(&mut self, instructions: u32) {
        self.calls += 1;
        self.sum += u64::from(instructions);
        self.worst = self.worst.max(instructions);
    }
}

/// The number format and its functions, as a scene names them.
#[derive(Clone, Copy)]
pub struct Name {
    precision: &'static str,
    math: &'static str,
}

/// The file of counts.
pub struct Table(File);

impl Table {
    fn line(&mut self, text: core::fmt::Arguments<'_>) {
        let mut line: String<LINE_BYTES> = String::new();
        writeln!(line, "{text}").expect("longer than any line of the table");
        self.0.write_all(line.as_bytes()).expect("a writable file");
    }
}

/// Rungs that are counted next to the rigid one.
pub trait Rungs {
    /// Counts their drops in one kind of number.
    fn count<R: Precision>(counter: &Counter, table: &mut Table, name: Name);
}

/// No other rung.
pub struct RigidAlone;

impl Rungs for RigidAlone {
    fn count<R: Precision>(_: &Counter, _: &mut Table, _: Name) {}
}

/// Counts everything and exits the emulator.
///
/// Generic, so that an image's rungs are compiled with that image and not into the library of all images.
pub fn main<T: Rungs>() -> ! {
    let counter = Counter::take();
    let mut table = Table(File::create(c"counts.csv").expect("a writable folder"));
    table.line(format_args!("compiler,{}", env!("COMPILER")));
    functions::count(&counter, &mut table);
    drop::count::<T>(&counter, &mut table);
    semihosting::process::exit(0)
}
