//! The drop of the built-in scene `rig`, step by step, each followed by output of the rotor's place.

use core::hint::black_box;

use touchdown_rotor::{Precision, RigidConfig, Solved, Start, Stepper, Touch};

use touchdown_counter::{Counter, Name, Table, Tally};

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

/// What a step did.
#[derive(Clone, Copy)]
enum Class {
    /// In flight from its start to its end.
    Flight,
    /// In contact, likewise.
    Contact,
    /// One flight was solved.
    Impact,
    /// One stretch of contact was solved.
    Stretch,
    /// More than one motion was solved.
    Several,
}

const NAMES: [&str; 5] = ["flight", "contact", "impact", "stretch", "several"];

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

#[derive(Clone, Copy)]
pub(super) struct Run<'a> {
    pub(super) counter: &'a Counter,
    pub(super) name: Name,
    /// us.
    pub(super) step: u32,
    /// us.
    pub(super) duration: u32,
}

/// Steps and solved motions by class.
#[derive(Default)]
pub(super) struct Counts {
    steps: [Tally; 5],
    flights: [u32; 5],
    stretches: [u32; 5],
}

impl Run<'_> {
    /// Rungs with rings of their own have a start of their own: of these scales only the spin's counts.
    pub(super) fn of_model<R: Precision, M: Stepper<R>>(&self, model: &M) -> Counts {
        let (_, scales) = config(self.step).scaled().expect("a valid configuration");
        let start = Start::Free {
            position: POSITION.map(|x| x / scales.length),
            velocity: [0.0; 2],
        };
        let mut state = model
            .start(&start.rounded(), R::lit(SPIN / scales.spin), |_| ())
            .expect("a valid start");
        let mut counts = Counts::default();
        let mut before = model.solved(&state);
        for _ in 0..self.duration / self.step {
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
            let touch = model.kinematics(&state).touch;
            counts.add(class(solved, touch), instructions, solved);
            before = after;
        }
        counts
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

impl Counts {
    fn add(&mut self, class: Class, instructions: u32, solved: Solved) {
        let index = class as usize;
        self.steps[index].add(instructions);
        self.flights[index] += solved.flights;
        self.stretches[index] += solved.stretches;
    }

    pub(super) fn write(&self, table: &mut Table, rung: &str, scheme: &str, run: &Run) {
        let Run {
            name: Name { precision, math },
            step,
            ..
        } = run;
        for (index, class) in NAMES.iter().enumerate() {
            let Tally { calls, sum, worst } = self.steps[index];
            let (flights, stretches) = (self.flights[index], self.stretches[index]);
            table.line(format_args!(
                "drop,{rung},{scheme},{precision},{math},{step},{class},{calls},{flights},\
                 {stretches},{sum},{worst}"
            ));
        }
    }
}
