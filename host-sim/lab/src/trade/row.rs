//! A row of the table.

use serde::Serialize;

use super::accuracy::Accuracy;
use super::pace::Pace;
use touchdown_scene::{Fidelity, Math, Model, Precision, Scheme};

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
    pub fn new(model: Model, accuracy: Accuracy, pace: Pace) -> Self {
        Self {
            rung: model.rung,
            scheme: model.scheme,
            precision: model.precision,
            math: model.math,
            step_s: model.step,
            accuracy,
            pace,
            pareto: false,
        }
    }

    /// Rung, scheme, precision and math, for people.
    pub fn name(&self) -> String {
        format!(
            "{} {} {} {}",
            self.rung, self.scheme, self.precision, self.math
        )
    }
}
