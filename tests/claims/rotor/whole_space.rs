//! The model over every scene that is valid, out to the ends of all ranges at once: it stays finite
//! and in the gap, gains no energy, and takes a bounded number of changes a step.

use proptest::prelude::*;
use proptest::sample::select;
use std::ops::RangeInclusive;
use touchdown_base::machine::{Machine, Start};
use touchdown_rotor::error::ConfigError;
use touchdown_rotor::{Change, Kinematics, Precision as Number, Stepper};
use touchdown_run::model::{Subject, Use, with_model};
use touchdown_scene::{Precision, Scene, limits};

/// Steps of each scene.
const STEPS: u32 = 60;
/// Most happenings a step: of each impact itself and the contact that may follow, and of each stretch
/// of contact its end.
const MOST_HAPPENINGS: u32 = 2 * 768 + 256;
/// Farthest outside the gap, in units of rho0 and epsilon.
const MOST_OUTSIDE: f64 = 16.0;
/// Most energy gained by each happening of a step, and one more, in parts of all energy and in units of
/// epsilon.
const MOST_GAINED: f64 = 32.0;
/// The same by all stretches of contact of a step: a digit each.
const STRETCHES: f64 = 256.0;

/// Logarithmic between the ends of a range above zero.
fn scale(range: RangeInclusive<f64>) -> impl Strategy<Value = f64> {
    let (low, high) = range.into_inner();
    let ends = select(vec![low, high]);
    prop_oneof![1 => ends, 4 => (low.ln()..high.ln()).prop_map(move |x| x.exp().clamp(low, high))]
}

/// Either sign, logarithmic over twelve decades below the end of a range; or 0.
fn signed(range: RangeInclusive<f64>) -> impl Strategy<Value = f64> {
    let high = *range.end();
    (
        scale(1e-12 * high..=high),
        select(vec![-1.0, 0.0, 1.0, 1.0, -1.0]),
    )
        .prop_map(|(x, s)| x * s)
}

fn starts(clearance: f64) -> impl Strategy<Value = Start> {
    let speed = || signed(limits::SPEED_MM_S).prop_map(|v| 1e-3 * v);
    let distance = prop_oneof![
        Just(0.0),
        Just(1.0),
        0.0..1.0_f64,
        (-30.0..0.0_f64).prop_map(f64::exp)
    ];
    let free = (distance, 0.0..std::f64::consts::TAU, speed(), speed()).prop_map(
        move |(part, angle, u, v)| Start::Free {
            position: [
                part * clearance * angle.sin(),
                -part * clearance * angle.cos(),
            ],
            velocity: [u, v],
        },
    );
    let angle = prop_oneof![
        Just(0.0),
        Just(std::f64::consts::PI),
        Just(std::f64::consts::FRAC_PI_2),
        -600.0..600.0_f64
    ];
    let wall = (angle, speed()).prop_map(|(angle, tangential)| Start::Wall { angle, tangential });
    prop_oneof![free, wall]
}

/// What of a scene matters to a model.
#[derive(Clone, Debug)]
struct Valid {
    machine: Machine,
    /// rad/s.
    spin: f64,
    start: Start,
    /// s.
    step: f64,
}

impl Valid {
    fn scene(&self, precision: Precision) -> Scene {
        let mut scene = Scene::load("rig").expect("built-in scene");
        let machine = &self.machine;
        scene.rotor.mass = machine.mass;
        scene.rotor.radius = machine.radius;
        scene.rotor.polar_inertia = machine.polar_inertia;
        scene.retainer.clearance = machine.clearance;
        scene.retainer.friction = machine.friction;
        scene.retainer.restitution = machine.restitution;
        scene.run.gravity = machine.gravity;
        scene.rotor.spin = self.spin;
        scene.start = self.start;
        scene.model.step = self.step;
        scene.model.precision = precision;
        scene
    }
}

prop_compose! {
    fn machines()(mass in scale(limits::MASS_KG), radius in scale(limits::RADIUS_MM),
                  inertia in scale(limits::INERTIA_RATIO), clearance in scale(limits::CLEARANCE_MM),
                  friction in prop_oneof![Just(0.0), Just(100.0), scale(1e-6..=100.0), 0.0..1.0_f64],
                  restitution in prop_oneof![Just(0.0), Just(1.0), Just(0.99), 0.0..1.0_f64,
                                             scale(1e-9..=1.0).prop_map(|lost| 1.0 - lost)],
                  gravity in prop_oneof![1 => Just(0.0), 1 => Just(9.81),
                                         3 => scale(limits::LEAST_GRAVITY_M_S2..=1e3)]) -> Machine {
        let radius = 1e-3 * radius;
        Machine {
            mass,
            radius,
            polar_inertia: 0.5 * inertia * mass * radius * radius,
            clearance: 1e-3 * clearance,
            friction,
            restitution,
            gravity,
        }
    }
}

fn drops() -> impl Strategy<Value = Valid> {
    let turning = (signed(limits::SPEED_RPM), scale(limits::STEP_US));
    (machines(), turning)
        .prop_flat_map(|(machine, turning)| (starts(machine.clearance), Just((machine, turning))))
        .prop_map(|(start, (machine, (speed, step)))| Valid {
            machine,
            spin: speed * std::f64::consts::TAU / 60.0,
            start,
            step: 1e-6 * step,
        })
}

struct Check<'a> {
    scene: &'a Scene,
    /// Distance from 1 to the next larger number.
    epsilon: f64,
}

impl Use for Check<'_> {
    type Output = Result<(), TestCaseError>;

    fn with<R: Number, M: Stepper<R>>(
        self,
        subject: &Subject<R, M>,
    ) -> Result<Self::Output, ConfigError> {
        let mut happenings = 0_u32;
        let mut sane = true;
        let Subject {
            model, start, spin, ..
        } = subject;
        let mut state = model.start(start, *spin, |_| happenings += 1)?;
        let mut last = self.energy(&model.kinematics(&state));
        for step in 0..STEPS {
            let before = happenings;
            model.step(&mut state, |happening| {
                happenings += 1;
                sane &= is_finite(&happening.after);
                if let Change::Impact { speed: normal, .. } = happening.change {
                    sane &= normal > R::ZERO && normal.is_finite();
                }
            });
            let after = model.kinematics(&state);
            let now = self.energy(&after);
            let check = self.step(step, &after, sane, happenings - before, [last, now]);
            if check.is_err() {
                return Ok(check);
            }
            last = now;
        }
        Ok(Ok(()))
    }
}

impl Check<'_> {
    /// Translation, spin and height, per mass, in the model's units; and the sum of their sizes.
    fn energy<R: Number>(&self, k: &Kinematics<R>) -> [f64; 2] {
        let rotor = &self.scene.rotor;
        let beta = rotor.polar_inertia / (rotor.mass * rotor.radius.powi(2));
        let [u, v] = k.velocity.map(R::to_f64);
        let spin = k.spin.to_f64();
        let height = if self.scene.run.gravity > 0.0 {
            k.position[1].to_f64()
        } else {
            0.0
        };
        let moving = 0.5 * (u * u + v * v) + 0.5 * beta * spin * spin;
        [moving + height, moving + 1.0]
    }

    fn step<R: Number>(
        &self,
        step: u32,
        k: &Kinematics<R>,
        sane: bool,
        happenings: u32,
        [[last, _], [now, size]]: [[f64; 2]; 2],
    ) -> Result<(), TestCaseError> {
        prop_assert!(sane && is_finite(k), "step {step}: not finite: {k:?}");
        let [x, y] = k.position.map(R::to_f64);
        let outside = x.hypot(y) - 1.0;
        prop_assert!(
            outside <= MOST_OUTSIDE * self.epsilon,
            "step {step}: {outside:e} outside: {k:?}"
        );
        let gain = (now - last) / size;
        let limit = self.epsilon * (MOST_GAINED * f64::from(1 + happenings) + STRETCHES);
        prop_assert!(
            gain <= limit,
            "step {step}: energy gained: {gain:e} of {size:e}, {k:?}"
        );
        prop_assert!(
            happenings <= MOST_HAPPENINGS,
            "step {step}: {happenings} happenings"
        );
        Ok(())
    }
}

fn is_finite<R: Number>(k: &Kinematics<R>) -> bool {
    let all = k
        .position
        .iter()
        .chain(&k.velocity)
        .chain([&k.spin, &k.turns.1]);
    all.copied().all(R::is_finite)
}

fn check(drop: &Valid, precision: Precision) -> Result<(), TestCaseError> {
    let scene = drop.scene(precision);
    let check = Check {
        scene: &scene,
        epsilon: match precision {
            Precision::F32 => f32::EPSILON.into(),
            Precision::F64 => f64::EPSILON,
        },
    };
    with_model(&scene, check).unwrap_or_else(|error| Err(TestCaseError::fail(error.to_string())))
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 3_000, failure_persistence: None,
                                        max_shrink_iters: 8000,
                                        rng_seed: prop::test_runner::RngSeed::Fixed(1),
                                        ..ProptestConfig::default() })]

    #[test]
    fn in_f64(drop in drops()) {
        check(&drop, Precision::F64)?;
    }

    #[test]
    fn in_f32(drop in drops()) {
        check(&drop, Precision::F32)?;
    }
}
