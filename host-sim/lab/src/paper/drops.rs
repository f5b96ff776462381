//! Random drops: how often a gap, a friction and a restitution end in whirl.
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
use touchdown_base::failure::Failure;
use touchdown_base::{progress, wilson};
use touchdown_scene::{Scene, Start};

/// Length of a run, in sqrt(rho0/g).
const LONGEST: f64 = 100.0;
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

/// What is compared, all against the first: gap (other starts, then the same), friction, restitution.
fn conditions() -> Vec<Condition> {
    let rig = Condition {
        clearance_m: GAP,
        friction: 0.1,
        restitution: 0.8,
        fastest: 1.0,
        seed: 1,
    };
    let wide = |condition| Condition {
        clearance_m: WIDE_GAP,
        ..condition
    };
    let rough = |friction| Condition { friction, ..rig };
    let lively = |restitution| Condition {
        restitution,
        ..rough(0.3)
    };
    let at_rest = |condition| Condition {
        fastest: 0.0,
        ..condition
    };
    vec![
        rig,
        Condition {
            seed: 2,
            ..wide(rig)
        },
        rough(0.2),
        rough(0.3),
        wide(rough(0.3)),
        rough(0.5),
        lively(0.2),
        lively(0.5),
        Condition {
            restitution: 0.95,
            ..rig
        },
        at_rest(rig),
        at_rest(rough(0.3)),
    ]
}

/// Drops `base` as each condition says, `drops` times.
pub fn tally(base: &Scene, drops: u32) -> Result<Vec<Tally>, Failure> {
    let conditions = conditions();
    let progress = progress::bar("drops", u64::from(drops) * conditions.len() as u64);
    let tallies = (conditions.into_iter())
        .map(|condition| count(base, condition, drops, &progress))
        .collect();
    progress.finish_and_clear();
    tallies
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
