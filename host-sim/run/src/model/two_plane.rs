//! Rung `two-plane`: as a model among others, and with what happens in each ring.

use touchdown_models::{
    Ends, Energy, MagnetConfig, Placement, RingConfig, TwoPlane, TwoPlaneConfig, TwoPlaneState,
    UnbalanceConfig,
};
use touchdown_rotor::error::ConfigError;
use touchdown_rotor::scales::Scales;
use touchdown_rotor::{ModelEvent, Precision, Start, Stepper};

use super::once::Once;
use super::seen::{ModelRun, STILL, Seen, steps_of_run};
use super::{InNumbers, Subject, Use, in_numbers};
use touchdown_base::history::{Recorder, RotorState};
use touchdown_base::ledger::{Ledger, entries};
use touchdown_base::rings::{Histories, Merge};
use touchdown_scene::Scene;
use touchdown_scene::scales::start_speed;

/// Builds the model with the scene's rings for `what`.
pub(super) fn with_rings<R: Precision, U: Use>(
    scene: &Scene,
    what: U,
) -> Result<U::Output, ConfigError> {
    match machine(scene)?.rings.len() {
        1 => with::<R, U, 1>(scene, what),
        2 => with::<R, U, 2>(scene, what),
        3 => with::<R, U, 3>(scene, what),
        _ => with::<R, U, 4>(scene, what),
    }
}

fn with<R: Precision, U: Use, const N: usize>(
    scene: &Scene,
    what: U,
) -> Result<U::Output, ConfigError> {
    let model = TwoPlane::try_new(&config::<N>(scene)?)?;
    let scales = *model.scales();
    what.with(&Subject {
        start: Start::Free {
            position: [R::ZERO; 2],
            velocity: [R::ZERO; 2],
        },
        spin: R::lit(scene.rotor.spin / scales.spin),
        scales,
        model: Once(Ends::new(
            model.rounded::<R>(),
            placement(scene, &model)?.rounded::<R>(),
        )),
    })
}

fn machine(scene: &Scene) -> Result<&touchdown_scene::TwoPlane, ConfigError> {
    let rule = ConfigError::OutOfRange("rings", "1 to 4");
    scene.two_plane.as_ref().ok_or(rule)
}

fn config<const N: usize>(scene: &Scene) -> Result<TwoPlaneConfig<f64, N>, ConfigError> {
    let machine = machine(scene)?;
    let ring = |ring: &touchdown_scene::Ring| RingConfig {
        place: ring.place,
        clearance: ring.retainer.clearance,
        radius: ring.radius,
        friction: ring.retainer.friction,
        restitution: ring.retainer.restitution,
    };
    let rings: Vec<_> = machine.rings.iter().map(ring).collect();
    let mut magnets = [MagnetConfig::default(); 2];
    for (to, from) in magnets.iter_mut().zip(&machine.magnets) {
        *to = MagnetConfig {
            place: from.place,
            stiffness: from.stiffness,
            force: from.force,
        };
    }
    let (sin, cos) = machine.gravity_angle.sin_cos();
    Ok(TwoPlaneConfig {
        mass: scene.rotor.mass,
        polar_inertia: scene.rotor.polar_inertia,
        transverse_inertia: machine.transverse_inertia,
        rings: rings
            .try_into()
            .map_err(|_| ConfigError::OutOfRange("rings", "1 to 4"))?,
        gravity: [scene.run.gravity * sin, -scene.run.gravity * cos],
        speed: start_speed(scene),
        unbalance: UnbalanceConfig {
            eccentricity: machine.unbalance[0] / scene.rotor.mass,
            angle: machine.unbalance[1],
            skew: machine.skew[0],
            skew_angle: machine.skew[1],
        },
        magnets,
        step: scene.model.step,
    })
}

fn placement<const N: usize>(
    scene: &Scene,
    model: &TwoPlane<f64, N>,
) -> Result<Placement<f64>, ConfigError> {
    let machine = machine(scene)?;
    let scales = model.scales();
    let touchdown_scene::Start::Free { position, velocity } = scene.start else {
        return Err(ConfigError::OutOfRange("start", "free"));
    };
    Ok(Placement {
        position: position.map(|x| x / scales.length),
        velocity: velocity.map(|v| v / scales.speed),
        tilt: machine.tilt.map(|a| a / model.tilt_scale()),
        tilt_rate: machine
            .tilt_rate
            .map(|a| a * scales.time / model.tilt_scale()),
    })
}

/// The rotor after a step.
#[derive(Clone, Copy, Debug)]
pub struct StepView {
    /// Farthest beyond the wall of any ring, its clearance; below 0 in flight.
    pub beyond: f64,
    /// What energy there is and was, in m V^2.
    pub energy: Energy<f64>,
    /// The sum of it all as the model's numbers give it, in m V^2.
    pub total: f64,
}

/// Runs the scene's model with what happens in each ring, watched after each step.
pub fn watch(scene: &Scene, each: &mut dyn FnMut(StepView)) -> Result<ModelRun, ConfigError> {
    in_numbers(scene, Run(scene, each))
}

struct Run<'a>(&'a Scene, &'a mut dyn FnMut(StepView));

impl InNumbers for Run<'_> {
    type Output = ModelRun;

    fn with<R: Precision>(self) -> Result<ModelRun, ConfigError> {
        match machine(self.0)?.rings.len() {
            1 => in_rings::<R, 1>(self.0, self.1),
            2 => in_rings::<R, 2>(self.0, self.1),
            3 => in_rings::<R, 3>(self.0, self.1),
            _ => in_rings::<R, 4>(self.0, self.1),
        }
    }
}

fn in_rings<R: Precision, const N: usize>(
    scene: &Scene,
    each: &mut dyn FnMut(StepView),
) -> Result<ModelRun, ConfigError> {
    let exact = TwoPlane::try_new(&config::<N>(scene)?)?;
    let scales = *exact.scales();
    let (model, start) = (
        exact.rounded::<R>(),
        placement(scene, &exact)?.rounded::<R>(),
    );
    let machine = machine(scene)?;
    let recorder = Recorder::new(-scene.first_sample_time());
    let (mut whole, mut rings, mut merge) = (recorder.clone(), vec![recorder; N], Merge::new(N));
    // Spin is told as surface speed in the ring.
    let at_ring = |ring: usize| Scales {
        spin: scales.speed / machine.rings[ring].radius,
        ..scales
    };
    let mut take = |ring: usize, happening: ModelEvent<R>| {
        let seen = Seen {
            scales: at_ring(ring),
            step: scene.model.step,
            mass: scene.rotor.mass,
        };
        let happening = seen.happening(&happening);
        rings[ring].take(happening);
        if let Some(happening) = merge.take(ring, happening) {
            whole.take(happening);
        }
    };
    let mut state = model.start(&start, R::lit(scene.rotor.spin / scales.spin), &mut take)?;
    let begun = model.energy(&state).to_f64();
    let (steps, fraction) = steps_of_run(scene.run.duration / scene.model.step);
    for _ in 0..steps {
        model.step(&mut state, &mut take);
        each(forecast_input(&model, &state, machine, scales.length));
    }
    if fraction > 0.0 {
        model.part_step(&mut state, R::lit(fraction), &mut take);
    }
    let ends: Vec<RotorState> = (0..N)
        .map(|ring| {
            let kinematics = model.kinematics_at(&state, ring);
            Seen::state(&kinematics, scene.run.duration, &at_ring(ring))
        })
        .collect();
    let end = {
        let whole = Ends::new(model, start);
        Seen::state(&whole.kinematics(&state), scene.run.duration, &scales)
    };
    let still = STILL * scales.speed;
    let unit = scene.rotor.mass * scales.speed * scales.speed;
    Ok(ModelRun {
        ring: None,
        ledger: Some(ledger(unit, &begun, &model.energy(&state).to_f64())),
        histories: Histories {
            whole: whole.finish(end, still),
            rings: rings
                .into_iter()
                .zip(ends)
                .map(|(ring, end)| ring.finish(end, still))
                .collect(),
        },
    })
}

fn forecast_input<R: Precision, const N: usize>(
    model: &TwoPlane<R, N>,
    state: &TwoPlaneState<R, N>,
    machine: &touchdown_scene::TwoPlane,
    length: f64,
) -> StepView {
    let reach = |(index, ring): (usize, &touchdown_scene::Ring)| {
        let [x, y] = model.kinematics_at(state, index).position.map(R::to_f64);
        x.hypot(y) * length / ring.retainer.clearance - 1.0
    };
    let energy = model.energy(state);
    StepView {
        beyond: machine
            .rings
            .iter()
            .enumerate()
            .map(reach)
            .fold(-1.0, worse),
        energy: energy.to_f64(),
        total: energy.total().to_f64(),
    }
}

/// NaN is the worst there is.
fn worse(worst: f64, value: f64) -> f64 {
    if value <= worst { worst } else { value }
}

/// In units of `unit`, J.
fn ledger(unit: f64, start: &Energy<f64>, end: &Energy<f64>) -> Ledger {
    Ledger {
        start_j: unit * start.stored(),
        stored: entries(
            unit,
            [
                ("motion", end.motion),
                ("spin", end.spin),
                ("height", end.height),
                ("magnets", end.magnets),
            ],
        ),
        gone: entries(
            unit,
            [
                ("friction heat", end.heat),
                ("impacts", end.lost),
                ("by the drive of the spin", -end.driven),
            ],
        ),
    }
}
