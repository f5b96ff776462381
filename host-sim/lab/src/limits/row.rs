//! What one extreme showed in one precision.

use serde::Serialize;

use touchdown_scene::Precision;

/// One line of the answer.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Row {
    /// What was done, and what of it is measured; unique together with the precision.
    pub extreme: String,
    /// Number format.
    pub precision: Precision,
    /// Worst that was found; finite.
    pub measured: f64,
    /// Most that is allowed.
    pub limit: f64,
    /// Of both.
    pub unit: &'static str,
    /// Whether it is within the limit.
    pub holds: bool,
}

impl Row {
    /// About this, as a start; nothing is measured of it yet.
    pub fn of(extreme: impl Into<String>, precision: Precision) -> Self {
        Self {
            extreme: extreme.into(),
            precision,
            measured: f64::MAX,
            limit: 0.0,
            unit: "",
            holds: false,
        }
    }

    /// Judges `measured`. What is no number at all breaks any limit, and stands as the largest there is.
    pub fn at_most(self, measured: f64, limit: f64, unit: &'static str) -> Self {
        let is_number = measured.is_finite();
        Self {
            measured: if is_number { measured } else { f64::MAX },
            limit,
            unit,
            holds: measured <= limit,
            ..self
        }
    }

    /// Judges the worst that was found.
    pub fn worst(self, worst: Worst, unit: &'static str) -> Self {
        self.at_most(worst.measured, worst.limit, unit)
    }
}

/// The measured value that uses most of its limit.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Worst {
    /// Worst that was found.
    pub measured: f64,
    /// Most that is allowed there.
    pub limit: f64,
}

impl Worst {
    /// Takes a value and its limit, above 0. What is no number at all stays.
    pub fn take(&mut self, measured: f64, limit: f64) {
        let part = measured / limit;
        if self.limit == 0.0 || part.is_nan() || part > self.measured / self.limit {
            *self = Self { measured, limit };
        }
    }
}

/// Whether every row holds; no row at all is no proof.
pub fn all_hold(rows: &[Row]) -> bool {
    !rows.is_empty() && rows.iter().all(|row| row.holds)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn row(measured: f64) -> Row {
        Row::of("made up", Precision::F32).at_most(measured, 1.0, "s")
    }

    #[test]
    fn one_broken_limit_is_enough() {
        assert!(all_hold(&[row(0.5), row(1.0)]));
        assert!(!all_hold(&[row(0.5), row(1.1)]));
        assert!(!all_hold(&[]));
    }

    #[test]
    fn the_worst_is_what_uses_most_of_its_limit() {
        let mut worst = Worst::default();
        for (measured, limit) in [(0.0, 1.0), (2.0, 100.0), (1.0, 10.0), (3.0, 40.0)] {
            worst.take(measured, limit);
        }
        assert_eq!((worst.measured, worst.limit), (1.0, 10.0));
        worst.take(f64::NAN, 1.0);
        worst.take(5.0, 1.0);
        assert!(worst.measured.is_nan());
    }

    #[test]
    fn what_is_no_number_does_not_hold_and_is_written_as_a_number() {
        for bad in [f64::NAN, f64::INFINITY] {
            let row = row(bad);
            assert!(!row.holds && row.measured.is_finite());
        }
    }
}
