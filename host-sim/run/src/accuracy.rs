//! How far the numbers of a run may be from the exact solution of the equations that the model solves.
//!
//! The same drop is run again in f64: the rigid rung from starts that differ by a rounding, which shows how fast an error
//! grows; a rung that steps also by shorter and longer steps, which shows what the step costs. An impact's error is the
//! greatest distance to its nearest in any of these runs. It does not shrink from one impact to the next. From where walls
//! jam nothing is told. How good that is: docs/know/accuracy.md.

use rayon::prelude::*;
use serde::Serialize;

use touchdown_base::history::{History, Impact};
use touchdown_base::progress;
use touchdown_scene::{Fidelity, Math, Precision, Scene, Start, Support};
use touchdown_truth::Units;

use crate::model::{self, ModelRun};

/// Change of a start, in parts of clearance, speed and spin: some roundings.
const NUDGE: f64 = 16.0 * f64::EPSILON;
/// Errors beyond this, in T or V, are those of another course.
const OTHER: f64 = 0.1;
/// Longest run by steps that is run again, s, and most work of it: the other runs take five times as much.
const LONGEST: f64 = 1.0;
const MOST_WORK: u64 = 1_000_000;

/// Of a run: part of its step, and of its distance that counts as error. An error of the first order is 4/3 of the distance
/// to a quarter of the step. The parts of the longer steps are chosen: they show what the shorter ones miss alike.
const STEPPED: &[[f64; 2]] = &[[0.25, 4.0 / 3.0], [2.0, 0.5], [3.0, 0.3]];
const NOT_STEPPED: &[[f64; 2]] = &[[1.0, 2.0]; 3];
/// What an error is taken to be greater by, in parts of itself for each T or V of it: it changes the course, and so grows
/// faster than what the other runs show.
const GROWTH: f64 = 50.0;
/// Of the starts: x, y, their speeds, spin.
const DIRECTIONS: [[f64; 5]; 3] = [
    [1.0, -0.7, 0.9, 0.8, 1.0],
    [-0.6, 1.0, 0.8, 1.0, -1.0],
    [0.5, 0.9, -1.0, 0.7, 0.6],
];

/// Estimated errors of a run's numbers; `None` where another run has nothing of the kind.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct RunAccuracy {
    /// Of each impact.
    pub impacts: Vec<Option<ImpactError>>,
    /// The first impact that not all runs have, or that is after walls jammed.
    pub uncertain_from: Option<usize>,
    /// s.
    pub contact_starts_s: Vec<Option<f64>>,
    /// s.
    pub lift_offs_s: Vec<Option<f64>>,
    /// s.
    pub rolling_starts_s: Vec<Option<f64>>,
    /// Whether all runs end in the same regime, and no walls jam.
    pub regime_is_certain: bool,
    /// At the end of the run.
    #[serde(rename = "final")]
    pub end: EndError,
}

/// Of an impact.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
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
    /// Of the last impact that all runs have: the greatest of theirs.
    pub fn worst(&self) -> Option<ImpactError> {
        let certain = self.uncertain_from.unwrap_or(self.impacts.len());
        *self.impacts[..certain].last()?
    }
}

/// Whether it has parts of which told errors were not held against the reference, or did not hold (docs/know/accuracy.md).
fn is_unproven(scene: &Scene) -> bool {
    let rubs = |it: Option<Support>| it.is_some_and(|it| it.friction > 0.0);
    let mut rings = scene.rings().iter();
    rings.any(|it| it.wall.is_some() || rubs(it.support)) || rubs(scene.support)
}

/// Of what `scene`'s model gave; none where it was given up, the run or its step is too long, another start or step is
/// refused, or contacts are compliant or a mount rubs.
pub fn estimate(scene: &Scene, run: &ModelRun) -> Option<RunAccuracy> {
    let (history, rings) = (&run.histories.whole, &run.histories.rings);
    let stepped = scene.model.rung != Fidelity::Rigid;
    let long = stepped && (scene.run.duration > LONGEST || run.work > MOST_WORK);
    if run.given_up.is_some() || long || is_unproven(scene) || !scene.step_is_short() {
        return None;
    }
    let others = others(scene, run, if stepped { STEPPED } else { NOT_STEPPED })?;
    let units = Units::of(scene);
    let times = |of: fn(&History) -> &[f64]| {
        let near = |time: f64| {
            let mut all = others.iter().map(|it| it.time(time, of(&it.history)));
            all.try_fold(0.0, |worst, it| it.map(|it| f64::max(worst, it)))
        };
        of(history).iter().copied().map(near).collect()
    };
    let mut impacts = Vec::new();
    let apart = |time: f64, speed: f64| (time / units.time).max(speed / units.speed);
    let greater = |a: [f64; 3], b: [f64; 3]| std::array::from_fn(|k| a[k].max(b[k]));
    let mut worst = Some([0.0; 3]);
    for impact in &history.impacts {
        let errors = others.iter().map(|it| it.impact(impact, &units));
        worst = errors.fold(worst, |worst, it| Some(greater(worst?, it?)));
        // The model tells the end of a series that is shorter than a step with its last impact.
        let starts = |it: &f64| it.total_cmp(&impact.state.time);
        let ends = |it: &History| stepped && it.contact_starts.binary_search_by(starts).is_ok();
        let lumped = ends(history) || rings.iter().any(ends);
        impacts.push(worst.map(|[time, speed, impulse]| {
            let more = 1.0 + GROWTH * apart(time, speed);
            ImpactError {
                time_s: more * time,
                normal_speed_m_s: more * speed,
                normal_impulse_n_s: (!lumped).then_some(more * impulse),
            }
        }));
    }
    let far = |it: ImpactError| apart(it.time_s, it.normal_speed_m_s) > OTHER;
    let other = |it: &Option<ImpactError>| it.is_none_or(far);
    Some(RunAccuracy {
        uncertain_from: impacts.iter().position(other),
        impacts,
        contact_starts_s: times(|it| &it.contact_starts),
        lift_offs_s: times(|it| &it.lift_offs),
        rolling_starts_s: times(|it| &it.rolling_starts),
        regime_is_certain: others
            .iter()
            .all(|it| it.jammed.is_infinite() && it.history.regime == history.regime),
        end: end(history, &others),
    })
}

/// The same drop, run again.
struct Other {
    history: History,
    /// When walls jam, in this run or in the first, s; else infinite.
    jammed: f64,
    weight: f64,
}

fn others(scene: &Scene, first: &ModelRun, runs: &[[f64; 2]]) -> Option<Vec<Other>> {
    let bar = progress::bar("accuracy", runs.len() as u64);
    let run = |(&[step, weight], direction): (&[f64; 2], [f64; 5])| {
        let run = model::run(&again(scene, step, direction)).ok()?;
        bar.inc(1);
        let jammed = [first, &run].map(|it| it.jammed.unwrap_or(f64::INFINITY));
        Some(Other {
            history: run.histories.whole,
            jammed: jammed[0].min(jammed[1]),
            weight,
        })
    };
    let all = runs.into_par_iter().zip(DIRECTIONS).map(run).collect();
    bar.finish_and_clear();
    all
}

impl Other {
    fn time(&self, time: f64, times: &[f64]) -> Option<f64> {
        let after = times.partition_point(|it| *it < time);
        let around = times[after.saturating_sub(1)..].iter().take(2);
        let nearest = around.map(|it| (it - time).abs()).reduce(f64::min);
        Some(self.weight * nearest.filter(|_| time < self.jammed)?)
    }

    /// Errors of time, normal speed and impulse.
    fn impact(&self, impact: &Impact, units: &Units) -> Option<[f64; 3]> {
        let late = |it: &Impact| (it.state.time - impact.state.time).abs() / units.time;
        let apart = |it: &Impact| {
            let speed = (it.normal_speed - impact.normal_speed) / units.speed;
            late(it).max(speed.abs())
        };
        let all = &self.history.impacts;
        let (before, after) =
            all.split_at(all.partition_point(|it| it.state.time < impact.state.time));
        let mut nearest: Option<&Impact> = None;
        let mut look = |it| {
            let farthest = nearest.map_or(f64::INFINITY, apart);
            if apart(it) < farthest {
                nearest = Some(it);
            }
            late(it) <= farthest
        };
        let _ = before.iter().rev().all(&mut look);
        let _ = after.iter().all(&mut look);
        let nearest = nearest.filter(|_| impact.state.time < self.jammed)?;
        let numbers = |it: &Impact| [it.state.time, it.normal_speed, it.normal_impulse];
        let (ours, theirs) = (numbers(impact), numbers(nearest));
        Some([0, 1, 2].map(|k| self.weight * (ours[k] - theirs[k]).abs()))
    }
}

fn end(history: &History, others: &[Other]) -> EndError {
    let apart = |a: [f64; 2], b: [f64; 2]| (a[0] - b[0]).abs().max((a[1] - b[1]).abs());
    let end = &history.end;
    let greatest = |of: &dyn Fn(&History) -> f64| {
        let all = others.iter().map(|it| it.weight * of(&it.history));
        all.fold(0.0, f64::max)
    };
    EndError {
        position_m: greatest(&|it| apart(end.position, it.end.position)),
        velocity_m_s: greatest(&|it| apart(end.velocity, it.end.velocity)),
    }
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
