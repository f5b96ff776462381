//! A row of the table, and the front: what is not beaten in both cost and accuracy.

use serde::Serialize;

use super::accuracy::Accuracy;
use super::pace::Pace;
use touchdown_scene::{Fidelity, Math, Precision, Scheme};

/// One combination: how wrong it is, and what it costs.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub(super) struct Row {
    /// Rung.
    pub rung: Fidelity,
    /// Scheme.
    pub scheme: Scheme,
    /// Number format.
    pub precision: Precision,
    /// Functions.
    pub math: Math,
    /// s.
    pub step_s: f64,
    /// How wrong it is.
    #[serde(flatten)]
    pub accuracy: Accuracy,
    /// What it costs.
    #[serde(flatten)]
    pub pace: Pace,
    /// Whether no other row is both quicker here and closer at impacts 1, 3 and 10.
    pub pareto: bool,
}

impl Row {
    /// Rung, scheme, precision and math, for people.
    pub fn name(&self) -> String {
        format!(
            "{} {} {} {}",
            self.rung, self.scheme, self.precision, self.math
        )
    }
}

/// Marks the rows that no other row beats: none is at least as quick here and as close at the impacts,
/// and better in one of them.
pub(super) fn mark_front(rows: &mut [Row]) {
    let points: Vec<[f64; 2]> = rows
        .iter()
        .map(|row| [row.pace.seconds_per_simulated_second, row.accuracy.worst])
        .collect();
    for (row, &point) in rows.iter_mut().zip(&points) {
        row.pareto = point[1].is_finite() && !points.iter().any(|&other| beats(other, point));
    }
}

fn beats(a: [f64; 2], b: [f64; 2]) -> bool {
    a[0] <= b[0] && a[1] <= b[1] && a != b
}

#[cfg(test)]
mod tests {
    use super::beats;

    #[test]
    fn a_point_is_beaten_by_what_is_no_worse_and_somewhere_better() {
        assert!(beats([1.0, 1.0], [1.0, 2.0]));
        assert!(beats([1.0, 1.0], [2.0, 2.0]));
        assert!(!beats([1.0, 1.0], [1.0, 1.0]));
        assert!(!beats([1.0, 3.0], [2.0, 2.0]));
    }
}
