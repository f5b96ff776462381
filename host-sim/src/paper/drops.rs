//! Random drops: how often a gap, a friction and a restitution end in whirl.
//!
//! The paper does not say how its starts are spread, so a spread was chosen: places even over the
//! clearance circle, velocities even over a circle of the speed of a fall through the gap, spin 30 000
//! rpm. In units of rho0 and sqrt(g rho0) it is the same in every gap. A drop is over at one full turn in
//! one contact (whirl) or after 100 sqrt(rho0/g).

use std::f64::consts::{SQRT_2, TAU};

use indicatif::ProgressBar;
use rand::Rng;
use rand_chacha::ChaCha8Rng;
use rand_chacha::rand_core::SeedableRng;
use rayon::prelude::*;
use serde::Serialize;
use touchdown_core::error::ConfigError;
use touchdown_core::model::{Change, Precision, Stepper, Touch};

use super::rig::{GAP, WIDE_GAP};
use super::wilson;
use crate::failure::Failure;
use crate::history::{Happening, PhaseKind};
use crate::model_run::{Subject, Use, with_model};
use crate::reference::Reference;
use crate::scene::{Scene, Start};

/// Largest speed of a start, in sqrt(g rho0).
const FASTEST: f64 = SQRT_2;
/// Length of a run, in sqrt(rho0/g).
const LONGEST: f64 = 100.0;
/// Lift-offs from which a run without whirl counts as the third motion.
const CYCLE: u32 = 4;

/// A machine and a set of starts.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Condition {
    /// m.
    pub clearance_m: f64,
    /// Coulomb's coefficient.
    pub friction: f64,
    /// 0 to 1.
    pub restitution: f64,
    /// Of the starts.
    pub seed: u64,
}

/// How a drop ends.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum End {
    /// A full turn in one contact.
    Whirl,
    /// In contact, swinging at the bottom.
    Pendulum,
    /// Neither: contact is lost and found again and again.
    Cycle,
    /// Still in its bounce series.
    Bouncing,
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
    pub ends: Vec<End>,
}

/// What is compared, all against the first: gap (other starts, then the same), friction, restitution.
pub fn conditions() -> Vec<Condition> {
    let rig = Condition {
        clearance_m: GAP,
        friction: 0.1,
        restitution: 0.8,
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
    ]
}

/// Drops `base` as each condition says, `drops` times.
pub fn tally(
    base: &Scene,
    conditions: &[Condition],
    drops: u32,
    progress: &ProgressBar,
) -> Result<Vec<Tally>, Failure> {
    conditions
        .iter()
        .map(|condition| count(base, *condition, drops, progress))
        .collect()
}

fn count(
    base: &Scene,
    condition: Condition,
    drops: u32,
    progress: &ProgressBar,
) -> Result<Tally, Failure> {
    let ends: Vec<(End, End)> = (0..drops)
        .into_par_iter()
        .map(|number| {
            let scene = random(base, condition, number);
            let ours = with_model(&scene, ToItsEnd(&scene));
            progress.inc(1);
            ours.map(|end| (end, of_reference(&scene)))
        })
        .collect::<Result<_, ConfigError>>()
        .map_err(|error| Failure::Usage(error.to_string()))?;
    let ours = |wanted| ends.iter().filter(|it| it.0 == wanted).count() as u32;
    let reference = |wanted| ends.iter().filter(|it| it.1 == wanted).count() as u32;
    let whirl = ours(End::Whirl);
    let (whirl_low, whirl_high) = wilson::interval(whirl, drops);
    Ok(Tally {
        condition,
        drops,
        whirl,
        whirl_low,
        whirl_high,
        whirl_of_reference: reference(End::Whirl),
        cycle: ours(End::Cycle),
        cycle_of_reference: reference(End::Cycle),
        bouncing: ours(End::Bouncing),
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
        velocity: in_circle(FASTEST * speed),
    };
    scene.run.duration = LONGEST * condition.clearance_m / speed;
    scene
}

fn end(turns: f64, lift_offs: u32, in_contact: bool) -> End {
    if turns.abs() >= 1.0 {
        End::Whirl
    } else if lift_offs >= CYCLE {
        End::Cycle
    } else if in_contact {
        End::Pendulum
    } else {
        End::Bouncing
    }
}

/// Runs a model until it whirls or the time is over.
struct ToItsEnd<'a>(&'a Scene);

impl Use for ToItsEnd<'_> {
    type Output = End;

    fn with<R: Precision, M: Stepper<R>>(
        self,
        subject: &Subject<R, M>,
    ) -> Result<End, ConfigError> {
        let mut lift_offs = 0;
        let mut count = |happening: touchdown_core::model::Happening<R>| {
            lift_offs += u32::from(happening.change == Change::LiftsOff);
        };
        let model = &subject.model;
        let mut state = model.start(&subject.start, subject.spin, &mut count)?;
        let (mut turns, mut touch) = (0.0, Touch::None);
        let steps = (self.0.run.duration / self.0.model.step) as u32;
        for _ in 0..steps {
            model.step(&mut state, &mut count);
            let now = model.kinematics(&state);
            turns = now.turns.0 as f64 + now.turns.1.to_f64() / TAU;
            touch = now.touch;
            if turns.abs() >= 1.0 {
                break;
            }
        }
        Ok(end(turns, lift_offs, touch != Touch::None))
    }
}

/// The same of the reference.
fn of_reference(scene: &Scene) -> End {
    let mut reference = Reference::new(&scene.machine(), &scene.start, scene.rotor.spin);
    let mut lift_offs = 0;
    let mut turns = 0.0_f64;
    let steps = (scene.run.duration / scene.model.step) as u32;
    for step in 1..=steps {
        let time = f64::from(step) * scene.model.step;
        turns = reference
            .advance(time, &mut |happening| {
                lift_offs += u32::from(matches!(happening, Happening::LiftOff(_)));
            })
            .turns_in_contact;
        if turns.abs() >= 1.0 {
            break;
        }
    }
    let phase = reference.phase();
    let in_contact = matches!(phase, PhaseKind::Sliding | PhaseKind::Rolling);
    end(turns, lift_offs, in_contact)
}
