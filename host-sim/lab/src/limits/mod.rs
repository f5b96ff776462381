//! `touchdown limits`: the model at its extremes, each with what was measured, the limit and the verdict.
//!
//! What is measured is held against the independent reference, against closed forms, or against laws
//! that hold whatever the scene. One row holds the model against itself: that many ticks at once are as
//! good as one by one, which lets the long run be short.

mod bounce;
mod clock;
mod closed_form;
mod compliant;
mod coupled;
mod extreme;
mod machines;
mod pace;
mod refusal;
mod row;
mod scenes;
mod support;
mod table;
mod truth;
mod two_plane;
mod watch;

use std::collections::BTreeMap;

use rayon::prelude::*;
use touchdown_rotor::error::ConfigError;

pub use machines::{rows_of as machine_rows, text as machine};
pub use pace::rows as drops;
pub use row::{Row, all_hold};
pub use table::table;

use closed_form::ClosedForm;
use extreme::{Extreme, at_step};
use touchdown_base::failure::Failure;
use touchdown_base::progress::Progress;
use touchdown_page::json::text;
use touchdown_run::model::simulate;
use touchdown_scene::Precision;
use truth::Truth;

/// f64 first: what breaks there is no matter of rounding.
const PRECISIONS: [Precision; 2] = [Precision::F64, Precision::F32];

/// Runs every extreme in both precisions, and that many random machines.
pub fn run(machines: u64) -> Result<Vec<Row>, Failure> {
    let extremes = extreme::extremes()?;
    let closed_forms = closed_form::closed_forms()?;
    let jobs = (2 * extremes.len() + closed_forms.len()) as u64 + clock::JOBS + machines::JOBS;
    let mut progress = Progress::of_jobs("limits", jobs);
    let mut rows = Vec::new();
    for extreme in &extremes {
        let truth = Truth::of(&extreme.scene);
        for precision in PRECISIONS {
            rows.extend(scenes::rows(extreme, &truth, precision).map_err(refused)?);
        }
        progress.advance();
    }
    for known in &closed_forms {
        for (precision, limit) in PRECISIONS.into_iter().zip(known.limits) {
            rows.push(closed(known, precision, limit).map_err(refused)?);
        }
        progress.advance();
    }
    rows.extend(other_rungs(&extremes, &mut progress).map_err(refused)?);
    rows.extend(bounce::rows()?);
    rows.extend(clock::rows(&mut progress).map_err(refused)?);
    rows.extend(refusal::rows().map_err(refused)?);
    rows.extend(coupled::rows()?);
    rows.extend(machines::rows(machines, &mut progress)?);
    Ok(rows)
}

/// For `map_err`.
fn refused(error: ConfigError) -> Failure {
    Failure::Usage(format!("limits: {error}"))
}

/// The rungs that integrate, whose path is their own: what holds whatever the scene.
fn other_rungs(extremes: &[Extreme], progress: &mut Progress) -> Result<Vec<Row>, ConfigError> {
    let both = |extreme: &Extreme| -> Result<_, ConfigError> {
        let (mut moreau, mut hertz) = (Vec::new(), Vec::new());
        for precision in PRECISIONS {
            moreau.extend(scenes::stepped(extreme, precision)?);
            hertz.extend(compliant::rows(extreme, precision)?);
        }
        Ok((moreau, hertz))
    };
    let done: Result<(Vec<_>, Vec<_>), _> = extremes.par_iter().map(both).collect();
    let (moreau, hertz) = done?;
    extremes.iter().for_each(|_| progress.advance());
    Ok([moreau, hertz].concat().concat())
}

/// What rounding may add to the energy of a run at the scale of the gap, m g rho0: the targets of 10^6
/// steps without losses.
fn rounding(precision: Precision) -> f64 {
    match precision {
        Precision::F64 => 1e-12,
        Precision::F32 => 1e-4,
    }
}

/// Of the last digit of 1.
fn epsilon(precision: Precision) -> f64 {
    match precision {
        Precision::F64 => f64::EPSILON,
        Precision::F32 => f64::from(f32::EPSILON),
    }
}

fn closed(known: &ClosedForm, precision: Precision, limit: f64) -> Result<Row, ConfigError> {
    let mut worst = 0.0_f64;
    for &step in known.steps {
        let scene = at_step(&known.scene, precision, step);
        let error = (known.error)(&simulate(&scene)?);
        // NaN is the worst there is.
        worst = if error <= worst { worst } else { error };
    }
    Ok(Row::of(&known.name, precision).at_most(worst, limit, known.unit))
}

/// `limits --json`.
pub fn json(rows: &[Row]) -> serde_json::Result<String> {
    text(&BTreeMap::from([("rows", rows)]))
}
