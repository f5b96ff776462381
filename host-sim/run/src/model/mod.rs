//! The model under test over a scene.

pub mod coupled;
mod follow;
mod machine;
mod once;
mod parts;
mod plane;
mod seen;
mod simulate;

pub use follow::FollowedDrop;
use once::Once;
pub use plane::follow;
pub use seen::{ModelRun, RaceEnd, RingEnd, steps_of_run};
pub use simulate::{run, simulate, simulate_to_verdict};

use touchdown_models::{
    Euler, Hertz, Line, LinePower, Moreau, Point, Scheme as ContactScheme, Shape, Verlet,
};
use touchdown_rotor::error::ConfigError;
use touchdown_rotor::real::{Micro32, Poly32, Poly64};
use touchdown_rotor::scales::Scales;
use touchdown_rotor::{Precision, Rigid, Start as ScaledStart, Stepper};

use touchdown_base::machine::Start;
use touchdown_scene::scales::{compliant, config};
use touchdown_scene::{Contact, Fidelity, Math, Scene, Scheme};

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
}

/// What is done with numbers of a kind.
trait InNumbers {
    type Output;

    fn with<R: Precision>(self) -> Result<Self::Output, ConfigError>;
}

/// Calls `what` with the scene's kind of numbers.
fn in_numbers<T: InNumbers>(scene: &Scene, what: T) -> Result<T::Output, ConfigError> {
    match (scene.model.precision, scene.model.math) {
        (touchdown_scene::Precision::F64, Math::Libm) => what.with::<f64>(),
        (touchdown_scene::Precision::F32, Math::Libm) => what.with::<f32>(),
        (touchdown_scene::Precision::F64, Math::Polynomial) => what.with::<Poly64>(),
        (touchdown_scene::Precision::F32, Math::Polynomial) => what.with::<Poly32>(),
        (touchdown_scene::Precision::F32, Math::Micromath) => what.with::<Micro32>(),
        (touchdown_scene::Precision::F64, Math::Micromath) => Err(ConfigError::OutOfRange(
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
        Fidelity::Rigid => {
            let model = Rigid::try_new(&config(scene))?.with_cutoff(scene.model.cutoff);
            what.with(&subject(scene, model.rounded::<R>(), *model.scales()))
        }
        Fidelity::Moreau => {
            let model = Moreau::try_new(&config(scene))?;
            what.with(&subject(scene, Once(model.rounded::<R>()), *model.scales()))
        }
        Fidelity::Hertz => match (scene.materials.contact, scene.model.scheme) {
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
            (Contact::LinePower { length }, Scheme::Verlet) => {
                hertz::<R, LinePower<f64>, LinePower<R>, Verlet, U>(
                    scene,
                    LinePower { length },
                    what,
                )
            }
            (Contact::LinePower { length }, _) => {
                hertz::<R, LinePower<f64>, LinePower<R>, Euler, U>(
                    scene,
                    LinePower { length },
                    what,
                )
            }
        },
        Fidelity::Support | Fidelity::TwoPlane | Fidelity::Coupled => {
            coupled::with_parts::<R, U>(scene, what)
        }
    }
}

/// `D` is the shape `C` in the numbers `R`.
fn hertz<R, C, D, S, U>(scene: &Scene, shape: C, what: U) -> Result<U::Output, ConfigError>
where
    R: Precision,
    C: Shape<f64>,
    D: Shape<R> + 'static,
    S: ContactScheme + 'static,
    U: Use,
{
    let model = Hertz::<f64, C, S>::try_new(&compliant(scene, shape))?;
    what.with(&subject(
        scene,
        Once(model.rounded::<R, D>()),
        *model.scales(),
    ))
}

fn subject<R: Precision, M>(scene: &Scene, model: M, scales: Scales<f64>) -> Subject<R, M> {
    Subject {
        model,
        start: scaled(&scene.start, &scales).rounded(),
        spin: R::lit(scene.rotor.spin / scales.spin),
        scales,
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
