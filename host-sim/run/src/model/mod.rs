//! The model under test over a scene.

mod boxed;
pub mod coupled;
mod machine;
mod parts;
mod plane;
mod seen;
mod simulate;

use boxed::Boxed;
pub use plane::follow;
pub use seen::{ModelRun, RaceEnd, RingEnd, steps_of_run};
pub use simulate::{run, simulate, simulate_to_verdict};

use touchdown_models::{Hertz, Moreau, Scheme};
use touchdown_rotor::error::ConfigError;
use touchdown_rotor::real::{Micro32, Poly32};
use touchdown_rotor::scales::Scales;
use touchdown_rotor::{Precision, Rigid, Start as ScaledStart, Stepper};

use touchdown_base::machine::Start;
use touchdown_scene::scales::{compliant, config};
use touchdown_scene::{Fidelity, Math, Scene};

/// What is done with a model, whatever its rung and numbers.
pub trait Use {
    /// What comes of it.
    type Output;

    /// Uses `subject`.
    fn with<R: Precision, M: Stepper<R> + Clone + 'static>(
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
    /// Size of its state, bytes.
    pub state_size: usize,
}

/// Numbers in which this crate builds the models. Else each crate that uses a model would build it again.
trait Numbers: Precision {
    /// The model of a rung that goes by steps.
    fn by_steps(scene: &Scene) -> Result<Subject<Self, Boxed<Self>>, ConfigError>;
}

macro_rules! numbers {
    ($($number:ty: $build:ident),+) => {
        $(impl Numbers for $number {
            fn by_steps(scene: &Scene) -> Result<Subject<Self, Boxed<Self>>, ConfigError> {
                $build(scene)
            }
        })+
    };
}

numbers!(f64: in_rung, f32: in_rung, Poly32: in_rung, Micro32: in_plane);

/// What is done with numbers of a kind.
trait InNumbers {
    type Output;

    fn with<R: Numbers>(self) -> Result<Self::Output, ConfigError>;
}

/// Calls `what` with the scene's kind of numbers.
fn in_numbers<T: InNumbers>(scene: &Scene, what: T) -> Result<T::Output, ConfigError> {
    match (scene.model.math, scene.model.precision) {
        (Math::Micromath, touchdown_scene::Precision::F32) => what.with::<Micro32>(),
        _ => in_numbers_of_rings(scene, what),
    }
}

/// Likewise, of those in which there are rings that give way or turn, and rotors that tilt.
fn in_numbers_of_rings<T: InNumbers>(scene: &Scene, what: T) -> Result<T::Output, ConfigError> {
    match (scene.model.math, scene.model.precision) {
        (Math::Libm, touchdown_scene::Precision::F64) => what.with::<f64>(),
        (Math::Libm, touchdown_scene::Precision::F32) => what.with::<f32>(),
        (Math::Polynomial, touchdown_scene::Precision::F32) => what.with::<Poly32>(),
        _ => Err(ConfigError::OutOfRange("math", "one that the rung has")),
    }
}

/// Builds the scene's rung in the scene's numbers, for `what`.
pub fn with_model<U: Use>(scene: &Scene, what: U) -> Result<U::Output, ConfigError> {
    in_numbers(scene, InRung(scene, what))
}

struct InRung<'a, U>(&'a Scene, U);

impl<U: Use> InNumbers for InRung<'_, U> {
    type Output = U::Output;

    fn with<R: Numbers>(self) -> Result<U::Output, ConfigError> {
        let Self(scene, what) = self;
        match scene.model.rung {
            Fidelity::Rigid => {
                let model = Rigid::try_new(&config(scene))?.with_cutoff(scene.model.cutoff);
                what.with(&subject(scene, model.rounded::<R>(), *model.scales()))
            }
            _ => what.with(&R::by_steps(scene)?),
        }
    }
}

fn in_rung<R: Precision>(scene: &Scene) -> Result<Subject<R, Boxed<R>>, ConfigError> {
    match scene.model.rung {
        Fidelity::Support | Fidelity::TwoPlane | Fidelity::Coupled => coupled::subject(scene),
        _ => in_plane(scene),
    }
}

fn in_plane<R: Precision>(scene: &Scene) -> Result<Subject<R, Boxed<R>>, ConfigError> {
    match scene.model.rung {
        Fidelity::Moreau => {
            let model = Moreau::try_new(&config(scene))?;
            Ok(boxed(scene, model.rounded::<R>(), *model.scales()))
        }
        Fidelity::Hertz => {
            let scheme = match scene.model.scheme {
                touchdown_scene::Scheme::Verlet => Scheme::Verlet,
                _ => Scheme::Euler,
            };
            let model = Hertz::try_new(&compliant(scene), scheme)?;
            Ok(boxed(scene, model.rounded::<R>(), *model.scales()))
        }
        _ => Err(ConfigError::OutOfRange("math", "one that the rung has")),
    }
}

fn subject<R: Precision, M: Stepper<R>>(
    scene: &Scene,
    model: M,
    scales: Scales<f64>,
) -> Subject<R, M> {
    Subject {
        model,
        start: scaled(&scene.start, &scales).rounded(),
        spin: R::lit(scene.rotor.spin / scales.spin),
        scales,
        state_size: size_of::<M::State>(),
    }
}

fn boxed<R: Precision, M: Stepper<R> + 'static>(
    scene: &Scene,
    model: M,
    scales: Scales<f64>,
) -> Subject<R, Boxed<R>> {
    Subject {
        state_size: size_of::<M::State>(),
        ..subject(scene, Boxed::new(model), scales)
    }
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
