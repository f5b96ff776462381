//! The model under test over a scene.

use touchdown_core::error::ConfigError;
use touchdown_core::model::{
    Change, Compliance, Euler, Hertz, HertzConfig, Instant, Kinematics, Line, Moreau, Point,
    Precision, Rigid, RigidConfig, Scheme as ContactScheme, Shape, Start as ScaledStart, Stepper,
    Touch, Verlet,
};
use touchdown_core::real::{Micro32, Poly32, Poly64};
use touchdown_core::scales::Scales;

use crate::history::{Happening, History, Impact, Pulse, Recorder, RotorState};
use crate::reference::Start;
use crate::scene::{self, Contact, Math, Rung, Scene, Scheme};

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
        Rung::Hertz => match (scene.materials.contact, scene.model.scheme) {
            (Contact::Point, Scheme::Verlet) => {
                hertz::<R, Point, Point, Verlet, U>(scene, Point, what)
            }
            (Contact::Point, _) => hertz::<R, Point, Point, Euler, U>(scene, Point, what),
            (Contact::Line { length }, Scheme::Verlet) => {
                hertz::<R, Line<f64>, Line<R>, Verlet, U>(scene, Line { length }, what)
            }
            (Contact::Line { length }, _) => {
                hertz::<R, Line<f64>, Line<R>, Euler, U>(scene, Line { length }, what)
            }
        },
        Rung::Support | Rung::TwoPlane => todo!(),
    }
}

/// `D` is the shape `C` in the numbers `R`.
fn hertz<R, C, D, S, U>(scene: &Scene, shape: C, what: U) -> Result<U::Output, ConfigError>
where
    R: Precision,
    C: Shape<f64>,
    D: Shape<R>,
    S: ContactScheme,
    U: Use,
{
    let model = Hertz::<f64, C, S>::try_new(&compliant(scene, shape))?;
    what.with(&subject(scene, model.rounded::<R, D>(), *model.scales()))
}

/// How stiff the scene's contact is.
pub fn compliance(scene: &Scene) -> Result<Compliance<f64>, ConfigError> {
    match scene.materials.contact {
        Contact::Point => compliant(scene, Point).compliance(),
        Contact::Line { length } => compliant(scene, Line { length }).compliance(),
    }
}

fn compliant<C>(scene: &Scene, shape: C) -> HertzConfig<f64, C> {
    HertzConfig {
        rigid: config(scene),
        materials: scene.materials.elastic,
        shape,
        fastest: fastest_impact(scene),
    }
}

/// A fall to the bottom from the start's height, or through the gap if that is more, and the start's
/// speed.
pub(crate) fn fastest_impact(scene: &Scene) -> f64 {
    let height = match scene.start {
        Start::Free { position, .. } => position[1],
        Start::Wall { angle, .. } => -scene.retainer.clearance * angle.cos(),
    };
    let fall = scene.retainer.clearance + height.max(0.0);
    let speed = speed_of(&scene.start).hypot((2.0 * scene.run.gravity * fall).sqrt());
    if speed > 0.0 {
        speed
    } else {
        start_speed(scene)
    }
}

fn speed_of(start: &Start) -> f64 {
    match *start {
        Start::Free { velocity, .. } => velocity[0].hypot(velocity[1]),
        Start::Wall { tangential, .. } => tangential.abs(),
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
    let speed = speed_of(&scene.start);
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
                        pulse: None,
                    })
                }
                Change::Released(pulse) => Happening::Released {
                    state: after,
                    pulse: Pulse {
                        peak_force: pulse.peak_force.to_f64() * mass * scales.speed / scales.time,
                        duration: pulse.duration.to_f64() * scales.time,
                        impulse: pulse.impulse.to_f64() * mass * scales.speed,
                    },
                },
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
