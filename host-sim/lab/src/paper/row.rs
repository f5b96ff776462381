//! A number of the paper: as printed, as right, as the program has it.

use serde::Serialize;

/// One number; in the unit that it names.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Row {
    /// What.
    pub item: String,
    /// In the paper; none where it gives no number.
    pub printed: Option<f64>,
    /// From a closed form, or where there is none, from the reference.
    pub right: f64,
    /// Measured on a run of the model under test; none where only the expression of `right` exists.
    pub ours: Option<f64>,
    /// Of all three; empty for a pure number.
    pub unit: &'static str,
    /// Whether `ours` is `right` within the tolerance of the note.
    pub agrees: Option<bool>,
    /// Where the numbers come from.
    pub note: String,
}

impl Row {
    /// A row without a printed number and without ours.
    pub fn new(item: &str, unit: &'static str, right: f64) -> Self {
        Self {
            item: item.to_owned(),
            printed: None,
            right,
            ours: None,
            unit,
            agrees: None,
            note: String::new(),
        }
    }

    /// With the number in the paper.
    pub fn printed(self, printed: f64) -> Self {
        Self {
            printed: Some(printed),
            ..self
        }
    }

    /// With where the numbers come from.
    pub fn note(mut self, note: &str) -> Self {
        if !self.note.is_empty() {
            self.note.insert_str(0, "; ");
        }
        self.note.insert_str(0, note);
        self
    }

    /// Whether the printed number is off by more than 1 %.
    pub fn is_misprinted(&self) -> bool {
        let off = |printed: f64| (printed - self.right).abs() > 0.01 * self.right.abs();
        self.printed.is_some_and(off)
    }

    /// With the number of the model under test, and how far off it may be, in the row's unit.
    pub fn ours(mut self, ours: f64, tolerance: f64) -> Self {
        self.ours = Some(ours);
        self.agrees = Some((ours - self.right).abs() <= tolerance);
        if !self.note.is_empty() {
            self.note += "; ";
        }
        let tolerance = match tolerance {
            it if it < 0.1 => format!("{it:e}"),
            it => it.to_string(),
        };
        self.note += format!("ours within {tolerance} {}", self.unit).trim_end();
        self
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ours_is_judged_against_right() {
        let row = |ours| Row::new("x", "m", 2.0).printed(9.0).ours(ours, 0.1);
        assert_eq!(row(2.05).agrees, Some(true));
        assert_eq!(row(8.95).agrees, Some(false));
        assert_eq!(row(f64::NAN).agrees, Some(false));
        assert_eq!(Row::new("x", "m", 2.0).agrees, None);
        assert_eq!(row(2.0).note("a").note, "a; ours within 0.1 m");
    }
}
