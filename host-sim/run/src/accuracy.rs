//! How far the numbers of a run may be from the exact solution of the equations that the model solves.
//!
//! The same drop is run again in f64: the rigid rung from starts that differ by a rounding, which shows how fast an error
//! grows; a rung that steps also by half, twice and four times the step, which shows what the step costs. An
//! impact's error is the greatest distance to its nearest in any of these runs. It does not shrink from one impact
//! to the next; it is not told from the first impact on that one of the runs lacks. How good that is: docs/know/accuracy.md.

use rayon::prelude::*;
use serde::Serialize;

use touchdown_base::history::{History, Impact};
use touchdown_base::progress;
use touchdown_rotor::error::ConfigError;
use touchdown_scene::{Fidelity, Math, Precision, Scene, Start};
use touchdown_truth::Units;

use crate::model;

/// Change of a start, in parts of clearance, speed and spin: some roundings.
const NUDGE: f64 = 16.0 * f64::EPSILON;
/// Beyond this, in T or V, an impact is another one.
const OTHER: f64 = 0.1;
/// Longest part of a run by steps that is run again, s.
const LONGEST: f64 = 1.0;

/// Of a run: part of its step, and of its distance that counts as error. An error of the second order is 4/3 of the distance
/// to half the step, one of the first order twice that, or the distance to twice the step.
const STEPPED: [[f64; 2]; 3] = [[0.5, 2.0], [2.0, 1.0], [4.0, 0.5]];
const NOT_STEPPED: [[f64; 2]; 3] = [[1.0, 2.0]; 3];
/// Of the starts: x, y, their speeds, spin.
const DIRECTIONS: [[f64; 5]; 3] = [
    [1.0, -0.7, 0.9, 0.8, 1.0],
    [-0.6, 1.0, 0.8, 1.0, -1.0],
    [0.5, 0.9, -1.0, 0.7, 0.6],
];

/// Estimated errors of a run's numbers; `None` where the runs do not agree.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct RunAccuracy {
    /// Of each impact.
    pub impacts: Vec<Option<ImpactError>>,
    /// s.
    pub contact_starts_s: Vec<Option<f64>>,
    /// s.
    pub lift_offs_s: Vec<Option<f64>>,
    /// s.
    pub rolling_starts_s: Vec<Option<f64>>,
    /// Whether all runs end in the same regime.
    pub regime_is_certain: bool,
    /// At the end of the run.
    #[serde(rename = "final")]
    pub end: Option<EndError>,
}

/// Of an impact.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
pub struct ImpactError {
    /// s.
    pub time_s: f64,
    /// m/s.
    pub normal_speed_m_s: f64,
    /// N s; none where a step has taken the rest of a bounce series into it.
    pub normal_impulse_n_s: Option<f64>,
}

/// Of the end.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
pub struct EndError {
    /// In x or y, m.
    pub position_m: f64,
    /// m/s.
    pub velocity_m_s: f64,
}

impl RunAccuracy {
    /// The first impact that not all runs have.
    pub fn uncertain_from(&self) -> Option<usize> {
        self.impacts.iter().position(Option::is_none)
    }

    /// Of the last impact that all runs have: the greatest of all.
    pub fn worst(&self) -> Option<ImpactError> {
        self.impacts.iter().flatten().last().copied()
    }
}

/// Of what `scene`'s model gave; none where the run or its step is too long, or another start or step is refused.
pub fn estimate(scene: &Scene, history: &History) -> Option<RunAccuracy> {
    let stepped = scene.model.rung != Fidelity::Rigid;
    if stepped && scene.run.duration > LONGEST || !scene.step_is_short() {
        return None;
    }
    let runs = if stepped { STEPPED } else { NOT_STEPPED };
    let bar = progress::bar("accuracy", runs.len() as u64);
    let others = runs
        .into_par_iter()
        .zip(DIRECTIONS)
        .map(|([step, weight], direction)| {
            let history = model::simulate(&again(scene, step, direction))?;
            bar.inc(1);
            Ok(Other { history, weight })
        })
        .collect::<Result<Vec<_>, ConfigError>>();
    bar.finish_and_clear();
    let others = others.ok()?;
    let units = Units::of(scene);
    let limit = OTHER * units.time;
    let times = |of: fn(&History) -> &[f64]| {
        let near = |time: &f64| greatest(&others, |it| it.time(*time, of(&it.history), limit));
        of(history).iter().map(near).collect()
    };
    let mut impacts = Vec::new();
    let mut worst = Some(ImpactError::default());
    for impact in &history.impacts {
        worst = worst.and_then(|worst| worse(worst, impact, &others, &units));
        // The model tells the end of a series that is shorter than a step with its last impact.
        let starts = |it: &f64| it.total_cmp(&impact.state.time);
        let lumped = stepped && history.contact_starts.binary_search_by(starts).is_ok();
        impacts.push(worst.map(|worst| ImpactError {
            normal_impulse_n_s: worst.normal_impulse_n_s.filter(|_| !lumped),
            ..worst
        }));
    }
    Some(RunAccuracy {
        impacts,
        contact_starts_s: times(|it| &it.contact_starts),
        lift_offs_s: times(|it| &it.lift_offs),
        rolling_starts_s: times(|it| &it.rolling_starts),
        regime_is_certain: others.iter().all(|it| it.history.regime == history.regime),
        end: end(history, &others, &units),
    })
}

/// The same drop, run again.
struct Other {
    history: History,
    weight: f64,
}

impl Other {
    fn time(&self, time: f64, times: &[f64], limit: f64) -> Option<f64> {
        let after = times.partition_point(|it| *it < time);
        let around = times[after.saturating_sub(1)..].iter().take(2);
        let nearest = around.map(|it| (it - time).abs()).reduce(f64::min)?;
        (nearest <= limit).then_some(self.weight * nearest)
    }

    fn impact(&self, impact: &Impact, units: &Units) -> Option<ImpactError> {
        let apart = |it: &Impact| {
            let time = (it.state.time - impact.state.time) / units.time;
            let speed = (it.normal_speed - impact.normal_speed) / units.speed;
            time.abs().max(speed.abs())
        };
        let (time, limit) = (impact.state.time, OTHER * units.time);
        let all = &self.history.impacts;
        let of_time = |time: f64| all.partition_point(|it| it.state.time < time);
        let near = &all[of_time(time - limit)..of_time(time + limit)];
        let nearest = near.iter().min_by(|a, b| apart(a).total_cmp(&apart(b)))?;
        let of = |ours: f64, theirs: f64| self.weight * (ours - theirs).abs();
        (apart(nearest) <= OTHER).then(|| ImpactError {
            time_s: of(impact.state.time, nearest.state.time),
            normal_speed_m_s: of(impact.normal_speed, nearest.normal_speed),
            normal_impulse_n_s: Some(of(impact.normal_impulse, nearest.normal_impulse)),
        })
    }
}

/// The greatest of all runs; none where one of them has no such thing.
fn greatest(others: &[Other], of: impl Fn(&Other) -> Option<f64>) -> Option<f64> {
    others
        .iter()
        .try_fold(0.0_f64, |worst, it| Some(worst.max(of(it)?)))
}

fn worse(
    worst: ImpactError,
    impact: &Impact,
    others: &[Other],
    units: &Units,
) -> Option<ImpactError> {
    others.iter().try_fold(worst, |worst, it| {
        let it = it.impact(impact, units)?;
        let impulse = worst.normal_impulse_n_s.unwrap_or_default();
        Some(ImpactError {
            time_s: worst.time_s.max(it.time_s),
            normal_speed_m_s: worst.normal_speed_m_s.max(it.normal_speed_m_s),
            normal_impulse_n_s: it.normal_impulse_n_s.map(|it| it.max(impulse)),
        })
    })
}

fn end(history: &History, others: &[Other], units: &Units) -> Option<EndError> {
    let apart = |a: [f64; 2], b: [f64; 2]| (a[0] - b[0]).abs().max((a[1] - b[1]).abs());
    let end = &history.end;
    let place = |it: &Other| it.weight * apart(end.position, it.history.end.position);
    let speed = |it: &Other| it.weight * apart(end.velocity, it.history.end.velocity);
    let worst = EndError {
        position_m: greatest(others, |it| Some(place(it)))?,
        velocity_m_s: greatest(others, |it| Some(speed(it)))?,
    };
    let near =
        worst.position_m <= OTHER * units.length && worst.velocity_m_s <= OTHER * units.speed;
    near.then_some(worst)
}

/// The same drop in f64 and with another step, its start changed by next to nothing.
fn again(scene: &Scene, step: f64, [x, y, u, v, spin]: [f64; 5]) -> Scene {
    let units = Units::of(scene);
    let (far, fast) = (NUDGE * units.length, NUDGE * units.speed);
    let mut scene = scene.clone();
    scene.model.precision = Precision::F64;
    scene.model.math = Math::Libm;
    scene.model.step *= step;
    scene.rotor.spin *= 1.0 + NUDGE * spin;
    match &mut scene.start {
        Start::Free { position, velocity } => {
            *position = [position[0] + x * far, position[1] + y * far];
            *velocity = [velocity[0] + u * fast, velocity[1] + v * fast];
        }
        Start::Wall { angle, tangential } => {
            *angle += NUDGE * x;
            *tangential += fast * u;
        }
    }
    scene
}
