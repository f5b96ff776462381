//! The drop of the built-in scene `rig`, step by step, each followed by output of the rotor's place.

use core::hint::black_box;

use touchdown_rotor::scales::Scales;
use touchdown_rotor::{Precision, RigidConfig, Solved, Start, Stepper, Touch};

use super::CountingRun;
use touchdown_counter::Tally;

/// Duration of the drop, us.
pub(super) const WHOLE: u32 = 300_000;
/// The fall, its impacts, and as much in contact, us. In software f64 two ends take 4.6e9 instructions for it.
pub(super) const BEGIN: u32 = 100_000;
/// Steps, us.
pub(super) const STEPS: [u32; 2] = [10, 1_000];
/// 30 000 rpm, clockwise, rad/s.
const SPIN: f64 = -1_000.0 * core::f64::consts::PI;
/// Start, m.
pub(super) const POSITION: [f64; 2] = [20e-6, 0.0];

/// What a step did: all of it in flight or in contact, or one flight, one stretch of contact or several motions were solved.
#[derive(Clone, Copy)]
enum Class {
    Flight,
    Contact,
    Impact,
    Stretch,
    Several,
}

const NAMES: [&str; 5] = ["flight", "contact", "impact", "stretch", "several"];

/// Steps of a class, and the motions solved in them.
#[derive(Clone, Copy, Default)]
struct Counts {
    steps: Tally,
    flights: u32,
    stretches: u32,
}

pub(super) fn config(step: u32) -> RigidConfig<f64> {
    RigidConfig {
        mass: 3.42,
        radius: 24e-3,
        polar_inertia: 0.5 * 3.42 * 24e-3 * 24e-3,
        clearance: 0.3e-3,
        friction: 0.1,
        restitution: 0.8,
        gravity: 9.81,
        speed: 1.0,
        step: 1e-6 * f64::from(step),
    }
}

impl CountingRun {
    /// Counts the drop by a model, whose rung and scheme are its `name`, in steps of so many us for `duration` us.
    pub(super) fn drop<R: Precision, M: Stepper<R>>(
        &mut self,
        model: &M,
        scales: &Scales<f64>,
        name: &str,
        step: u32,
        duration: u32,
    ) {
        let start = Start::Free {
            position: POSITION.map(|x| x / scales.length),
            velocity: [0.0; 2],
        };
        let mut state = model
            .start(&start.rounded(), R::lit(SPIN / scales.spin), |_| ())
            .expect("a valid start");
        let mut classes = [Counts::default(); NAMES.len()];
        let mut before = model.solved(&state);
        for _ in 0..duration / step {
            let (_, instructions) = self.counter.count(|| {
                let state = black_box(&mut state);
                model.step(state, |happening| {
                    black_box(happening);
                });
                model.kinematics(state).position
            });
            let after = model.solved(&state);
            let solved = Solved {
                flights: after.flights.wrapping_sub(before.flights),
                stretches: after.stretches.wrapping_sub(before.stretches),
            };
            let class = class(solved, model.kinematics(&state).touch);
            let counts = &mut classes[class as usize];
            counts.steps.add(instructions);
            counts.flights += solved.flights;
            counts.stretches += solved.stretches;
            before = after;
        }
        let number = self.number;
        for (class, counts) in NAMES.iter().zip(classes) {
            let Tally { calls, sum, worst } = counts.steps;
            let (flights, stretches) = (counts.flights, counts.stretches);
            self.table.line(format_args!(
                "drop,{name},{number},{step},{class},{calls},{flights},{stretches},{sum},{worst}"
            ));
        }
    }
}

fn class(solved: Solved, touch: Touch) -> Class {
    match (solved.flights, solved.stretches) {
        (0, 0) if touch == Touch::None => Class::Flight,
        (0, 0) => Class::Contact,
        (1, 0) => Class::Impact,
        (0, 1) => Class::Stretch,
        _ => Class::Several,
    }
}
