//! Rung `support`: as a model among others, and with what its ring does.

use touchdown_models::{
    BallBearing, Bushing, Fixed, Ledger as Energy, Mount, MountConfig, Race, RaceConfig, Rounded,
    Sprung, Support, SupportConfig,
};
use touchdown_rotor::error::ConfigError;
use touchdown_rotor::{ModelEvent, Precision, Stepper};

use super::once::{Once, pointer};
use super::seen::{ModelRun, RingEnd, STILL, Seen, steps_of_run};
use super::{InNumbers, Subject, Use, config, in_numbers, subject};
use touchdown_base::history::Recorder;
use touchdown_base::ledger::{Ledger, entries};
use touchdown_base::rings::Histories;
use touchdown_scene::Scene;

/// What is done with the model, whatever its parts.
trait UseSupport {
    type Output;

    fn with<R: Precision, M: Mount<R>, B: Race<R>>(
        self,
        subject: Subject<R, Support<R, M, B>>,
    ) -> Result<Self::Output, ConfigError>;
}

struct AsModel<U>(U);

impl<U: Use> UseSupport for AsModel<U> {
    type Output = U::Output;

    fn with<R: Precision, M: Mount<R>, B: Race<R>>(
        self,
        subject: Subject<R, Support<R, M, B>>,
    ) -> Result<U::Output, ConfigError> {
        self.0.with(&Subject {
            model: Once(subject.model),
            start: subject.start,
            spin: subject.spin,
            scales: subject.scales,
        })
    }
}

/// Builds the model with the scene's parts for `what`.
pub(super) fn with_parts<R: Precision, U: Use>(
    scene: &Scene,
    what: U,
) -> Result<U::Output, ConfigError> {
    parts::<R, _>(scene, AsModel(what))
}

fn parts<R: Precision, V: UseSupport>(scene: &Scene, what: V) -> Result<V::Output, ConfigError> {
    match (&scene.support, &scene.ball_bearing) {
        (Some(support), None) => {
            built::<R, Sprung<f64>, Bushing, V>(scene, mount(support), Bushing, what)
        }
        (None, Some(bearing)) => {
            built::<R, Fixed, BallBearing<f64>, V>(scene, Fixed, race(bearing), what)
        }
        (Some(support), Some(bearing)) => {
            built::<R, Sprung<f64>, BallBearing<f64>, V>(scene, mount(support), race(bearing), what)
        }
        (None, None) => Err(ConfigError::OutOfRange(
            "rung",
            "one that the scene has parts for",
        )),
    }
}

fn built<R, M, B, V>(
    scene: &Scene,
    mount: M::Config,
    race: B::Config,
    what: V,
) -> Result<V::Output, ConfigError>
where
    R: Precision,
    M: Mount<f64> + Rounded<To<R>: Mount<R>>,
    B: Race<f64> + Rounded<To<R>: Race<R>>,
    V: UseSupport,
{
    let model = Support::<f64, M, B>::try_new(&SupportConfig {
        rigid: config(scene),
        mount,
        race,
    })?;
    what.with(subject(scene, model.rounded::<R>(), *model.scales()))
}

fn mount(support: &touchdown_scene::Support) -> MountConfig<f64> {
    MountConfig {
        mass: support.mass,
        stiffness: support.stiffness,
        damping: support.damping,
        travel: support.travel,
    }
}

fn race(bearing: &touchdown_scene::BallBearing) -> RaceConfig<f64> {
    RaceConfig {
        inertia: bearing.inertia,
        dry_drag: bearing.dry_drag,
        viscous_drag: bearing.viscous_drag,
        cage_ratio: bearing.cage_ratio,
        heat_capacity: bearing.heat_capacity,
        heat_loss: bearing.heat_loss,
    }
}

/// Rotor and ring after a step.
#[derive(Clone, Copy, Debug)]
pub struct StepView {
    /// Of the rotor beyond the ring's wall, its clearance; below 0 in flight.
    pub beyond: f64,
    /// Of the ring beyond its hard stop, the clearance; below 0 before it, or without.
    pub stop: f64,
    /// What energy there is and was, in m V^2.
    pub energy: Energy<f64>,
    /// The sum of it all as the model's numbers give it, in m V^2.
    pub total: f64,
}

/// Runs the scene's model with account of its energy, watched after each step.
pub fn watch(scene: &Scene, each: &mut dyn FnMut(StepView)) -> Result<ModelRun, ConfigError> {
    in_numbers(scene, Run(scene, each))
}

struct Run<'a>(&'a Scene, &'a mut dyn FnMut(StepView));

impl InNumbers for Run<'_> {
    type Output = ModelRun;

    fn with<R: Precision>(self) -> Result<ModelRun, ConfigError> {
        parts::<R, _>(self.0, self)
    }
}

impl UseSupport for Run<'_> {
    type Output = ModelRun;

    fn with<R: Precision, M: Mount<R>, B: Race<R>>(
        self,
        subject: Subject<R, Support<R, M, B>>,
    ) -> Result<ModelRun, ConfigError> {
        let Self(scene, each) = self;
        let Subject {
            model,
            start,
            spin,
            scales,
        } = subject;
        let seen = Seen {
            scales,
            step: scene.model.step,
            mass: scene.rotor.mass,
        };
        let travel = scene.support.and_then(|support| support.travel);
        let travel = travel.map_or(f64::INFINITY, |travel| travel / scales.length);
        let mut recorder = Recorder::new(-scene.first_sample_time());
        let mut take = |happening: ModelEvent<R>| recorder.take(seen.happening(&happening));
        let on_event = pointer(&mut take);
        let mut state = model.start(&start, spin, &mut *on_event)?;
        let begun = model.ledger(&state).stored().to_f64();
        let (steps, fraction) = steps_of_run(scene.run.duration / scene.model.step);
        for _ in 0..steps {
            model.step(&mut state, &mut *on_event);
            let size = |[x, y]: [R; 2]| x.to_f64().hypot(y.to_f64());
            let ledger = model.ledger(&state);
            each(StepView {
                beyond: size(state.displacement()) - 1.0,
                stop: size(model.ring(&state).position) - travel,
                energy: ledger.to_f64(),
                total: ledger.total().to_f64(),
            });
        }
        if fraction > 0.0 {
            model.part_step(&mut state, R::lit(fraction), on_event);
        }
        let end = Seen::state(&model.kinematics(&state), scene.run.duration, &scales);
        let unit = scene.rotor.mass * scales.speed * scales.speed;
        let ring = model.ring(&state);
        let race = ring.race.map(|race| {
            let [spin, cage] = [race.spin, race.cage].map(|spin| spin.to_f64() * scales.spin);
            [spin, cage, race.temperature.to_f64()]
        });
        Ok(ModelRun {
            histories: Histories {
                whole: recorder.finish(end, STILL * scales.speed),
                rings: Vec::new(),
            },
            ledger: Some(ledger(unit, unit * begun, &model.ledger(&state).to_f64())),
            ring: Some(RingEnd {
                position: ring.position.map(|x| x.to_f64() * scales.length),
                velocity: ring.velocity.map(|v| v.to_f64() * scales.speed),
                held_peak: state.load().held_peak.to_f64() * unit / scales.length,
                race,
            }),
        })
    }
}

/// In units of `unit`, J.
fn ledger(unit: f64, start_j: f64, end: &Energy<f64>) -> Ledger {
    Ledger {
        start_j,
        stored: entries(
            unit,
            [
                ("motion", end.motion),
                ("spin", end.spin),
                ("height", end.height),
                ("ring", end.ring),
                ("spring", end.spring),
                ("inner ring", end.race),
            ],
        ),
        gone: entries(
            unit,
            [
                ("friction heat", end.heat),
                ("impacts", end.lost),
                ("damper", end.damped),
                ("hard stop", end.stop),
                ("drag", end.drag),
            ],
        ),
    }
}
