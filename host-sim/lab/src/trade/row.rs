//! A row of the table.

use serde::Serialize;

use super::Trade;
use super::accuracy::Accuracy;
use super::pace::Pace;
use super::parts::Worth;
use touchdown_scene::{Fidelity, Math, Model, Precision, Scheme};

/// One combination: how wrong it is, and what it costs.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Row {
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
    /// Greatest of the errors of time (in T), position (in rho0) and velocity (in V) at impact 1; null
    /// where the model or the reference has no such impact.
    pub error_impact_1: Option<f64>,
    /// At impact 3.
    pub error_impact_3: Option<f64>,
    /// At impact 10.
    pub error_impact_10: Option<f64>,
    /// Of the time of permanent contact, in T.
    pub contact_error: Option<f64>,
    /// Whether the run ends in the reference's regime.
    pub regime_ok: bool,
    /// Energy of translation and height at the end, less the reference's, in m g rho0 or, where that is
    /// larger, the reference's.
    pub energy_drift: f64,
    /// Here.
    pub ns_per_step: f64,
    /// Here.
    pub seconds_per_simulated_second: f64,
    /// On the target, mean of the run.
    pub mcu_instructions_per_step: Option<f64>,
    /// Whether no other row is both quicker here and closer at impacts 1, 3 and 10.
    pub pareto: bool,
    /// Greatest error at impacts 1, 3 and 10, infinite where one is missing; without impacts, of the energy.
    #[serde(skip)]
    pub worst_error: f64,
}

impl Row {
    pub(super) fn new(model: Model, accuracy: &Accuracy, pace: &Pace) -> Self {
        let [error_impact_1, error_impact_3, error_impact_10] = accuracy.impacts;
        Self {
            rung: model.rung,
            scheme: model.scheme,
            precision: model.precision,
            math: model.math,
            step_s: model.step,
            error_impact_1,
            error_impact_3,
            error_impact_10,
            contact_error: accuracy.contact,
            regime_ok: accuracy.regime,
            energy_drift: accuracy.energy,
            ns_per_step: pace.ns_per_step,
            seconds_per_simulated_second: pace.ns_per_step * 1e-9 / model.step,
            mcu_instructions_per_step: pace.target,
            pareto: false,
            worst_error: accuracy.worst(),
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

/// All of it as JSON.
pub fn json(trade: &Trade) -> serde_json::Result<String> {
    #[derive(Serialize)]
    struct Json<'a> {
        parts: &'a Worth,
        rows: &'a [Row],
    }
    let Trade { parts, rows, .. } = trade;
    serde_json::to_string_pretty(&Json { parts, rows })
}
