//! The drop of the built-in scene `rig`, step by step, each followed by output of the rotor's place.

use core::hint::black_box;

use touchdown_core::model::{
    BallBearing, Ends, Euler, Hertz, HertzConfig, Materials, Moreau, MountConfig, Placement, Point,
    Precision, RaceConfig, Rigid, RigidConfig, RingConfig, Scheme, Solved, Sprung, Start, Stepper,
    Support, SupportConfig, Touch, TwoPlane, TwoPlaneConfig, UnbalanceConfig, Verlet,
};
use touchdown_core::real::{Micro32, Poly32, Poly64};

use super::{Counter, Name, Table, Tally};

/// Duration of the drop, us.
const DURATION: u32 = 300_000;
/// Steps, us.
const STEPS: [u32; 2] = [10, 1_000];
/// Steps of rung `hertz`, which refuses longer ones, us.
const SHORT_STEPS: [u32; 2] = [10, 100];
/// 30 000 rpm, clockwise, rad/s.
const SPIN: f64 = -1_000.0 * core::f64::consts::PI;
/// Start, m.
const POSITION: [f64; 2] = [20e-6, 0.0];

/// Speed after a fall through the gap, m/s.
const FASTEST: f64 = 0.0767;

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

pub(super) fn count(counter: &Counter, table: &mut Table) {
    let name = |precision, math| Name { precision, math };
    of_number::<f32>(counter, table, name("f32", "libm"));
    of_number::<Poly32>(counter, table, name("f32", "polynomial"));
    of_number::<Micro32>(counter, table, name("f32", "micromath"));
    of_number::<f64>(counter, table, name("f64", "libm"));
    of_number::<Poly64>(counter, table, name("f64", "polynomial"));
}

/// Every rung in one kind of number.
fn of_number<R: Precision>(counter: &Counter, table: &mut Table, name: Name) {
    for step in STEPS {
        let run = Run {
            counter,
            name,
            step,
        };
        let rigid = Rigid::try_new(&config(step)).expect("a valid configuration");
        let scales = *rigid.scales();
        run.of_model::<R, _>(&rigid.rounded(), scales.length, scales.spin)
            .write(table, "rigid", "launch", &run);
        let moreau = Moreau::try_new(&config(step)).expect("a valid configuration");
        run.of_model::<R, _>(&moreau.rounded(), scales.length, scales.spin)
            .write(table, "moreau", "midpoint", &run);
        run.of_model::<R, _>(&support(step).rounded(), scales.length, scales.spin)
            .write(table, "support", "midpoint", &run);
        let ends = ends::<R>(step);
        run.of_model::<R, _>(&ends, scales.length, scales.spin)
            .write(table, "two-plane", "midpoint", &run);
    }
    for step in SHORT_STEPS {
        let run = Run {
            counter,
            name,
            step,
        };
        run.of_hertz::<R, Euler>(table, "euler");
        run.of_hertz::<R, Verlet>(table, "verlet");
    }
}

fn config(step: u32) -> RigidConfig<f64> {
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

/// All parts of the rung: the scenes `soft-support` and `ball-bearing` in one.
fn support(step: u32) -> Support<f64, Sprung<f64>, BallBearing<f64>> {
    Support::try_new(&SupportConfig {
        rigid: config(step),
        mount: MountConfig {
            mass: 0.5,
            stiffness: 2.6e6,
            damping: 320.0,
            travel: Some(0.5e-3),
        },
        race: RaceConfig {
            inertia: 3e-5,
            dry_drag: 0.005,
            viscous_drag: 1e-5,
            cage_ratio: 0.44,
            heat_capacity: 50.0,
            heat_loss: 0.5,
        },
    })
    .expect("a valid configuration")
}

/// The scene `two-plane` without its third ring.
fn ends<R: Precision>(step: u32) -> Ends<R, 2> {
    let plane = config(step);
    let ring = |place| RingConfig {
        place,
        clearance: plane.clearance,
        radius: plane.radius,
        friction: plane.friction,
        restitution: plane.restitution,
    };
    let model = TwoPlane::try_new(&TwoPlaneConfig {
        mass: plane.mass,
        polar_inertia: plane.polar_inertia,
        transverse_inertia: 0.03078,
        rings: [ring(-0.12), ring(0.12)],
        gravity: [0.0, -plane.gravity],
        speed: plane.speed,
        unbalance: UnbalanceConfig {
            eccentricity: 1.1e-6 / plane.mass,
            ..UnbalanceConfig::default()
        },
        magnets: Default::default(),
        step: plane.step,
    })
    .expect("a valid configuration");
    let start = Placement {
        tilt: [0.0, 0.6e-3 / model.tilt_scale()],
        ..Placement::default()
    };
    Ends::new(model.rounded(), start.rounded())
}

#[derive(Clone, Copy)]
struct Run<'a> {
    counter: &'a Counter,
    name: Name,
    /// us.
    step: u32,
}

/// Steps and solved motions by class.
#[derive(Default)]
struct Counts {
    steps: [Tally; 5],
    flights: [u32; 5],
    stretches: [u32; 5],
}

impl Run<'_> {
    /// Steel on steel.
    fn of_hertz<R: Precision, S: Scheme>(&self, table: &mut Table, scheme: &str) {
        let config = HertzConfig {
            rigid: config(self.step),
            materials: Materials::steel(),
            shape: Point,
            fastest: FASTEST,
        };
        let model = Hertz::<f64, Point, S>::try_new(&config).expect("a valid configuration");
        let scales = *model.scales();
        self.of_model::<R, _>(&model.rounded::<R, Point>(), scales.length, scales.spin)
            .write(table, "hertz", scheme, self);
    }

    fn of_model<R: Precision, M: Stepper<R>>(&self, model: &M, length: f64, spin: f64) -> Counts {
        let start = Start::Free {
            position: POSITION.map(|x| x / length),
            velocity: [0.0; 2],
        };
        let mut state = model
            .start(&start.rounded(), R::lit(SPIN / spin), |_| ())
            .expect("a valid start");
        let mut counts = Counts::default();
        let mut before = model.solved(&state);
        for _ in 0..DURATION / self.step {
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

    fn write(&self, table: &mut Table, rung: &str, scheme: &str, run: &Run) {
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
