//! Each extreme scene on rung `hertz`, in both schemes: steps that it refuses, and what holds at those
//! that it takes.

use touchdown_rotor::error::ConfigError;

use crate::limits::extreme::{Extreme, STEPS, at_step};
use crate::limits::press::Press;
use crate::limits::row::{Row, Worst};
use touchdown_run::model::with_model;
use touchdown_scene::scales::compliance;
use touchdown_scene::{Fidelity, Precision, Scene, Scheme};

/// Part of 2/omega_c that is still taken, and the part that no longer is.
const TAKEN: f64 = 0.999;
const REFUSED: f64 = 1.001;
/// Part of the largest translation that a run may gain: the 0.5 % to which restitution is kept at
/// T_c/25, twice as much in energy (`docs/know/model.md`).
const ENERGY: f64 = 0.01;

/// All measures of one extreme in one precision.
pub fn rows(extreme: &Extreme, precision: Precision) -> Result<Vec<Row>, ConfigError> {
    let stiff = compliance(&compliant(extreme, precision, 1e-6))?;
    let (limit, accurate) = (stiff.longest_step(), stiff.accurate_step());
    let (mut taken, mut refused): (Vec<f64>, Vec<f64>) =
        extreme.steps.iter().partition(|step| **step <= limit);
    if extreme.steps == STEPS {
        taken.extend([accurate, TAKEN * limit]);
    }
    refused.push(REFUSED * limit);

    let (mut energy, mut accepted) = (Worst::default(), 0);
    let (mut drawn, mut deepest, mut not_finite) = (0.0, 0.0_f64, 0);
    for &scheme in Fidelity::Hertz.schemes() {
        let watched = |step| {
            let mut scene = compliant(extreme, precision, step);
            scene.model.scheme = scheme;
            let (scene, stiff) = (&scene, &stiff);
            with_model(scene, Press { scene, stiff })
        };
        for &step in &taken {
            let seen = watched(step)?;
            if step <= accurate {
                let rounding = super::rounding(precision) + seen.rounding;
                let late = match scheme {
                    Scheme::Euler => seen.half_steps,
                    _ => 0.0,
                };
                let limit = ENERGY * seen.translation + late + rounding;
                energy.take(seen.energy_gain, limit);
                drawn = f64::max(drawn, seen.drawn);
            }
            deepest = deepest.max(seen.depth);
            not_finite = not_finite.max(seen.not_finite);
        }
        for &step in &refused {
            accepted += u32::from(watched(step).is_ok());
        }
    }
    let row = |measure: &str, measured, limit, unit| {
        let name = format!("hertz: {}: {measure}", extreme.name);
        Row::new(name, precision, measured, limit, unit)
    };
    let mut rows = vec![row(
        "steps above 2/omega_c",
        f64::from(accepted),
        0.0,
        "accepted",
    )];
    if !taken.is_empty() {
        rows.push(row(
            "energy gained at T_c/25 and below",
            energy.measured,
            energy.limit,
            "m g rho0",
        ));
        rows.push(row(
            "translation at any speed, T_c/25 and below",
            drawn,
            1.0 + ENERGY,
            "of all energy at the start",
        ));
        rows.push(row(
            "deepest compression",
            deepest,
            1.0,
            "of what the speed allows",
        ));
        rows.push(row(
            "steps with NaN or infinity",
            f64::from(not_finite),
            0.0,
            "steps",
        ));
    }
    Ok(rows)
}

fn compliant(extreme: &Extreme, precision: Precision, step: f64) -> Scene {
    let mut scene = at_step(&extreme.scene, precision, step);
    scene.model.rung = Fidelity::Hertz;
    scene
}
