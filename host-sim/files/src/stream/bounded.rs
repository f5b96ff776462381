//! Bytes of a table on their way to its reader: counted, and no row longer than is believed.

use std::cell::Cell;
use std::io::{self, Read};
use std::rc::Rc;

/// Longest row that is believed, bytes. A file without line ends, or with a quote that is never closed,
/// would else be read into memory as one row.
pub const LONGEST: u64 = 1 << 16;

/// What stands before a quote that opens a field, or goes on with it; elsewhere a quote is a letter.
const OPENS: &[u8] = b",;\t\r\n\"";

/// Passes bytes on until a row is too long.
pub struct Bounded<R> {
    bytes: R,
    quoted: bool,
    before: u8,
    /// Bytes of the row so far.
    row: u64,
    meter: Meter,
}

/// What has passed.
#[derive(Clone, Debug, Default)]
pub struct Meter(Rc<Passed>);

#[derive(Debug, Default)]
struct Passed {
    bytes: Cell<u64>,
    lines: Cell<u64>,
    last: Cell<u8>,
    too_long: Cell<bool>,
}

impl Meter {
    /// Bytes.
    pub fn bytes(&self) -> u64 {
        self.0.bytes.get()
    }

    /// The line where the bytes end, counted from 1.
    pub fn line(&self) -> u64 {
        1 + self.0.lines.get()
    }

    /// Whether the last byte was one of `ends`, or there was none.
    pub fn ends_in(&self, ends: &[u8]) -> bool {
        self.bytes() == 0 || ends.contains(&self.0.last.get())
    }

    /// Whether a row was too long.
    pub fn is_too_long(&self) -> bool {
        self.0.too_long.get()
    }

    /// Counts bytes that go another way.
    pub fn add(&self, bytes: u64) {
        self.0.bytes.set(self.bytes() + bytes);
    }
}

impl<R> Bounded<R> {
    /// Before the first byte; `meter` counts what passes.
    pub fn new(bytes: R, meter: &Meter) -> Self {
        Self {
            bytes,
            quoted: false,
            before: b'\n',
            row: 0,
            meter: meter.clone(),
        }
    }

    fn follow(&mut self, bytes: &[u8]) -> bool {
        for &byte in bytes {
            self.row += 1;
            match byte {
                b'"' => self.quoted = !self.quoted && OPENS.contains(&self.before),
                b'\n' | b'\r' if !self.quoted => self.row = 0,
                _ => {}
            }
            self.before = byte;
            if byte == b'\n' {
                self.meter.0.lines.set(self.meter.0.lines.get() + 1);
            }
            if self.row > LONGEST {
                return false;
            }
        }
        true
    }
}

impl<R: Read> Read for Bounded<R> {
    fn read(&mut self, buffer: &mut [u8]) -> io::Result<usize> {
        let read = self.bytes.read(buffer)?;
        self.meter.add(read as u64);
        if let Some(last) = buffer[..read].last() {
            self.meter.0.last.set(*last);
        }
        if self.follow(&buffer[..read]) {
            return Ok(read);
        }
        self.meter.0.too_long.set(true);
        Err(io::Error::other(format!(
            "a row of more than {LONGEST} bytes: no recording has such rows"
        )))
    }
}
