//! What is held of the rungs `support` and `two-plane` at any extreme, watched step by step: no wall is
//! passed, contacts make no energy, and all of it is accounted for.

use touchdown_rotor::error::ConfigError;

use super::extreme::STEPS;
use super::glance::Glance;
use super::row::{Row, Worst};
use super::{epsilon, refused};
use crate::{limits::support, limits::two_plane};
use touchdown_base::failure::Failure;
use touchdown_run::model::ModelRun;
use touchdown_scene::{Fidelity, Precision, Scene};
use touchdown_truth::{Units, simulate};

/// Of a place or an energy, in units of the last digit.
const ROUNDED: f64 = 64.0;

/// How long the reference runs beyond the model's first impact, s.
const AFTER: f64 = 20e-6;

/// Of the first impact's time, h^2/T: forces that go round with the spin change within a step. Chosen.
const LATE: f64 = 4.0;

/// All measures of all extremes of both rungs.
pub fn rows() -> Result<Vec<Row>, Failure> {
    let scenes = support::scenes()?.into_iter().chain(two_plane::scenes()?);
    let mut rows = Vec::new();
    for (name, scene) in scenes {
        for precision in super::PRECISIONS {
            rows.extend(of(name, &scene, precision).map_err(refused)?);
        }
    }
    Ok(rows)
}

fn run(scene: &Scene, each: &mut dyn FnMut(Glance)) -> Result<ModelRun, ConfigError> {
    match scene.model.rung {
        Fidelity::TwoPlane => two_plane::run(scene, each),
        _ => support::run(scene, each),
    }
}

/// Worst of all steps.
#[derive(Default)]
struct Seen {
    beyond: Worst,
    made: Worst,
    missing: Worst,
    late: Worst,
    broken: u32,
}

fn of(name: &str, scene: &Scene, precision: Precision) -> Result<Vec<Row>, ConfigError> {
    let mut seen = Seen::default();
    let mut first = None;
    for step in STEPS {
        let mut scene = scene.clone();
        scene.model.precision = precision;
        scene.model.step = step;
        let Some(ours) = look(&scene, &mut seen)? else {
            continue;
        };
        let units = Units::of(&scene);
        let truth = *first.get_or_insert_with(|| first_impact(&scene, ours));
        let step = step / units.time;
        let limit = LATE * step * step + ROUNDED * epsilon(precision);
        seen.late.take((ours - truth).abs() / units.time, limit);
    }
    let row = |measure: &str, worst: Worst, unit| {
        let name = format!("{}: {name}: {measure}", scene.model.rung.name());
        Row::new(name, precision, worst.measured, worst.limit, unit)
    };
    let broken = Worst {
        measured: f64::from(seen.broken),
        limit: 0.0,
    };
    let mut rows = vec![
        row("farthest beyond a wall", seen.beyond, "of a step's path"),
        row("energy made by contacts", seen.made, "m g rho0"),
        row("energy not accounted for", seen.missing, "m g rho0"),
        row("steps with NaN or infinity", broken, "steps"),
    ];
    if first.is_some() {
        rows.push(row("first impact, off the reference", seen.late, "T"));
    }
    Ok(rows)
}

/// Of the reference, s; infinite where it has none at about this time. What follows may be costly.
fn first_impact(scene: &Scene, about: f64) -> f64 {
    let mut scene = scene.clone();
    scene.run.duration = about + AFTER;
    let first = simulate(&scene).impacts.first().map(|it| it.state.time);
    first.unwrap_or(f64::INFINITY)
}

/// Watches one run; the time of its first impact, s.
fn look(scene: &Scene, seen: &mut Seen) -> Result<Option<f64>, ConfigError> {
    let epsilon = epsilon(scene.model.precision);
    let (mut start, mut most_gone) = (None, f64::MIN);
    let (mut farthest, mut made, mut missing, mut size) = (0.0_f64, 0.0_f64, 0.0_f64, 0.0_f64);
    let (mut fastest, step) = (0.0_f64, scene.model.step / Units::of(scene).time);
    let run = run(scene, &mut |glance| {
        let numbers = [glance.beyond, glance.total, glance.gone];
        let mut all = numbers.iter().chain(&glance.parts);
        seen.broken += u32::from(all.any(|number| !number.is_finite()));
        most_gone = most_gone.max(glance.gone);
        made = made.max(most_gone - glance.gone);
        fastest = fastest.max((2.0 * glance.motion).sqrt());
        let path = step * (fastest + step) * glance.lever + ROUNDED * epsilon;
        farthest = farthest.max(glance.beyond / path);
        missing = missing.max((glance.total - *start.get_or_insert(glance.total)).abs());
        let parts = glance
            .parts
            .iter()
            .fold(glance.gone.abs(), |sum, it| sum + it.abs());
        size = size.max(parts);
    })?;
    let rounding = super::rounding(scene.model.precision) + ROUNDED * epsilon * size;
    seen.beyond.take(farthest, 1.0);
    // Slip is stopped at the end of a step, not in its mean: off by the square of the angle that it turns.
    let turned = step * fastest;
    seen.made
        .take(made, rounding + 0.25 * turned * turned * fastest * fastest);
    seen.missing.take(missing, rounding);
    let first = run.histories.whole.impacts.first();
    Ok(first.map(|impact| impact.state.time))
}
