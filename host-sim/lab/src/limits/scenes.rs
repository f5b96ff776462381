//! Each extreme scene against the reference, and watched.

use touchdown_rotor::error::ConfigError;

use super::epsilon;
use crate::limits::extreme::{Extreme, at_step};
use crate::limits::row::{Row, Worst};
use crate::limits::truth::Truth;
use crate::limits::watch::{ROUNDED, Watch, most};
use touchdown_run::model::{simulate, with_model};
use touchdown_scene::Precision;

/// Bound on what is followed in a step: 512 impacts and 256 stretches of contact.
const MOST_CHANGES: f64 = 768.0;
/// Changes in a step from which on a bounce series was cut short there, and what its end may then be
/// off, T: the rest was summed from a speed that is not tiny.
const CUT: u32 = 512;
const CUT_ERROR: f64 = 1e-7;

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
            let limit = if seen.changes > CUT {
                limit.max(CUT_ERROR)
            } else {
                limit
            };
            contact.take(error, limit);
        }
        runs.push(seen);
    }
    let row = |measure: &str, measured, limit, unit| {
        let name = format!("{}: {measure}", extreme.name);
        Row::new(name, precision, measured, limit, unit)
    };
    let mut rows = Vec::new();
    let first = row("error of the first impacts", impacts.0, 1.0, "of target");
    rows.extend((impacts.1 > 0).then_some(first));
    if contact.limit > 0.0 {
        rows.push(row(
            "time of permanent contact",
            contact.measured,
            contact.limit,
            "T",
        ));
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
        row("energy gained", gained, rounding, "m g rho0"),
        row("farthest beyond the wall", outside, rounded, "rho0"),
        row("steps with NaN or infinity", not_finite, 0.0, "steps"),
        row("most changes in a step", changes, MOST_CHANGES, "changes"),
    ]);
    Ok(rows)
}
