//! What is worth a warning but no error.

use std::cell::RefCell;
use std::rc::Rc;

/// Warnings, collected while a recording is read.
#[derive(Clone, Debug, Default)]
pub struct Remarks(Rc<RefCell<Vec<String>>>);

impl Remarks {
    pub fn warn(&self, text: String) {
        self.0.borrow_mut().push(text);
    }

    /// All of them so far; none is left.
    pub fn take(&self) -> Vec<String> {
        std::mem::take(&mut self.0.borrow_mut())
    }
}
