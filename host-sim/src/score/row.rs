//! One case, measured and judged.

use std::collections::BTreeMap;

use serde::Serialize;
use serde_json::Value;

/// One line of the answer.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Row {
    /// What was done; unique in its group together with the quantity.
    pub case: String,
    /// Which of the values is judged.
    pub quantity: &'static str,
    /// What it should be.
    pub target: f64,
    /// Whether the target is the least that holds, rather than the most.
    pub at_least: bool,
    /// Whether it does.
    pub holds: bool,
    /// The quantity and what else was measured, by name; SI, null where there is none.
    #[serde(flatten)]
    pub values: BTreeMap<&'static str, Value>,
    /// The rest in a few words.
    #[serde(skip)]
    pub note: String,
}

impl Row {
    /// Holds up to `target`. What is no number does not.
    pub fn at_most(
        case: impl Into<String>,
        quantity: &'static str,
        measured: f64,
        target: f64,
    ) -> Self {
        Self::new(case.into(), quantity, measured, target, false)
    }

    /// Holds from `target` on.
    pub fn at_least(
        case: impl Into<String>,
        quantity: &'static str,
        measured: f64,
        target: f64,
    ) -> Self {
        Self::new(case.into(), quantity, measured, target, true)
    }

    fn new(
        case: String,
        quantity: &'static str,
        measured: f64,
        target: f64,
        at_least: bool,
    ) -> Self {
        let within = if at_least {
            measured >= target
        } else {
            measured <= target
        };
        Self {
            case,
            quantity,
            target,
            at_least,
            holds: measured.is_finite() && within,
            values: BTreeMap::from([(quantity, Value::from(measured))]),
            note: String::new(),
        }
    }

    /// A further value.
    pub fn with(mut self, name: &'static str, value: impl Into<Value>) -> Self {
        self.values.insert(name, value.into());
        self
    }

    /// Holds only if `also` does.
    pub fn and(mut self, also: bool) -> Self {
        self.holds &= also;
        self
    }

    /// For people.
    pub fn noted(mut self, note: String) -> Self {
        self.note = note;
        self
    }

    /// What is judged; none where nothing could be measured.
    pub fn measured(&self) -> Option<f64> {
        self.values.get(self.quantity)?.as_f64()
    }
}

/// Whether every row holds; no row at all is no proof.
pub fn all_hold<'a>(rows: impl IntoIterator<Item = &'a Row>) -> bool {
    let mut rows = rows.into_iter().peekable();
    rows.peek().is_some() && rows.all(|row| row.holds)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_was_not_measured_does_not_hold() {
        for nothing in [f64::NAN, f64::INFINITY] {
            assert!(!Row::at_most("a", "ratio", nothing, 1.0).holds);
            assert!(!Row::at_least("a", "share", nothing, 0.5).holds);
        }
        assert!(!all_hold(&[]));
    }

    #[test]
    fn both_senses() {
        assert!(Row::at_most("a", "ratio", 1.0, 1.0).holds);
        assert!(!Row::at_most("a", "ratio", 1.1, 1.0).holds);
        assert!(!Row::at_least("a", "share", 0.9, 0.99).holds);
        assert!(!Row::at_least("a", "share", 1.0, 0.99).and(false).holds);
    }
}
