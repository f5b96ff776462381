//! Each extreme scene watched: on rung `rigid`, also against the reference, and on rung `moreau`.

use touchdown_rotor::error::ConfigError;

use super::epsilon;
use crate::limits::extreme::{Extreme, at_step};
use crate::limits::row::{Row, Worst};
use crate::limits::truth::Truth;
use crate::limits::watch::{ROUNDED, Watch, most};
use touchdown_run::model::{simulate, with_model};
use touchdown_scene::{Fidelity, Precision, Scheme};
use touchdown_truth::Units;

/// Bound on what is followed in a step: 512 impacts and 256 stretches of contact.
const MOST_CHANGES: f64 = 768.0;
/// Changes in a step from which on a bounce series was cut short there, and what its end may then be
/// off, T: the rest was summed from a speed that is not tiny.
const CUT: u32 = 512;
const CUT_ERROR: f64 = 1e-7;

/// Changes of motion in a step of rung `moreau`: impact, start of contact, and one of slip (`docs/know/model.md`).
const MOST_STEPPED: f64 = 3.0;
/// Energy may rise by this part of h^2 in m g rho0 over a run there: putting the rotor back onto the wall
/// costs height that it has no speed to pay for, up to (g h)^2/2 (`docs/know/model.md`).
const ENERGY: f64 = 0.5;

/// All measures of one extreme in one precision.
pub fn rows(
    extreme: &Extreme,
    truth: &Truth,
    precision: Precision,
) -> Result<Vec<Row>, ConfigError> {
    let mut runs = Vec::new();
    let mut impacts = (0.0_f64, 0);
    let mut contact = Worst::default();
    for &step in extreme.steps {
        let scene = at_step(&extreme.scene, precision, step);
        let seen = with_model(&scene, Watch(&scene))?;
        let history = simulate(&scene)?;
        let (error, compared) = truth.impact_error(&history, precision);
        impacts = (impacts.0.max(error), compared);
        if let Some((error, limit)) = truth.contact_error(&history, precision) {
            let cut = if seen.changes > CUT { CUT_ERROR } else { 0.0 };
            contact.take(error, limit.max(cut));
        }
        runs.push(seen);
    }
    let row = |measure: &str| Row::of(format!("{}: {measure}", extreme.name), precision);
    let mut rows = Vec::new();
    if impacts.1 > 0 {
        rows.push(row("error of the first impacts").at_most(impacts.0, 1.0, "of target"));
    }
    if contact.limit > 0.0 {
        rows.push(row("time of permanent contact").worst(contact, "T"));
    }
    let gained = most(&runs, |it| it.energy_gain);
    let spin = most(&runs, |it| it.spin_rounding);
    let path = most(&runs, |it| it.path_rounding);
    let rounding = super::rounding(precision) + spin + path;
    let outside = most(&runs, |it| it.outside);
    let not_finite = most(&runs, |it| f64::from(it.not_finite));
    let changes = most(&runs, |it| f64::from(it.changes));
    let rounded = ROUNDED * epsilon(precision);
    rows.extend([
        row("energy gained").at_most(gained, rounding, "m g rho0"),
        row("farthest beyond the wall").at_most(outside, rounded, "rho0"),
        row("steps with NaN or infinity").at_most(not_finite, 0.0, "steps"),
        row("most changes in a step").at_most(changes, MOST_CHANGES, "changes"),
    ]);
    Ok(rows)
}

/// The same on rung `moreau`. How far its impacts are off depends on the step; what is held here holds at any step.
pub fn stepped(extreme: &Extreme, precision: Precision) -> Result<Vec<Row>, ConfigError> {
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
    let row = |measure: &str| Row::of(format!("moreau: {}: {measure}", extreme.name), precision);
    let outside = most(&runs, |it| it.outside_path);
    let not_finite = most(&runs, |it| f64::from(it.not_finite));
    let changes = most(&runs, |it| f64::from(it.changes));
    Ok(vec![
        row("energy gained").worst(energy, "m g rho0"),
        row("farthest beyond the wall").at_most(outside, 1.0, "of half a step's path"),
        row("steps with NaN or infinity").at_most(not_finite, 0.0, "steps"),
        row("most changes in a step").at_most(changes, MOST_STEPPED, "changes"),
    ])
}
