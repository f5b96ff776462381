//! Rungs `support`, `two-plane` and `coupled`: from the scene's parts to a model.

use touchdown_models::{
    ActuatorConfig, Coupled, CoupledConfig, CoupledState, ModeConfig, Placement, Whole,
};
use touchdown_rotor::error::ConfigError;
use touchdown_rotor::real::Poly32;
use touchdown_rotor::scales::Scales;
use touchdown_rotor::{Precision, Start};

use super::boxed::Boxed;
pub use super::machine::StepView;
use super::machine::{MachineDrop, OnStep};
use super::parts::{ends, modelled_magnets, modelled_modes, seats, shape};
use super::seen::{FollowedDrop, ModelRun};
use super::{Subject, scaled};
use touchdown_scene::{Fidelity, MODES, Removable, Scene, scales};

/// Coordinates of a rotor that only moves, that tilts too, and that bends too. Modes that a scene does not have
/// stand still, because each number more is built for every number of rings and kind of numbers.
const MOVES: usize = 1;
const TILTS: usize = 2;
const BENDS: usize = 2 + MODES;

/// The model of a scene, whatever its rings and coordinates.
trait AnyWhole<R> {
    fn subject(self: Box<Self>, scene: &Scene) -> Subject<R, Boxed<R>>;

    fn follow<'a>(
        self: Box<Self>,
        scene: &'a Scene,
        on_step: Option<OnStep<'a>>,
    ) -> Result<Box<dyn FollowedDrop + 'a>, ConfigError>;
}

/// With its units.
impl<R: Precision, const N: usize, const Q: usize> AnyWhole<R> for (Whole<R, N, Q>, Scales<f64>) {
    fn subject(self: Box<Self>, scene: &Scene) -> Subject<R, Boxed<R>> {
        let (whole, scales) = *self;
        Subject {
            start: Start::Free {
                position: whole.start.position,
                velocity: whole.start.velocity,
            },
            spin: R::lit(scene.rotor.spin / scales.spin),
            scales,
            state_size: size_of::<CoupledState<R, N, Q>>(),
            model: Boxed::new(whole),
        }
    }

    fn follow<'a>(
        self: Box<Self>,
        scene: &'a Scene,
        on_step: Option<OnStep<'a>>,
    ) -> Result<Box<dyn FollowedDrop + 'a>, ConfigError> {
        let (whole, scales) = *self;
        Ok(Box::new(MachineDrop::new(scene, on_step, whole, scales)?))
    }
}

/// The model with the scene's parts.
pub(super) fn subject<R: Precision>(scene: &Scene) -> Result<Subject<R, Boxed<R>>, ConfigError> {
    Ok(in_parts::<R>(scene)?.subject(scene))
}

fn in_parts<R: Precision>(scene: &Scene) -> Result<Box<dyn AnyWhole<R>>, ConfigError> {
    let bends = modelled_modes(scene).next().is_some();
    match (scene.model.rung, bends, seats(scene).len()) {
        (Fidelity::Support, ..) => built::<R, 1, MOVES>(scene),
        (_, false, 1) => built::<R, 1, TILTS>(scene),
        (_, false, 2) => built::<R, 2, TILTS>(scene),
        (_, false, 3) => built::<R, 3, TILTS>(scene),
        (_, false, _) => built::<R, 4, TILTS>(scene),
        (_, true, 1) => built::<R, 1, BENDS>(scene),
        (_, true, 2) => built::<R, 2, BENDS>(scene),
        (_, true, 3) => built::<R, 3, BENDS>(scene),
        (_, true, _) => built::<R, 4, BENDS>(scene),
    }
}

fn built<R: Precision, const N: usize, const Q: usize>(
    scene: &Scene,
) -> Result<Box<dyn AnyWhole<R>>, ConfigError> {
    let config = config::<N>(scene)?;
    let exact = Coupled::<f64, N, Q>::try_new(&config)?;
    let whole = Whole {
        start: placement(scene, &exact).rounded::<R>(),
        model: Coupled::<R, N, Q>::try_new(&config)?,
    };
    Ok(Box::new((whole, *exact.scales())))
}

fn config<const N: usize>(scene: &Scene) -> Result<CoupledConfig<N>, ConfigError> {
    let rings = seats(scene).try_into();
    let mut config = CoupledConfig {
        rings: rings.map_err(|_| ConfigError::OutOfRange("rings", "1 to 4"))?,
        ..CoupledConfig::of_plane(&scales::config(scene), [0.0; N])
    };
    let Some(machine) = ends(scene) else {
        return Ok(config);
    };
    config.transverse_inertia = machine.transverse_inertia;
    let (sin, cos) = machine.gravity_angle.sin_cos();
    config.gravity = [scene.run.gravity * sin, -scene.run.gravity * cos];
    if scene.model.has(Removable::Unbalance) {
        config.unbalance = machine.unbalance;
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
    in_numbers!(scene, [Libm F64: f64, Libm F32: f32, Polynomial F32: Poly32], R => {
        in_parts::<R>(scene)?.follow(scene, on_step)
    })
}
