//! How far a model's drop is from the reference's.

use serde::Serialize;

use touchdown_base::history::{History, Impact, RotorState};
use touchdown_scene::Scene;
use touchdown_truth::Units;

/// Impacts at which the error is told.
const IMPACTS: [usize; 3] = [1, 3, 10];

/// Errors in units of the clearance rho0, T = sqrt(rho0/g) and V = sqrt(g rho0); without gravity V is the
/// speed of the start, or 1 m/s.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub(super) struct Accuracy {
    /// Greatest of the errors of time, position and velocity just after impact 1; none where the model or the
    /// reference has no such impact.
    pub error_impact_1: Option<f64>,
    /// At impact 3.
    pub error_impact_3: Option<f64>,
    /// At impact 10.
    pub error_impact_10: Option<f64>,
    /// Time of the first permanent contact; none where the model or the reference has none.
    pub contact_error: Option<f64>,
    /// Whether the run ends in the reference's regime.
    pub regime_ok: bool,
    /// Energy of translation and height at the end of the run, less the reference's, in units of V^2 or of
    /// the reference's energy, whichever is larger.
    pub energy_drift: f64,
    /// Greatest error at those of the impacts that the reference has, infinite where the model misses one; without
    /// impacts, of the energy.
    #[serde(skip)]
    pub worst: f64,
}

fn apart(a: &Impact, b: &Impact, units: Units) -> f64 {
    let (a, b) = (&a.state, &b.state);
    let time = (a.time - b.time).abs() / units.time;
    let place = distance(a.position, b.position) / units.length;
    time.max(place)
        .max(distance(a.velocity, b.velocity) / units.speed)
}

fn distance(a: [f64; 2], b: [f64; 2]) -> f64 {
    (a[0] - b[0]).hypot(a[1] - b[1])
}

impl Accuracy {
    pub(super) fn of(history: &History, truth: &History, scene: &Scene) -> Self {
        let units = Units::of(scene);
        let contact = |history: &History| history.contact_starts.first().copied();
        let errors = IMPACTS.map(|k| {
            let pair = history.impacts.get(k - 1).zip(truth.impacts.get(k - 1));
            pair.map(|(a, b)| apart(a, b, units))
        });
        let expected = (errors.iter().zip(IMPACTS)).filter(|(_, k)| truth.impacts.len() >= *k);
        let worst = expected.map(|(error, _)| error.unwrap_or(f64::INFINITY));
        let [error_impact_1, error_impact_3, error_impact_10] = errors;
        let energy_drift = energy_apart(&history.end, &truth.end, scene.run.gravity, units.speed);
        Self {
            error_impact_1,
            error_impact_3,
            error_impact_10,
            contact_error: contact(history)
                .zip(contact(truth))
                .map(|(a, b)| (a - b).abs() / units.time),
            regime_ok: history.regime == truth.regime,
            energy_drift,
            worst: worst.reduce(f64::max).unwrap_or(energy_drift),
        }
    }
}

/// Energies a unit of mass.
fn energy_apart(a: &RotorState, b: &RotorState, gravity: f64, speed: f64) -> f64 {
    let energy = |state: &RotorState| {
        let [u, v] = state.velocity;
        0.5 * (u * u + v * v) + gravity * state.position[1]
    };
    let (ours, theirs) = (energy(a), energy(b));
    (ours - theirs).abs() / theirs.abs().max(speed * speed)
}
