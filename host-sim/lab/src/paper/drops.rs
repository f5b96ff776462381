//! Random drops: how often a gap, a friction and a restitution end in whirl, and that the gap does not decide about it.
//!
//! The paper does not say from which starts a drop comes, so a spread was chosen: places even over the
//! clearance circle, velocities even over a circle of sqrt(g rho0) or none at all, spin 30 000 rpm. In
//! units of rho0 and sqrt(g rho0) it is the same in every gap. A drop is over at one full turn in one
//! contact (whirl) or after 100 sqrt(rho0/g).

use std::f64::consts::TAU;

use indicatif::ProgressBar;
use rand::Rng;
use rand_chacha::ChaCha8Rng;
use rand_chacha::rand_core::SeedableRng;
use rayon::prelude::*;
use serde::Serialize;

use super::ending::{Ending, of_model, of_reference};
use super::rig::{GAP, WIDE_GAP};
use super::row::Row;
use touchdown_base::failure::Failure;
use touchdown_base::{progress, wilson};
use touchdown_scene::{Scene, Start};

/// Length of a run, in sqrt(rho0/g).
const LONGEST: f64 = 100.0;
/// Share by which model and reference may differ: they part where a start grazes.
const CLOSE: f64 = 0.01;

/// A machine and a set of starts.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Condition {
    /// m.
    pub clearance_m: f64,
    /// Coulomb's coefficient.
    pub friction: f64,
    /// 0 to 1.
    pub restitution: f64,
    /// Largest speed of a start, in sqrt(g rho0).
    pub fastest: f64,
    /// Of the starts.
    pub seed: u64,
}

/// How many drops of a condition ended how.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Tally {
    /// The condition.
    #[serde(flatten)]
    pub condition: Condition,
    /// All.
    pub drops: u32,
    /// Of the model under test.
    pub whirl: u32,
    /// 95 % interval of the probability of whirl, after Wilson.
    pub whirl_low: f64,
    /// Its other end.
    pub whirl_high: f64,
    /// Of the reference, from the same starts.
    pub whirl_of_reference: u32,
    /// Of the model under test.
    pub cycle: u32,
    /// Of the reference.
    pub cycle_of_reference: u32,
    /// Of the model under test.
    pub bouncing: u32,
    /// Each drop of the model under test.
    #[serde(skip)]
    pub ends: Vec<Ending>,
}

/// What is compared, all against the first: gap (other starts, then the same), friction, restitution, and starts at rest.
/// Gap, friction, restitution, fastest and seed of each.
const CONDITIONS: [(f64, f64, f64, f64, u64); 11] = [
    (GAP, 0.1, 0.8, 1.0, 1),
    (WIDE_GAP, 0.1, 0.8, 1.0, 2),
    (GAP, 0.2, 0.8, 1.0, 1),
    (GAP, 0.3, 0.8, 1.0, 1),
    (WIDE_GAP, 0.3, 0.8, 1.0, 1),
    (GAP, 0.5, 0.8, 1.0, 1),
    (GAP, 0.3, 0.2, 1.0, 1),
    (GAP, 0.3, 0.5, 1.0, 1),
    (GAP, 0.1, 0.95, 1.0, 1),
    (GAP, 0.1, 0.8, 0.0, 1),
    (GAP, 0.3, 0.8, 0.0, 1),
];

/// Drops `base` as each condition says, `drops` times.
pub fn tally(base: &Scene, drops: u32) -> Result<Vec<Tally>, Failure> {
    let progress = progress::bar("drops", u64::from(drops) * CONDITIONS.len() as u64);
    let counted = |(clearance_m, friction, restitution, fastest, seed)| {
        let condition = Condition {
            clearance_m,
            friction,
            restitution,
            fastest,
            seed,
        };
        count(base, condition, drops, &progress)
    };
    CONDITIONS.into_iter().map(counted).collect()
}

fn count(
    base: &Scene,
    condition: Condition,
    drops: u32,
    progress: &ProgressBar,
) -> Result<Tally, Failure> {
    let ends: Vec<(Ending, Ending)> = (0..drops)
        .into_par_iter()
        .map(|number| {
            let scene = random(base, condition, number);
            let ours = of_model(&scene)?;
            progress.inc(1);
            Ok((ours, of_reference(&scene)))
        })
        .collect::<Result<_, Failure>>()?;
    let ours = |wanted| ends.iter().filter(|it| it.0 == wanted).count() as u32;
    let reference = |wanted| ends.iter().filter(|it| it.1 == wanted).count() as u32;
    let whirl = ours(Ending::Whirl);
    let (whirl_low, whirl_high) = wilson::interval(u64::from(whirl), u64::from(drops));
    Ok(Tally {
        condition,
        drops,
        whirl,
        whirl_low,
        whirl_high,
        whirl_of_reference: reference(Ending::Whirl),
        cycle: ours(Ending::Cycle),
        cycle_of_reference: reference(Ending::Cycle),
        bouncing: ours(Ending::Bouncing),
        ends: ends.iter().map(|it| it.0).collect(),
    })
}

/// Drop `number` of a condition; the same whatever ran before.
fn random(base: &Scene, condition: Condition, number: u32) -> Scene {
    let mut random = ChaCha8Rng::seed_from_u64(condition.seed);
    random.set_stream(u64::from(number));
    let mut in_circle = |radius: f64| {
        let distance = radius * random.random::<f64>().sqrt();
        let (sin, cos) = (TAU * random.random::<f64>()).sin_cos();
        [distance * sin, distance * cos]
    };
    let mut scene = base.clone();
    scene.retainer.clearance = condition.clearance_m;
    scene.retainer.friction = condition.friction;
    scene.retainer.restitution = condition.restitution;
    let speed = (scene.run.gravity * condition.clearance_m).sqrt();
    scene.start = Start::Free {
        position: in_circle(condition.clearance_m),
        velocity: in_circle(condition.fastest * speed),
    };
    scene.run.duration = LONGEST * condition.clearance_m / speed;
    scene
}

pub fn rows(tallies: &[Tally]) -> Vec<Row> {
    let mut rows: Vec<Row> = tallies.iter().map(whirl).collect();
    rows.extend(same_starts(tallies));
    rows.extend(tallies.iter().find(|it| it.cycle > 0).map(third_motion));
    rows
}

fn whirl(tally: &Tally) -> Row {
    Row::new(
        &format!("whirl, {}", name(tally)),
        "",
        share(tally.whirl_of_reference, tally),
    )
    .ours(share(tally.whirl, tally), CLOSE)
    .note(&format!(
        "{} of {} drops, 95 % interval {:.3} to {:.3}; right: reference, same starts",
        tally.whirl, tally.drops, tally.whirl_low, tally.whirl_high
    ))
}

/// Drops from the same scaled starts in both gaps that ended otherwise in the wider one.
fn same_starts(tallies: &[Tally]) -> Option<Row> {
    let of = |condition: Condition| tallies.iter().find(|it| it.condition == condition);
    let (narrow, wide) = tallies.iter().find_map(|narrow| {
        let wide = of(Condition {
            clearance_m: WIDE_GAP,
            ..narrow.condition
        })?;
        (wide.condition != narrow.condition).then_some((narrow, wide))
    })?;
    let differ = wide.ends.iter().zip(&narrow.ends).filter(|(a, b)| a != b);
    let row = Row::new("drops that end otherwise at 0.75 mm", "", 0.0)
        .ours(differ.count() as f64, CLOSE * f64::from(wide.drops))
        .note("of those at mu 0.3, same starts in units of rho0 and sqrt(g rho0) as at 0.3 mm; right: the scale law has no gap");
    Some(row)
}

fn third_motion(tally: &Tally) -> Row {
    Row::new(
        &format!("third motion, {}", name(tally)),
        "",
        share(tally.cycle_of_reference, tally),
    )
    .printed(0.0)
    .ours(share(tally.cycle, tally), CLOSE)
    .note("the paper names whirl and pendulum; this one slides, lifts off and bounces, four times or more; right: reference")
}

fn name(tally: &Tally) -> String {
    let it = &tally.condition;
    let gap = it.clearance_m * 1e3;
    let speed = if it.fastest > 0.0 { "" } else { ", at rest" };
    format!(
        "{gap} mm, mu {}, eps {}{speed}",
        it.friction, it.restitution
    )
}

fn share(count: u32, tally: &Tally) -> f64 {
    f64::from(count) / f64::from(tally.drops)
}
