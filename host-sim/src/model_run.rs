//! The model under test over a scene.

use touchdown_core::error::ConfigError;
use touchdown_core::model::{
    Change, Instant, Kinematics, Moreau, Precision, Rigid, RigidConfig, Start as ScaledStart,
    Stepper, Touch,
};
use touchdown_core::real::{Micro32, Poly32, Poly64};
use touchdown_core::scales::Scales;

use crate::history::{Happening, History, Impact, Recorder, RotorState};
use crate::reference::Start;
use crate::scene::{self, Math, Rung, Scene};

/// Part of the speed scale below which a rotor in contact is at rest.
const STILL: f64 = 1e-6;

/// What is done with a model, whatever its rung and numbers.
pub trait Use {
    /// What comes of it.
    type Output;

    /// Uses `subject`.
    fn with<R: Precision, M: Stepper<R>>(
        self,
        subject: &Subject<R, M>,
    ) -> Result<Self::Output, ConfigError>;
}

/// A model and where it starts.
pub struct Subject<R, M> {
    /// The model.
    pub model: M,
    /// Its start.
    pub start: ScaledStart<R>,
    /// Its spin, as surface speed.
    pub spin: R,
    /// Its units.
    pub scales: Scales<f64>,
}

/// Builds the scene's rung in the scene's numbers, for `what`.
pub fn with_model<U: Use>(scene: &Scene, what: U) -> Result<U::Output, ConfigError> {
    match (scene.model.precision, scene.model.math) {
        (scene::Precision::F64, Math::Libm) => in_numbers::<f64, U>(scene, what),
        (scene::Precision::F32, Math::Libm) => in_numbers::<f32, U>(scene, what),
        (scene::Precision::F64, Math::Polynomial) => in_numbers::<Poly64, U>(scene, what),
        (scene::Precision::F32, Math::Polynomial) => in_numbers::<Poly32, U>(scene, what),
        (scene::Precision::F32, Math::Micromath) => in_numbers::<Micro32, U>(scene, what),
        (scene::Precision::F64, Math::Micromath) => Err(ConfigError::OutOfRange(
            "math",
            "\"libm\" or \"polynomial\" in f64",
        )),
    }
}

fn in_numbers<R: Precision, U: Use>(scene: &Scene, what: U) -> Result<U::Output, ConfigError> {
    match scene.model.rung {
        Rung::Rigid => {
            let model = Rigid::try_new(&config(scene))?;
            what.with(&subject(scene, model.rounded::<R>(), *model.scales()))
        }
        Rung::Moreau => {
            let model = Moreau::try_new(&config(scene))?;
            what.with(&subject(scene, model.rounded::<R>(), *model.scales()))
        }
        Rung::Hertz => Err(ConfigError::OutOfRange("rung", "\"rigid\"")),
    }
}

fn subject<R: Precision, M>(scene: &Scene, model: M, scales: Scales<f64>) -> Subject<R, M> {
    Subject {
        model,
        start: scaled(&scene.start, &scales).rounded(),
        spin: R::lit(scene.rotor.spin / scales.spin),
        scales,
    }
}

fn config(scene: &Scene) -> RigidConfig<f64> {
    RigidConfig {
        mass: scene.rotor.mass,
        radius: scene.rotor.radius,
        polar_inertia: scene.rotor.polar_inertia,
        clearance: scene.retainer.clearance,
        friction: scene.retainer.friction,
        restitution: scene.retainer.restitution,
        gravity: scene.run.gravity,
        speed: start_speed(scene),
        step: scene.model.step,
    }
}

/// Runs the scene's model from the release to the end.
pub fn simulate(scene: &Scene) -> Result<History, ConfigError> {
    with_model(scene, Simulate(scene))
}

/// Sets the scale where there is no gravity.
pub(crate) fn start_speed(scene: &Scene) -> f64 {
    let speed = match scene.start {
        Start::Free { velocity, .. } => velocity[0].hypot(velocity[1]),
        Start::Wall { tangential, .. } => tangential.abs(),
    };
    if speed > 0.0 { speed } else { 1.0 }
}

fn scaled(start: &Start, scales: &Scales<f64>) -> ScaledStart<f64> {
    match *start {
        Start::Free { position, velocity } => ScaledStart::Free {
            position: position.map(|x| x / scales.length),
            velocity: velocity.map(|v| v / scales.speed),
        },
        Start::Wall { angle, tangential } => {
            let (sin, cos) = angle.sin_cos();
            ScaledStart::Wall {
                sin,
                cos,
                tangential: tangential / scales.speed,
            }
        }
    }
}

struct Simulate<'a>(&'a Scene);

impl Use for Simulate<'_> {
    type Output = History;

    fn with<R: Precision, M: Stepper<R>>(
        self,
        subject: &Subject<R, M>,
    ) -> Result<History, ConfigError> {
        let scene = self.0;
        let Subject {
            model,
            start,
            spin,
            scales,
        } = subject;
        let step = scene.model.step;
        let mut recorder = Recorder::new(-scene.first_sample_time());
        let mass = scene.rotor.mass;
        let mut take = |happening: touchdown_core::model::Happening<R>| {
            let time = seconds(happening.at, step);
            let after = to_si(&happening.after, time, scales);
            recorder.take(match happening.change {
                Change::Impact(normal) => {
                    let normal_speed = normal.to_f64() * scales.speed;
                    Happening::Impact(Impact {
                        state: after,
                        normal_speed,
                        normal_impulse: mass * (1.0 + scene.retainer.restitution) * normal_speed,
                    })
                }
                Change::ContactStarts => Happening::ContactStart {
                    time,
                    rolling: happening.after.touch == Touch::Rolling,
                },
                Change::RollingStarts => Happening::RollingStart(time),
                Change::SlidingStarts => Happening::SlidingStart(time),
                Change::LiftsOff => Happening::LiftOff(time),
            });
        };
        let mut state = model.start(start, *spin, &mut take)?;
        let (steps, fraction) = steps_of_run(scene.run.duration / step);
        model.run(&mut state, steps, R::lit(fraction), &mut take);
        let last = to_si(&model.kinematics(&state), scene.run.duration, scales);
        Ok(recorder.finish(last, STILL * scales.speed))
    }
}

/// Whole steps, and the part of one that is left. A duration that is a whole number of steps but for
/// rounding ends on the last of them.
pub(crate) fn steps_of_run(steps: f64) -> (u64, f64) {
    let nearest = steps.round();
    if (steps - nearest).abs() <= 1e-9 * nearest {
        return (nearest as u64, 0.0);
    }
    (steps.floor() as u64, steps.fract())
}

fn seconds<R: Precision>(at: Instant<R>, step: f64) -> f64 {
    (at.tick as f64 + at.fraction.to_f64()) * step
}

fn to_si<R: Precision>(k: &Kinematics<R>, time: f64, scales: &Scales<f64>) -> RotorState {
    RotorState {
        time,
        position: k.position.map(|x| x.to_f64() * scales.length),
        velocity: k.velocity.map(|v| v.to_f64() * scales.speed),
        spin: k.spin.to_f64() * scales.spin,
        turns_in_contact: k.turns.0 as f64 + k.turns.1.to_f64() / std::f64::consts::TAU,
    }
}
