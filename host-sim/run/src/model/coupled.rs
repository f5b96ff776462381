//! Rung `coupled`: as a model among others, and with what happens in each ring and to it.

use touchdown_models::{
    ActuatorConfig, Coupled, CoupledConfig, CoupledEnergy, CoupledState, ModeConfig, Placement,
    RingConfig, RingEvent, SeatConfig, UnbalanceConfig,
};
use touchdown_rotor::error::ConfigError;
use touchdown_rotor::scales::Scales;
use touchdown_rotor::{Kinematics, ModelEvent, Precision, Start, Stepper, Touch};

use super::once::Once;
use super::seen::{ModelRun, RingEnd, STILL, Seen, steps_of_run};
use super::support::{mount, race};
use super::two_plane::machine;
use super::{InNumbers, Subject, Use, in_numbers};
use touchdown_base::history::{Recorder, RotorState};
use touchdown_base::ledger::{Ledger, entries};
use touchdown_base::rings::{Histories, Merge};
use touchdown_scene::scales::start_speed;
use touchdown_scene::{MODES, Scene};

/// Coordinates across the axis: modes that a scene does not have stand still. One number, because each
/// more is built for every number of rings and kind of numbers.
const COORDINATES: usize = 2 + MODES;
type Model<R, const N: usize> = Coupled<R, N, COORDINATES>;
type State<R, const N: usize> = CoupledState<R, N, COORDINATES>;

/// The model and where it starts, its rings seen as one.
struct Whole<R, const N: usize> {
    model: Model<R, N>,
    start: Placement<R>,
}

impl<R: Precision, const N: usize> Stepper<R> for Whole<R, N> {
    type State = State<R, N>;

    /// From its own start: one of the plane has no tilt.
    fn start(
        &self,
        _: &Start<R>,
        spin: R,
        mut on_event: impl FnMut(ModelEvent<R>),
    ) -> Result<Self::State, ConfigError> {
        let mut sink = |it: RingEvent<R>| on_event(it.event);
        self.model.start(&self.start, spin, pointer(&mut sink))
    }

    fn step(&self, state: &mut Self::State, mut on_event: impl FnMut(ModelEvent<R>)) {
        let mut sink = |it: RingEvent<R>| on_event(it.event);
        self.model.step(state, pointer(&mut sink));
    }

    fn part_step(&self, state: &mut Self::State, part: R, mut on_event: impl FnMut(ModelEvent<R>)) {
        let mut sink = |it: RingEvent<R>| on_event(it.event);
        self.model.part_step(state, part, pointer(&mut sink));
    }

    /// Of the centre of mass; turns are those of the ring that has most.
    fn kinematics(&self, state: &Self::State) -> Kinematics<R> {
        let (position, velocity) = state.centre();
        let (mut touch, mut turns) = (Touch::None, (0_i64, R::ZERO));
        for ring in (0..N).map(|ring| self.model.kinematics_at(state, ring)) {
            if ring.touch == Touch::Sliding || touch == Touch::None {
                touch = ring.touch;
            }
            if ring.turns.0.abs() > turns.0.abs() {
                turns = ring.turns;
            }
        }
        Kinematics {
            position,
            velocity,
            spin: state.spin(),
            touch,
            turns,
        }
    }
}

/// The model's code is built once, whatever is done with its events.
fn pointer<R>(on_event: &mut impl FnMut(RingEvent<R>)) -> &mut dyn FnMut(RingEvent<R>) {
    on_event
}

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
    let model = Model::<f64, N>::try_new(&config::<N>(scene)?)?;
    let scales = *model.scales();
    what.with(&Subject {
        start: Start::Free {
            position: [R::ZERO; 2],
            velocity: [R::ZERO; 2],
        },
        spin: R::lit(scene.rotor.spin / scales.spin),
        scales,
        model: Once(Whole {
            start: placement(scene, &model)?.rounded::<R>(),
            model: model.rounded::<R>(),
        }),
    })
}

fn config<const N: usize>(scene: &Scene) -> Result<CoupledConfig<f64, N>, ConfigError> {
    let machine = machine(scene)?;
    let shape = |place: f64| {
        let mut shape = [0.0; MODES];
        for (to, mode) in shape.iter_mut().zip(&machine.modes) {
            *to = mode.at(place);
        }
        shape
    };
    let seat = |ring: &touchdown_scene::Ring| seat(ring, shape(ring.place));
    let rings: Vec<_> = machine.rings.iter().map(seat).collect();
    let mut magnets = [ActuatorConfig::default(); 2];
    for (to, from) in magnets.iter_mut().zip(&machine.magnets) {
        *to = ActuatorConfig {
            place: from.place,
            stiffness: from.stiffness,
            damping: from.damping,
            force: from.force,
            shape: shape(from.place),
        };
    }
    let mut modes = [None; MODES];
    for (to, mode) in modes.iter_mut().zip(&machine.modes) {
        *to = Some(ModeConfig {
            speed: mode.speed,
            damping_ratio: mode.damping_ratio,
            mass: mode.mass,
            centre: mode.at(0.0),
        });
    }
    let (sin, cos) = machine.gravity_angle.sin_cos();
    Ok(CoupledConfig {
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
        modes,
        step: scene.model.step,
    })
}

fn seat(ring: &touchdown_scene::Ring, shape: [f64; MODES]) -> SeatConfig<f64> {
    SeatConfig {
        ring: RingConfig {
            place: ring.place,
            clearance: ring.retainer.clearance,
            radius: ring.radius,
            friction: ring.retainer.friction,
            restitution: ring.retainer.restitution,
        },
        mount: ring.support.as_ref().map(mount),
        race: ring.ball_bearing.as_ref().map(race),
        shape,
    }
}

fn placement<const N: usize>(
    scene: &Scene,
    model: &Model<f64, N>,
) -> Result<Placement<f64>, ConfigError> {
    let machine = machine(scene)?;
    let scales = model.scales();
    let touchdown_scene::Start::Free { position, velocity } = scene.start else {
        return Err(ConfigError::OutOfRange("start", "free"));
    };
    let rate = scales.time / model.tilt_scale();
    Ok(Placement {
        position: position.map(|x| x / scales.length),
        velocity: velocity.map(|v| v / scales.speed),
        tilt: machine.tilt.map(|a| a / model.tilt_scale()),
        tilt_rate: machine.tilt_rate.map(|a| a * rate),
    })
}

/// The machine after a step.
#[derive(Clone, Copy, Debug)]
pub struct StepView {
    /// Farthest beyond the wall of any ring, its clearance; below 0 in flight.
    pub beyond: f64,
    /// What energy there is and was, in m V^2.
    pub energy: CoupledEnergy<f64>,
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
    let exact = Model::<f64, N>::try_new(&config::<N>(scene)?)?;
    let scales = *exact.scales();
    let whole_model = Whole {
        model: exact.rounded::<R>(),
        start: placement(scene, &exact)?.rounded::<R>(),
    };
    let model = &whole_model.model;
    let radii: Vec<f64> = machine(scene)?.rings.iter().map(|it| it.radius).collect();
    let recorder = Recorder::new(-scene.first_sample_time());
    let (mut whole, mut rings, mut merge) = (recorder.clone(), vec![recorder; N], Merge::new(N));
    // Spin is told as surface speed in the ring.
    let at_ring = |ring: usize| Scales {
        spin: scales.speed / radii[ring],
        ..scales
    };
    let mut take = |it: RingEvent<R>| {
        let seen = Seen {
            scales: at_ring(it.ring),
            step: scene.model.step,
            mass: scene.rotor.mass,
        };
        let happening = seen.happening(&it.event);
        rings[it.ring].take(happening);
        if let Some(happening) = merge.take(it.ring, happening) {
            whole.take(happening);
        }
    };
    let spin = R::lit(scene.rotor.spin / scales.spin);
    let mut state = model.start(&whole_model.start, spin, pointer(&mut take))?;
    let begun = model.energy(&state).to_f64();
    let (steps, fraction) = steps_of_run(scene.run.duration / scene.model.step);
    for _ in 0..steps {
        model.step(&mut state, pointer(&mut take));
        each(seen(model, &state));
    }
    if fraction > 0.0 {
        model.part_step(&mut state, R::lit(fraction), pointer(&mut take));
    }
    let duration = scene.run.duration;
    let ends: Vec<RotorState> = (0..N)
        .map(|ring| Seen::state(&model.kinematics_at(&state, ring), duration, &at_ring(ring)))
        .collect();
    let end = Seen::state(&whole_model.kinematics(&state), duration, &scales);
    let still = STILL * scales.speed;
    let rings = rings.into_iter().zip(ends);
    let unit = scene.rotor.mass * scales.speed * scales.speed;
    let seats = (0..N).map(|ring| ring_end(model, &state, ring, unit, &scales));
    Ok(ModelRun {
        ring: None,
        seats: seats.collect(),
        ledger: Some(ledger(unit, &begun, &model.energy(&state).to_f64())),
        histories: Histories {
            whole: whole.finish(end, still),
            rings: rings.map(|(ring, end)| ring.finish(end, still)).collect(),
        },
    })
}

fn seen<R: Precision, const N: usize>(model: &Model<R, N>, state: &State<R, N>) -> StepView {
    let reach = (0..N).map(|ring| model.reach_at(state, ring).to_f64() - 1.0);
    StepView {
        beyond: reach.fold(-1.0, |worst, it| if it <= worst { worst } else { it }),
        energy: model.energy(state).to_f64(),
    }
}

fn ring_end<R: Precision, const N: usize>(
    model: &Model<R, N>,
    state: &State<R, N>,
    ring: usize,
    unit: f64,
    scales: &Scales<f64>,
) -> RingEnd {
    let motion = model.ring(state, ring);
    RingEnd {
        position: motion.position.map(|x| x.to_f64() * scales.length),
        velocity: motion.velocity.map(|v| v.to_f64() * scales.speed),
        held_peak: model.load(state, ring).held_peak.to_f64() * unit / scales.length,
        race: motion.race.map(|race| {
            let [spin, cage] = [race.spin, race.cage].map(|spin| spin.to_f64() * scales.spin);
            [spin, cage, race.temperature.to_f64()]
        }),
    }
}

/// In units of `unit`, J.
fn ledger(unit: f64, start: &CoupledEnergy<f64>, end: &CoupledEnergy<f64>) -> Ledger {
    Ledger {
        start_j: unit * start.stored(),
        stored: entries(
            unit,
            [
                ("motion", end.motion),
                ("spin", end.spin),
                ("height", end.height),
                ("magnets", end.magnets),
                ("bending", end.bending),
                ("rings", end.rings),
                ("springs", end.springs),
                ("inner rings", end.races),
            ],
        ),
        gone: entries(
            unit,
            [
                ("friction heat", end.heat),
                ("impacts", end.lost),
                ("dampers", end.mounts),
                ("hard stops", end.stops),
                ("drag", end.drag),
                ("damping of bending and magnets", end.damped),
                ("by the drive of the spin", -end.driven),
            ],
        ),
    }
}
