//! Colour on a terminal.

use std::io::IsTerminal;

/// Colours text, or leaves it plain.
#[derive(Clone, Copy, Debug)]
pub struct Paint {
    on: bool,
}

impl Paint {
    /// No colour.
    pub const PLAIN: Self = Self { on: false };

    /// Coloured if the text goes to a terminal and NO_COLOR does not forbid it.
    pub fn on(to: &impl IsTerminal) -> Self {
        Self {
            on: to.is_terminal() && Self::wanted(),
        }
    }

    /// Whether NO_COLOR is unset or empty.
    pub fn wanted() -> bool {
        std::env::var_os("NO_COLOR").is_none_or(|value| value.is_empty())
    }

    /// A heading.
    pub fn bold(self, text: &str) -> String {
        self.paint("1", text)
    }

    /// Found by the detector.
    pub fn good(self, text: &str) -> String {
        self.paint("32", text)
    }

    /// Missed by it.
    pub fn bad(self, text: &str) -> String {
        self.paint("31", text)
    }

    fn paint(self, code: &str, text: &str) -> String {
        if self.on {
            format!("\x1b[{code}m{text}\x1b[0m")
        } else {
            text.to_owned()
        }
    }
}
