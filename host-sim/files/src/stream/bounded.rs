//! Bytes of a table on their way to its reader: counted, and no row longer than is believed.

use std::io::{self, Read};

use super::account::Account;

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
    account: Account,
}

impl<R> Bounded<R> {
    /// Before the first byte; `account` counts what passes.
    pub fn new(bytes: R, account: &Account) -> Self {
        Self {
            bytes,
            quoted: false,
            before: b'\n',
            row: 0,
            account: account.clone(),
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
                self.account.passed.lines.update(|it| it + 1);
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
        self.account.add(read as u64);
        if let Some(last) = buffer[..read].last() {
            self.account.passed.last.set(*last);
        }
        if self.follow(&buffer[..read]) {
            return Ok(read);
        }
        self.account.passed.too_long.set(true);
        let rule = "no recording has such rows";
        let text = format!("a row of more than {LONGEST} bytes: {rule}");
        Err(io::Error::other(text))
    }
}
