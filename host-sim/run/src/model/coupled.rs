//! Rungs `support`, `two-plane` and `coupled`: from the scene's parts to a model.

use touchdown_models::{
    ActuatorConfig, Coupled, CoupledConfig, CoupledState, ModeConfig, Placement, UnbalanceConfig,
    Whole,
};
use touchdown_rotor::error::ConfigError;
use touchdown_rotor::scales::Scales;
use touchdown_rotor::{Precision, Start};

use super::boxed::Boxed;
pub use super::machine::StepView;
use super::machine::{MachineDrop, OnStep};
use super::parts::{ends, modelled_magnets, modelled_modes, seats, shape};
use super::seen::{FollowedDrop, ModelRun};
use super::{InNumbers, Numbers, Subject, in_numbers_of_rings, scaled};
use touchdown_scene::scales::config as plane;
use touchdown_scene::{Fidelity, MODES, Removable, Scene};

/// Coordinates of a rotor that only moves, that tilts too, and that bends too. Modes that a scene does not have
/// stand still, because each number more is built for every number of rings and kind of numbers.
const MOVES: usize = 1;
const TILTS: usize = 2;
const BENDS: usize = 2 + MODES;

/// What is done with the model, whatever its rings and coordinates.
trait UseWhole {
    type Output<R: Precision>;

    fn with<R: Precision, const N: usize, const Q: usize>(
        self,
        whole: Whole<R, N, Q>,
        scales: Scales<f64>,
    ) -> Result<Self::Output<R>, ConfigError>;
}

struct AsSubject<'a>(&'a Scene);

impl UseWhole for AsSubject<'_> {
    type Output<R: Precision> = Subject<R, Boxed<R>>;

    fn with<R: Precision, const N: usize, const Q: usize>(
        self,
        whole: Whole<R, N, Q>,
        scales: Scales<f64>,
    ) -> Result<Subject<R, Boxed<R>>, ConfigError> {
        Ok(Subject {
            start: Start::Free {
                position: whole.start.position,
                velocity: whole.start.velocity,
            },
            spin: R::lit(self.0.rotor.spin / scales.spin),
            scales,
            state_size: size_of::<CoupledState<R, N, Q>>(),
            model: Boxed::new(whole),
        })
    }
}

/// The model with the scene's parts.
pub(super) fn subject<R: Precision>(scene: &Scene) -> Result<Subject<R, Boxed<R>>, ConfigError> {
    in_parts::<R, _>(scene, AsSubject(scene))
}

fn in_parts<R: Precision, V: UseWhole>(
    scene: &Scene,
    what: V,
) -> Result<V::Output<R>, ConfigError> {
    let rings = seats(scene).len();
    let bends = modelled_modes(scene).next().is_some();
    match (scene.model.rung, bends) {
        (Fidelity::Support, _) => built::<R, V, 1, MOVES>(scene, what),
        (_, false) => match rings {
            1 => built::<R, V, 1, TILTS>(scene, what),
            2 => built::<R, V, 2, TILTS>(scene, what),
            3 => built::<R, V, 3, TILTS>(scene, what),
            _ => built::<R, V, 4, TILTS>(scene, what),
        },
        (_, true) => match rings {
            1 => built::<R, V, 1, BENDS>(scene, what),
            2 => built::<R, V, 2, BENDS>(scene, what),
            3 => built::<R, V, 3, BENDS>(scene, what),
            _ => built::<R, V, 4, BENDS>(scene, what),
        },
    }
}

fn built<R: Precision, V: UseWhole, const N: usize, const Q: usize>(
    scene: &Scene,
    what: V,
) -> Result<V::Output<R>, ConfigError> {
    let config = config::<N>(scene)?;
    let exact = Coupled::<f64, N, Q>::try_new(&config)?;
    let whole = Whole {
        start: placement(scene, &exact).rounded::<R>(),
        model: Coupled::<R, N, Q>::try_new(&config)?,
    };
    what.with(whole, *exact.scales())
}

fn config<const N: usize>(scene: &Scene) -> Result<CoupledConfig<N>, ConfigError> {
    let rings = seats(scene).try_into();
    let mut config = CoupledConfig {
        rings: rings.map_err(|_| ConfigError::OutOfRange("rings", "1 to 4"))?,
        ..CoupledConfig::of_plane(&plane(scene), [0.0; N])
    };
    let Some(machine) = ends(scene) else {
        return Ok(config);
    };
    config.transverse_inertia = machine.transverse_inertia;
    let (sin, cos) = machine.gravity_angle.sin_cos();
    config.gravity = [scene.run.gravity * sin, -scene.run.gravity * cos];
    if scene.model.has(Removable::Unbalance) {
        config.unbalance = UnbalanceConfig {
            eccentricity: machine.unbalance[0] / scene.rotor.mass,
            angle: machine.unbalance[1],
            skew: machine.skew[0],
            skew_angle: machine.skew[1],
        };
    }
    let damps = f64::from(u8::from(scene.model.rung == Fidelity::Coupled));
    for (to, from) in config.magnets.iter_mut().zip(modelled_magnets(scene)) {
        *to = ActuatorConfig {
            place: from.place,
            stiffness: from.stiffness,
            damping: damps * from.damping,
            force: from.force,
            limit: from.limit,
            on: from.on,
            shape: shape(scene, from.place),
        };
    }
    if scene.model.rung == Fidelity::Coupled && scene.model.has(Removable::Base) {
        config.base = machine.base;
    }
    for (to, mode) in config.modes.iter_mut().zip(modelled_modes(scene)) {
        *to = Some(ModeConfig {
            speed: mode.speed,
            damping_ratio: mode.damping_ratio,
            mass: mode.mass,
            centre: mode.at(0.0),
        });
    }
    Ok(config)
}

fn placement<const N: usize, const Q: usize>(
    scene: &Scene,
    model: &Coupled<f64, N, Q>,
) -> Placement<f64> {
    let scales = model.scales();
    let (position, velocity) = match scaled(&scene.start, scales) {
        Start::Free { position, velocity } => (position, velocity),
        Start::Wall {
            sin,
            cos,
            tangential,
        } => ([sin, -cos], [tangential * cos, tangential * sin]),
    };
    let rate = scales.time / model.tilt_scale();
    Placement {
        position,
        velocity,
        tilt: ends(scene).map_or([0.0; 2], |it| it.tilt.map(|a| a / model.tilt_scale())),
        tilt_rate: ends(scene).map_or([0.0; 2], |it| it.tilt_rate.map(|a| a * rate)),
    }
}

/// Runs the scene's model, watched after each step.
pub fn watch(scene: &Scene, each: &mut dyn FnMut(StepView)) -> Result<ModelRun, ConfigError> {
    Ok(follow(scene, Some(each))?.finish())
}

/// The scene's machine at its release.
pub(super) fn follow<'a>(
    scene: &'a Scene,
    on_step: Option<OnStep<'a>>,
) -> Result<Box<dyn FollowedDrop + 'a>, ConfigError> {
    in_numbers_of_rings(scene, MachineRelease(scene, on_step))
}

struct MachineRelease<'a>(&'a Scene, Option<OnStep<'a>>);

impl<'a> InNumbers for MachineRelease<'a> {
    type Output = Box<dyn FollowedDrop + 'a>;

    fn with<R: Numbers>(self) -> Result<Self::Output, ConfigError> {
        in_parts::<R, _>(self.0, self)
    }
}

impl<'a> UseWhole for MachineRelease<'a> {
    type Output<R: Precision> = Box<dyn FollowedDrop + 'a>;

    fn with<R: Precision, const N: usize, const Q: usize>(
        self,
        whole: Whole<R, N, Q>,
        scales: Scales<f64>,
    ) -> Result<Box<dyn FollowedDrop + 'a>, ConfigError> {
        let Self(scene, on_step) = self;
        Ok(Box::new(MachineDrop::new(scene, on_step, whole, scales)?))
    }
}
