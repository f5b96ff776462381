//! An account of a file that is being read: what has passed of it, and what was found beside its rows.

use std::cell::{Cell, RefCell};
use std::rc::Rc;

use touchdown_base::input_error::{InputError, reason};
use touchdown_core::learnt::Learnt;

/// What is known of a file by now. Clones share all but the name.
#[derive(Clone, Debug, Default)]
pub struct Account {
    /// As errors name it.
    pub file: String,
    pub(super) passed: Rc<Passed>,
    warnings: Rc<RefCell<Vec<String>>>,
    /// What the detector had learnt before the first row, once that is read and says so.
    pub learnt: Rc<RefCell<Option<Box<Learnt>>>>,
}

#[derive(Debug, Default)]
pub(super) struct Passed {
    pub bytes: Cell<u64>,
    pub lines: Cell<u64>,
    pub last: Cell<u8>,
    pub too_long: Cell<bool>,
}

impl Account {
    /// Of `file`, before its first byte.
    pub fn of(file: impl Into<String>) -> Self {
        Self {
            file: file.into(),
            ..Self::default()
        }
    }

    /// Bytes.
    pub fn bytes(&self) -> u64 {
        self.passed.bytes.get()
    }

    /// Whether the last byte was one of `ends`, or there was none.
    pub fn ends_in(&self, ends: &[u8]) -> bool {
        self.bytes() == 0 || ends.contains(&self.passed.last.get())
    }

    /// Counts bytes that go another way.
    pub fn add(&self, bytes: u64) {
        self.passed.bytes.set(self.bytes() + bytes);
    }

    /// Tells what is worth a warning but no error.
    pub fn warn(&self, text: String) {
        self.warnings.borrow_mut().push(text);
    }

    /// The same of the file as a whole.
    pub fn doubt(&self, rule: &str) {
        self.warn(format!("{}: {rule}", self.file));
    }

    /// All such so far; none is left.
    pub fn take_warnings(&self) -> Vec<String> {
        self.warnings.take()
    }

    /// A flaw of the file as a whole.
    pub fn of_file(&self, rule: impl Into<String>) -> InputError {
        InputError::of_file(&self.file, rule)
    }

    /// A flaw of one line, counted from 1.
    pub fn at_line(&self, line: u64, rule: impl Into<String>) -> InputError {
        InputError::at_line(&self.file, line, rule)
    }

    /// What the csv library has to say.
    pub(crate) fn csv_error(&self, error: &csv::Error) -> InputError {
        let line = error.position().map(csv::Position::line);
        match (error.kind(), line) {
            (csv::ErrorKind::Utf8 { .. }, Some(line)) => {
                self.at_line(line, "the text is not UTF-8")
            }
            (csv::ErrorKind::Io(error), _) if self.passed.too_long.get() => {
                self.at_line(1 + self.passed.lines.get(), error.to_string())
            }
            (csv::ErrorKind::Io(error), _) => self.of_file(reason(error)),
            (_, Some(line)) => self.at_line(line, error.to_string()),
            (_, None) => self.of_file(error.to_string()),
        }
    }
}
