//! Each extreme scene on rung `moreau`, watched. How far its impacts are off depends on the step; what
//! is held here holds at any step.

use touchdown_rotor::error::ConfigError;

use crate::limits::extreme::{Extreme, at_step};
use crate::limits::row::{Row, Worst};
use crate::limits::watch::{Watch, most};
use touchdown_run::model::with_model;
use touchdown_scene::{Fidelity, Precision, Scheme};
use touchdown_truth::Units;

/// Changes of motion in a step: impact, start of contact, and one of slip (`docs/know/model.md`).
const MOST_CHANGES: f64 = 3.0;
/// Energy may rise by this part of h^2 in m g rho0 over a run: putting the rotor back onto the wall
/// costs height that it has no speed to pay for, up to (g h)^2/2 (`docs/know/model.md`).
const ENERGY: f64 = 0.5;

/// All measures of one extreme in one precision.
pub fn rows(extreme: &Extreme, precision: Precision) -> Result<Vec<Row>, ConfigError> {
    let mut runs = Vec::new();
    let mut energy = Worst::default();
    for &step in extreme.steps {
        let mut scene = at_step(&extreme.scene, precision, step);
        scene.model.rung = Fidelity::Moreau;
        scene.model.scheme = Scheme::Midpoint;
        let seen = with_model(&scene, Watch(&scene))?;
        let h = step / Units::of(&scene).time;
        let rounding = super::rounding(precision) + seen.spin_rounding + seen.path_rounding;
        energy.take(seen.energy_gain, ENERGY * h * h + rounding);
        runs.push(seen);
    }
    let row = |measure: &str, measured, limit, unit| {
        let name = format!("moreau: {}: {measure}", extreme.name);
        Row::new(name, precision, measured, limit, unit)
    };
    let outside = most(&runs, |it| it.outside_path);
    let not_finite = most(&runs, |it| f64::from(it.not_finite));
    let changes = most(&runs, |it| f64::from(it.changes));
    Ok(vec![
        row("energy gained", energy.measured, energy.limit, "m g rho0"),
        row(
            "farthest beyond the wall",
            outside,
            1.0,
            "of half a step's path",
        ),
        row("steps with NaN or infinity", not_finite, 0.0, "steps"),
        row("most changes in a step", changes, MOST_CHANGES, "changes"),
    ])
}
