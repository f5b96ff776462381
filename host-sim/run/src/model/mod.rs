//! The model under test over a scene.

/// `$what` in the scene's kind of numbers, `$R`, where that is one of those listed.
macro_rules! in_numbers {
    ($scene:expr, [$($math:ident $precision:ident: $number:ty),+], $R:ident => $what:expr) => {
        match ($scene.model.math, $scene.model.precision) {
            $((touchdown_scene::Math::$math, touchdown_scene::Precision::$precision) => {
                type $R = $number;
                $what
            })+
            _ => Err(ConfigError::OutOfRange("math", "one that the rung has")),
        }
    };
}

mod boxed;
pub mod coupled;
mod machine;
mod parts;
mod plane;
mod seen;

use boxed::Boxed;
pub use plane::{follow, run, simulate, simulate_to_verdict};
pub use seen::{ModelRun, RaceEnd, RingEnd, steps_of_run};

use touchdown_models::{Hertz, Moreau, Scheme};
use touchdown_rotor::error::ConfigError;
use touchdown_rotor::real::{Micro32, Poly32};
use touchdown_rotor::scales::Scales;
use touchdown_rotor::{Precision, Rigid, Start as ScaledStart, Stepper};

use touchdown_base::machine::Start;
use touchdown_scene::scales::{compliant, config};
use touchdown_scene::{Fidelity, Scene};

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

/// Builds the scene's rung in the scene's numbers, for `what`.
pub fn with_model<U: Use>(scene: &Scene, what: U) -> Result<U::Output, ConfigError> {
    in_numbers!(scene, [Libm F64: f64, Libm F32: f32, Polynomial F32: Poly32, Micromath F32: Micro32], R => {
        match scene.model.rung {
            Fidelity::Rigid => {
                let model = Rigid::try_new(&config(scene))?.with_cutoff(scene.model.cutoff);
                what.with(&subject(scene, model.rounded::<R>())?)
            }
            _ => what.with(&R::by_steps(scene)?),
        }
    })
}

fn in_rung<R: Precision>(scene: &Scene) -> Result<Subject<R, Boxed<R>>, ConfigError> {
    match scene.model.rung {
        Fidelity::Support | Fidelity::TwoPlane | Fidelity::Coupled => coupled::subject(scene),
        _ => in_plane(scene),
    }
}

fn in_plane<R: Precision>(scene: &Scene) -> Result<Subject<R, Boxed<R>>, ConfigError> {
    match scene.model.rung {
        Fidelity::Moreau => boxed(scene, Moreau::<R>::try_new(&config(scene))?),
        Fidelity::Hertz => {
            let scheme = match scene.model.scheme {
                touchdown_scene::Scheme::Verlet => Scheme::Verlet,
                _ => Scheme::Euler,
            };
            boxed(scene, Hertz::<R>::try_new(&compliant(scene), scheme)?)
        }
        _ => Err(ConfigError::OutOfRange("math", "one that the rung has")),
    }
}

fn subject<R: Precision, M: Stepper<R>>(
    scene: &Scene,
    model: M,
) -> Result<Subject<R, M>, ConfigError> {
    let (_, scales) = config(scene).scaled()?;
    Ok(Subject {
        model,
        start: scaled(&scene.start, &scales).rounded(),
        spin: R::lit(scene.rotor.spin / scales.spin),
        scales,
        state_size: size_of::<M::State>(),
    })
}

fn boxed<R: Precision, M: Stepper<R> + 'static>(
    scene: &Scene,
    model: M,
) -> Result<Subject<R, Boxed<R>>, ConfigError> {
    Ok(Subject {
        state_size: size_of::<M::State>(),
        ..subject(scene, Boxed::new(model))?
    })
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
