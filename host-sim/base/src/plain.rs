//! Text from outside, shown to people. A terminal or a browser obeys some characters; whoever wrote a title, a name of a
//! file or of a column, or whatever speaks on a line, could hide or forge with them what this program says.

use std::borrow::Cow;
use std::fmt::{self, Write as _};

/// `text` with such characters as their numbers: controls but for line ends and tabs, and what turns, joins or hides others.
pub fn shown(text: &str) -> Cow<'_, str> {
    if !text.contains(is_obeyed) {
        return Cow::Borrowed(text);
    }
    let mut shown = String::with_capacity(text.len() + 16);
    for letter in text.chars() {
        if is_obeyed(letter) {
            let _ = write!(shown, "{}", letter.escape_unicode());
        } else {
            shown.push(letter);
        }
    }
    Cow::Owned(shown)
}

/// Whether it has no shape of its own: general categories Cc and Cf, and the separators of lines and paragraphs.
fn is_obeyed(letter: char) -> bool {
    match letter {
        '\n' | '\t' => false,
        '\u{ad}'
        | '\u{61c}'
        | '\u{180e}'
        | '\u{200b}'..='\u{200f}'
        | '\u{2028}'..='\u{202e}'
        | '\u{2060}'..='\u{206f}'
        | '\u{feff}'
        | '\u{fff9}'..='\u{fffb}'
        | '\u{e0000}'..='\u{e007f}' => true,
        _ => letter.is_control(),
    }
}

/// A line for each of the first `most` of a list, and how many more `what` there are.
pub fn listed<T>(all: &[T], most: usize, what: &str, line: impl FnMut(&T) -> String) -> String {
    let mut text: String = all.iter().take(most).map(line).collect();
    if let more @ 1.. = all.len().saturating_sub(most) {
        text += &format!("... {more} more {what}\n");
    }
    text
}

/// A number, with an exponent where it would be a row of zeros without.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Number(pub f64);

/// Numbers of this size are written without exponent.
const PLAIN: std::ops::Range<f64> = 1e-6..1e12;

impl fmt::Display for Number {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        if self.0 == 0.0 || !self.0.is_finite() || PLAIN.contains(&self.0.abs()) {
            fmt::Display::fmt(&self.0, f)
        } else {
            fmt::LowerExp::fmt(&self.0, f)
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_obeyed_is_shown_as_its_number() {
        for (text, seen) in [
            ("\u{1b}[2J", r"\u{1b}[2J"),
            ("a\rb\u{7f}\u{7}\0", r"a\u{d}b\u{7f}\u{7}\u{0}"),
            ("\u{9b}31m\u{9d}0;", r"\u{9b}31m\u{9d}0;"),
            ("\u{202e}lmot.exe\u{202c}", r"\u{202e}lmot.exe\u{202c}"),
            ("\u{2066}a\u{2069}\u{200f}", r"\u{2066}a\u{2069}\u{200f}"),
            ("\u{2028}\u{feff}", r"\u{2028}\u{feff}"),
        ] {
            assert_eq!(shown(text), seen);
        }
    }

    #[test]
    fn no_number_is_a_row_of_zeros() {
        for (number, seen) in [
            (0.0, "0"),
            (-0.25, "-0.25"),
            (200_001.0, "200001"),
            (1e-5, "0.00001"),
            (5e-324, "5e-324"),
            (-1e300, "-1e300"),
            (f64::MAX, "1.7976931348623157e308"),
        ] {
            assert_eq!(Number(number).to_string(), seen);
        }
        assert_eq!(
            format!("{:.3} {:.3}", Number(1e300), Number(2.0)),
            "1.000e300 2.000"
        );
    }

    #[test]
    fn what_has_a_shape_stays() {
        let text = "Gr\u{f6}\u{df}e \u{b5}m, u\u{308}, \u{2264} 1 \"a\\b'\n\t\u{a0}\u{65e5}\u{672c} \u{1f600}";
        assert!(matches!(shown(text), Cow::Borrowed(it) if it == text));
    }
}
