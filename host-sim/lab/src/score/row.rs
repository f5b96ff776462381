//! One case, measured and judged.

use std::collections::BTreeMap;

use serde::Serialize;
use serde_json::Value;

use touchdown_base::statistics::{quantile, share};
use touchdown_base::wilson;

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
    /// Where it does not: whether so few trials can show that by chance, since the 95 % interval has the target in it.
    pub undecided: bool,
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
        Self {
            case: case.into(),
            quantity,
            target,
            at_least: false,
            holds: measured.is_finite() && measured <= target,
            undecided: false,
            values: BTreeMap::from([(quantity, Value::from(measured))]),
            note: String::new(),
        }
    }

    /// Holds from `target` on.
    pub fn at_least(
        case: impl Into<String>,
        quantity: &'static str,
        measured: f64,
        target: f64,
    ) -> Self {
        Self {
            at_least: true,
            holds: measured.is_finite() && measured >= target,
            ..Self::at_most(case, quantity, measured, target)
        }
    }

    /// Holds where the value that a part `p` of `values` does not exceed is up to `target`.
    pub fn quantile_at_most(
        case: impl Into<String>,
        quantity: &'static str,
        values: &[f64],
        p: f64,
        target: f64,
    ) -> Self {
        let within = values.iter().filter(|it| **it <= target).count();
        let (_, most) = interval(share(within, values.len()), values.len());
        Self::at_most(case, quantity, quantile(values, p), target).undecided_if(most >= p)
    }

    /// A further value.
    pub fn with(mut self, name: &'static str, value: impl Into<Value>) -> Self {
        self.values.insert(name, value.into());
        self
    }

    /// Holds only if `also` does, which leaves no doubt.
    pub fn and(mut self, also: bool) -> Self {
        self.holds &= also;
        self.undecided &= also;
        self
    }

    /// What is judged is a share of so many trials. Without any it does not hold.
    pub fn of(self, trials: usize) -> Self {
        let (measured, target) = (self.measured().unwrap_or(f64::NAN), self.target);
        self.of_mean(measured, trials, target)
    }

    /// Likewise of a mean of numbers from 0 to 1, which is to be held against `limit`.
    pub fn of_mean(mut self, mean: f64, trials: usize, limit: f64) -> Self {
        let (least, most) = interval(mean, trials);
        let may_hold = if self.at_least {
            most >= limit
        } else {
            least <= limit
        };
        self.holds &= trials > 0;
        self.undecided_if(may_hold)
    }

    fn undecided_if(mut self, may_hold: bool) -> Self {
        self.undecided = !self.holds && may_hold;
        self
    }

    /// How the measured value stands to the target, for people.
    pub fn sense(&self) -> char {
        if self.at_least {
            '\u{2265}'
        } else {
            '\u{2264}'
        }
    }

    /// Whether the target is missed beyond doubt.
    pub fn fails(&self) -> bool {
        !self.holds && !self.undecided
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

/// The 95 % interval of a share or mean.
pub fn interval(share: f64, trials: usize) -> (f64, f64) {
    if trials == 0 {
        return (0.0, 1.0);
    }
    wilson::of_share(share, trials as f64)
}

/// Whether no row fails; that none holds either is no proof.
pub fn none_fails<'a>(rows: impl IntoIterator<Item = &'a Row>) -> bool {
    let mut holds = false;
    for row in rows {
        holds |= row.holds;
        if row.fails() {
            return false;
        }
    }
    holds
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
        assert!(!none_fails(&[]));
    }

    #[test]
    fn few_trials_decide_less_than_many() {
        // None of 2 as it should be is within chance where half or fewer are asked for; none of 10 is not.
        for (right, trials, undecided) in
            [(0, 2, true), (1, 2, true), (0, 10, false), (49, 100, true)]
        {
            let row = Row::at_least("a", "share", share(right, trials), 0.5).of(trials);
            assert!(row.undecided == undecided || row.holds, "{row:?}");
            let values: Vec<f64> = (0..trials)
                .map(|k| if k < right { 0.0 } else { f64::INFINITY })
                .collect();
            let row = Row::quantile_at_most("a", "median", &values, 0.5, 1.0);
            assert!(row.undecided == undecided || row.holds, "{row:?}");
        }
        // By hand: 95 of 100 gives 0.888 to 0.978, 98 of 100 gives 0.930 to 0.994.
        assert!(Row::at_least("a", "share", 0.95, 0.99).of(100).fails());
        assert!(Row::at_least("a", "share", 0.98, 0.99).of(100).undecided);
        assert!(Row::at_most("a", "share", 0.5, 0.02).of(2).fails());
        assert!(
            Row::at_most("a", "share", 0.5, 0.02)
                .of_mean(0.1, 2, 0.02)
                .undecided
        );
    }

    #[test]
    fn what_may_not_happen_at_all_fails_by_happening_once() {
        assert!(Row::at_most("a", "invented", 1.0, 0.0).fails());
        assert!(Row::at_least("a", "share", 0.0, 0.99).of(0).undecided);
        assert!(
            Row::at_least("a", "share", 0.0, 0.99)
                .of(0)
                .and(false)
                .fails()
        );
        let undecided = Row::at_least("a", "share", f64::NAN, 0.99).of(0);
        assert!(undecided.undecided && !none_fails([&undecided]));
        let holds = Row::at_most("a", "ratio", 1.0, 1.0);
        assert!(none_fails([&undecided, &holds]));
        assert!(!none_fails([
            &holds,
            &Row::at_most("a", "invented", 1.0, 0.0)
        ]));
    }

    #[test]
    fn both_senses() {
        assert!(Row::at_most("a", "ratio", 1.0, 1.0).holds);
        assert!(!Row::at_most("a", "ratio", 1.1, 1.0).holds);
        assert!(!Row::at_least("a", "share", 0.9, 0.99).holds);
        assert!(!Row::at_least("a", "share", 1.0, 0.99).and(false).holds);
    }
}
