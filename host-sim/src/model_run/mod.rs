//! The model under test over a scene.

mod once;
mod simulate;
pub mod support;
pub mod two_plane;

use once::Once;
pub use simulate::{ModelRun, RingEnd, run, simulate, steps_of_run};

use touchdown_core::error::ConfigError;
use touchdown_core::model::{
    Compliance, Euler, Hertz, HertzConfig, Line, Moreau, Point, Precision, Rigid, RigidConfig,
    Scheme as ContactScheme, Shape, Start as ScaledStart, Stepper, Verlet,
};
use touchdown_core::real::{Micro32, Poly32, Poly64};
use touchdown_core::scales::Scales;

use crate::elastic::Validity;
use crate::reference::Start;
use crate::scene::{self, Contact, Math, Rung, Scene, Scheme};

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

/// What is done with numbers of a kind.
trait InNumbers {
    type Output;

    fn with<R: Precision>(self) -> Result<Self::Output, ConfigError>;
}

/// Calls `what` with the scene's kind of numbers.
fn in_numbers<T: InNumbers>(scene: &Scene, what: T) -> Result<T::Output, ConfigError> {
    match (scene.model.precision, scene.model.math) {
        (scene::Precision::F64, Math::Libm) => what.with::<f64>(),
        (scene::Precision::F32, Math::Libm) => what.with::<f32>(),
        (scene::Precision::F64, Math::Polynomial) => what.with::<Poly64>(),
        (scene::Precision::F32, Math::Polynomial) => what.with::<Poly32>(),
        (scene::Precision::F32, Math::Micromath) => what.with::<Micro32>(),
        (scene::Precision::F64, Math::Micromath) => Err(ConfigError::OutOfRange(
            "math",
            "\"libm\" or \"polynomial\" in f64",
        )),
    }
}

/// Builds the scene's rung in the scene's numbers, for `what`.
pub fn with_model<U: Use>(scene: &Scene, what: U) -> Result<U::Output, ConfigError> {
    in_numbers(scene, InRung { scene, what })
}

struct InRung<'a, U> {
    scene: &'a Scene,
    what: U,
}

impl<U: Use> InNumbers for InRung<'_, U> {
    type Output = U::Output;

    fn with<R: Precision>(self) -> Result<U::Output, ConfigError> {
        in_rung::<R, U>(self.scene, self.what)
    }
}

fn in_rung<R: Precision, U: Use>(scene: &Scene, what: U) -> Result<U::Output, ConfigError> {
    match scene.model.rung {
        Rung::Rigid => {
            let model = Rigid::try_new(&config(scene))?.with_cutoff(scene.model.cutoff);
            what.with(&subject(scene, model.rounded::<R>(), *model.scales()))
        }
        Rung::Moreau => {
            let model = Moreau::try_new(&config(scene))?;
            what.with(&subject(scene, Once(model.rounded::<R>()), *model.scales()))
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
        Rung::Support => support::with_parts::<R, U>(scene, what),
        Rung::TwoPlane => two_plane::with_rings::<R, U>(scene, what),
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
    what.with(&subject(
        scene,
        Once(model.rounded::<R, D>()),
        *model.scales(),
    ))
}

/// How stiff the scene's contact is.
pub fn compliance(scene: &Scene) -> Result<Compliance<f64>, ConfigError> {
    match scene.materials.contact {
        Contact::Point => compliant(scene, Point).compliance(),
        Contact::Line { length } => compliant(scene, Line { length }).compliance(),
    }
}

/// How far the rotor is rigid in its contacts, in the ring where it is least; none where the scene does not
/// give its first elastic mode.
pub fn validity(scene: &Scene) -> Option<Validity> {
    let machine = scene.two_plane.as_ref()?;
    let mode = machine.elastic_mode?;
    let gyration = (machine.transverse_inertia / scene.rotor.mass).sqrt();
    let rings = machine.rings.iter().map(|ring| ring.place / gyration);
    let all = rings.filter_map(|zeta| match scene.materials.contact {
        Contact::Point => Validity::try_new(&compliant(scene, Point), zeta, mode).ok(),
        Contact::Line { length } => {
            Validity::try_new(&compliant(scene, Line { length }), zeta, mode).ok()
        }
    });
    all.max_by(|a, b| a.ratio.total_cmp(&b.ratio))
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
