//! Rungs `support`, `two-plane` and `coupled`: as a model among others, and with what happens in each ring and to it.

use touchdown_models::{
    ActuatorConfig, BaseConfig, Coupled, CoupledConfig, CoupledEnergy, CoupledState, ModeConfig,
    MountConfig, Placement, RaceConfig, RingConfig, RingEvent, SeatConfig, UnbalanceConfig, Whole,
};
use touchdown_rotor::error::ConfigError;
use touchdown_rotor::scales::Scales;
use touchdown_rotor::{Precision, Start, Stepper};

use super::once::Once;
use super::seen::{ModelRun, RaceEnd, RingEnd, STILL, Seen, steps_of_run};
use super::{InNumbers, Subject, Use, in_numbers, scaled};
use touchdown_base::history::{Recorder, RotorState};
use touchdown_base::ledger::{Ledger, entries};
use touchdown_base::rings::{Histories, Merge};
use touchdown_scene::scales::start_speed;
use touchdown_scene::{Fidelity, MODES, Ring, Scene, TwoPlane};

/// Coordinates of a rotor that only moves, that tilts too, and that bends too. Modes that a scene does not have
/// stand still, because each number more is built for every number of rings and kind of numbers.
const MOVES: usize = 1;
const TILTS: usize = 2;
const BENDS: usize = 2 + MODES;

/// Stretches tried beyond one a step, of all of a run, before it is given up: some seconds of processor time. What
/// chatters on a stiff ring would take hundreds in each step.
const MOST_TRIED: u64 = 200_000;

/// What is done with the model, whatever its rings and coordinates.
trait UseWhole {
    type Output;

    fn with<R: Precision, const N: usize, const Q: usize>(
        self,
        whole: Whole<R, N, Q>,
        scales: Scales<f64>,
    ) -> Result<Self::Output, ConfigError>;
}

struct AsModel<'a, U>(&'a Scene, U);

impl<U: Use> UseWhole for AsModel<'_, U> {
    type Output = U::Output;

    fn with<R: Precision, const N: usize, const Q: usize>(
        self,
        whole: Whole<R, N, Q>,
        scales: Scales<f64>,
    ) -> Result<U::Output, ConfigError> {
        self.1.with(&Subject {
            start: Start::Free {
                position: whole.start.position,
                velocity: whole.start.velocity,
            },
            spin: R::lit(self.0.rotor.spin / scales.spin),
            scales,
            model: Once(whole),
        })
    }
}

/// Builds the model with the scene's parts for `what`.
pub(super) fn with_parts<R: Precision, U: Use>(
    scene: &Scene,
    what: U,
) -> Result<U::Output, ConfigError> {
    in_parts::<R, _>(scene, AsModel(scene, what))
}

fn in_parts<R: Precision, V: UseWhole>(scene: &Scene, what: V) -> Result<V::Output, ConfigError> {
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
) -> Result<V::Output, ConfigError> {
    let model = Coupled::<f64, N, Q>::try_new(&config::<N>(scene)?)?;
    let whole = Whole {
        start: placement(scene, &model).rounded::<R>(),
        model: model.rounded::<R>(),
    };
    what.with(whole, *model.scales())
}

/// The rotor's ends, where the rung has them.
fn ends(scene: &Scene) -> Option<&TwoPlane> {
    let has = scene.model.rung != Fidelity::Support;
    scene.two_plane.as_ref().filter(|_| has)
}

/// Bending modes that the rung has.
fn modelled_modes(scene: &Scene) -> impl Iterator<Item = &touchdown_scene::Mode> {
    let has = scene.model.rung == Fidelity::Coupled;
    let modes = ends(scene).into_iter().flat_map(|it| &it.modes);
    modes.filter(move |_| has)
}

/// Each bending mode's displacement at a place.
fn shape(scene: &Scene, place: f64) -> [f64; MODES] {
    let mut shape = [0.0; MODES];
    for (to, mode) in shape.iter_mut().zip(modelled_modes(scene)) {
        *to = mode.at(place);
    }
    shape
}

/// The retainer's rings with what the rung has of them.
fn seats(scene: &Scene) -> Vec<SeatConfig<f64>> {
    let whole = Ring {
        name: String::new(),
        place: 0.0,
        radius: scene.rotor.radius,
        retainer: scene.retainer,
        support: scene.support,
        ball_bearing: scene.ball_bearing,
    };
    let rings = ends(scene).map_or(std::slice::from_ref(&whole), |it| &it.rings);
    let moves = scene.model.rung != Fidelity::TwoPlane;
    let seat = |ring: &Ring| SeatConfig {
        ring: RingConfig {
            place: ring.place,
            clearance: ring.retainer.clearance,
            radius: ring.radius,
            friction: ring.retainer.friction,
            restitution: ring.retainer.restitution,
        },
        mount: ring.support.as_ref().filter(|_| moves).map(mount),
        race: ring.ball_bearing.as_ref().filter(|_| moves).map(race),
        shape: shape(scene, ring.place),
    };
    rings.iter().map(seat).collect()
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

fn config<const N: usize>(scene: &Scene) -> Result<CoupledConfig<f64, N>, ConfigError> {
    let rings = seats(scene).try_into();
    let mut config = CoupledConfig {
        mass: scene.rotor.mass,
        polar_inertia: scene.rotor.polar_inertia,
        transverse_inertia: scene.rotor.polar_inertia,
        rings: rings.map_err(|_| ConfigError::OutOfRange("rings", "1 to 4"))?,
        gravity: [0.0, -scene.run.gravity],
        speed: start_speed(scene),
        unbalance: UnbalanceConfig::default(),
        magnets: [ActuatorConfig::default(); _],
        base: None,
        modes: [None; MODES],
        step: scene.model.step,
    };
    let Some(machine) = ends(scene) else {
        return Ok(config);
    };
    config.transverse_inertia = machine.transverse_inertia;
    let (sin, cos) = machine.gravity_angle.sin_cos();
    config.gravity = [scene.run.gravity * sin, -scene.run.gravity * cos];
    config.unbalance = UnbalanceConfig {
        eccentricity: machine.unbalance[0] / scene.rotor.mass,
        angle: machine.unbalance[1],
        skew: machine.skew[0],
        skew_angle: machine.skew[1],
    };
    let damps = f64::from(u8::from(scene.model.rung == Fidelity::Coupled));
    for (to, from) in config.magnets.iter_mut().zip(&machine.magnets) {
        *to = ActuatorConfig {
            place: from.place,
            stiffness: from.stiffness,
            damping: damps * from.damping,
            force: from.force,
            on: from.on,
            shape: shape(scene, from.place),
        };
    }
    if scene.model.rung == Fidelity::Coupled {
        config.base = machine.base.map(|it| BaseConfig {
            amplitude: it.amplitude,
            rate: it.rate,
            phase: it.phase,
        });
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

/// The machine after a step.
#[derive(Clone, Copy, Debug)]
pub struct StepView {
    /// Farthest of the axis beyond the wall of any ring, its clearance, and of a ring beyond its hard stop, rho0; below
    /// 0 before any.
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
        in_parts::<R, _>(self.0, self)
    }
}

impl UseWhole for Run<'_> {
    type Output = ModelRun;

    fn with<R: Precision, const N: usize, const Q: usize>(
        self,
        whole: Whole<R, N, Q>,
        scales: Scales<f64>,
    ) -> Result<ModelRun, ConfigError> {
        followed(self.0, &whole, &scales, self.1)
    }
}

fn followed<R: Precision, const N: usize, const Q: usize>(
    scene: &Scene,
    of: &Whole<R, N, Q>,
    scales: &Scales<f64>,
    each: &mut dyn FnMut(StepView),
) -> Result<ModelRun, ConfigError> {
    let model = &of.model;
    let radii: Vec<f64> = seats(scene).iter().map(|it| it.ring.radius).collect();
    let recorder = Recorder::new(-scene.first_sample_time());
    let (mut whole, mut rings, mut merge) = (recorder.clone(), vec![recorder; N], Merge::new(N));
    // Spin is told as surface speed in the ring.
    let at_ring = |ring: usize| Scales {
        spin: scales.speed / radii[ring],
        ..*scales
    };
    let mut peaks = [[0.0; 2]; N];
    let mut struck = [0.0; N];
    let mut take = |it: RingEvent<R>| {
        let [x, y] = it.event.after.position.map(R::to_f64);
        struck[it.ring] = f64::max(struck[it.ring], x.hypot(y));
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
    let take: &mut dyn FnMut(RingEvent<R>) = &mut take;
    let spin = R::lit(scene.rotor.spin / scales.spin);
    let mut state = model.start(&of.start, spin, &mut *take)?;
    let begun = model.energy(&state).to_f64();
    let (steps, fraction) = steps_of_run(scene.run.duration / scene.model.step);
    let mut given_up = None;
    for done in 0..steps {
        if state.tried().saturating_sub(done) > MOST_TRIED {
            given_up = Some(done as f64 * scene.model.step);
            break;
        }
        model.step(&mut state, &mut *take);
        farthest(model, &state, &mut peaks);
        each(seen(model, &state));
    }
    if fraction > 0.0 && given_up.is_none() {
        model.part_step(&mut state, R::lit(fraction), take);
        farthest(model, &state, &mut peaks);
    }
    for ([radius, _], struck) in peaks.iter_mut().zip(struck) {
        *radius = f64::max(*radius, struck);
    }
    let duration = given_up.unwrap_or(scene.run.duration);
    let ends: Vec<RotorState> = (0..N)
        .map(|ring| Seen::state(&model.kinematics_at(&state, ring), duration, &at_ring(ring)))
        .collect();
    let end = Seen::state(&of.kinematics(&state), duration, scales);
    let still = STILL * scales.speed;
    let rings = rings.into_iter().zip(ends);
    let unit = scene.rotor.mass * scales.speed * scales.speed;
    let gap = scene.stator_gap;
    let seats = (0..N).map(|ring| ring_end(model, &state, ring, unit, scales, peaks[ring], gap));
    let energy = [begun, model.energy(&state).to_f64()];
    let mut run = ModelRun {
        given_up,
        ring: None,
        seats: Vec::new(),
        ledger: Some(ledger(scene, unit, &energy)),
        histories: Histories {
            whole: whole.finish(end, still),
            rings: Vec::new(),
        },
    };
    match scene.model.rung {
        Fidelity::Support => run.ring = seats.last(),
        _ => run.seats = seats.collect(),
    }
    if scene.model.rung != Fidelity::Support {
        let rings = rings.map(|(ring, end)| ring.finish(end, still));
        run.histories.rings = rings.collect();
    }
    Ok(run)
}

fn seen<R: Precision, const N: usize, const Q: usize>(
    model: &Coupled<R, N, Q>,
    state: &CoupledState<R, N, Q>,
) -> StepView {
    let walls = (0..N).map(|ring| model.reach_at(state, ring).to_f64() - 1.0);
    let stops = (0..N).filter_map(|ring| model.beyond_stop(state, ring).map(R::to_f64));
    // NaN is the worst there is.
    let worse = |worst: f64, it: f64| if it <= worst { worst } else { it };
    StepView {
        beyond: walls.chain(stops).fold(-1.0, worse),
        energy: model.energy(state).to_f64(),
    }
}

/// Keeps the farthest of the axis in each ring from the bearing's centre, and of the ring from its rest place, rho0.
fn farthest<R: Precision, const N: usize, const Q: usize>(
    model: &Coupled<R, N, Q>,
    state: &CoupledState<R, N, Q>,
    peaks: &mut [[f64; 2]; N],
) {
    for (ring, peaks) in peaks.iter_mut().enumerate() {
        let places = [
            model.kinematics_at(state, ring).position,
            model.ring(state, ring).position,
        ];
        for (peak, place) in peaks.iter_mut().zip(places) {
            let [x, y] = place.map(R::to_f64);
            *peak = f64::max(*peak, x.hypot(y));
        }
    }
}

fn ring_end<R: Precision, const N: usize, const Q: usize>(
    model: &Coupled<R, N, Q>,
    state: &CoupledState<R, N, Q>,
    ring: usize,
    unit: f64,
    scales: &Scales<f64>,
    [radius, excursion]: [f64; 2],
    stator_gap: Option<f64>,
) -> RingEnd {
    let motion = model.ring(state, ring);
    let [x_m, y_m] = motion.position.map(|x| x.to_f64() * scales.length);
    let [vx_m_s, vy_m_s] = motion.velocity.map(|v| v.to_f64() * scales.speed);
    let peak_radius_m = radius * scales.length;
    RingEnd {
        x_m,
        y_m,
        vx_m_s,
        vy_m_s,
        peak_radius_m,
        peak_excursion_m: excursion * scales.length,
        clearance_left_m: stator_gap.map(|gap| gap - peak_radius_m),
        held_peak_force_n: model.load(state, ring).held_peak.to_f64() * unit / scales.length,
        race: motion.race.map(|race| RaceEnd {
            inner_ring_rad_s: race.spin.to_f64() * scales.spin,
            cage_rad_s: race.cage.to_f64() * scales.spin,
            temperature_rise_k: race.temperature.to_f64(),
        }),
    }
}

/// Of the parts that there are; `unit` in J.
fn ledger(scene: &Scene, unit: f64, [start, end]: &[CoupledEnergy<f64>; 2]) -> Ledger {
    let seats = seats(scene);
    let mounts = seats.iter().filter_map(|it| it.mount);
    let stops = mounts.clone().any(|it| it.travel.is_some());
    let mounts = mounts.count() > 0;
    let races = seats.iter().any(|it| it.race.is_some());
    let bends = modelled_modes(scene).next().is_some();
    let machine = ends(scene);
    let magnets = machine.is_some_and(|it| !it.magnets.is_empty());
    let driven = machine.is_some_and(|it| it.unbalance[0] != 0.0 || it.skew[0] != 0.0);
    let moved = machine
        .is_some_and(|it| it.base.is_some() || it.magnets.iter().any(|magnet| magnet.on.is_some()));
    Ledger {
        start_j: unit * start.stored(),
        stored: entries(
            unit,
            [
                (true, "motion", end.motion),
                (true, "spin", end.spin),
                (true, "height", end.height),
                (magnets, "magnets", end.magnets),
                (bends, "bending", end.bending),
                (mounts, "ring", end.rings),
                (mounts, "spring", end.springs),
                (races, "inner ring", end.races),
            ],
        ),
        gone: entries(
            unit,
            [
                (true, "friction heat", end.heat),
                (true, "impacts", end.lost),
                (mounts, "damper", end.mounts),
                (stops, "hard stop", end.stops),
                (races, "drag", end.drag),
                (
                    bends || magnets,
                    "damping of bending and magnets",
                    end.damped,
                ),
                (driven && !moved, "by the drive of the spin", -end.driven),
                (
                    moved,
                    "by base, switched magnets and drive of the spin",
                    -end.driven,
                ),
            ],
        ),
    }
}
