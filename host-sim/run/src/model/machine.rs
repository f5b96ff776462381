//! The machine of the rungs `support`, `two-plane` and `coupled`, step by step: what happens in each ring and to it.

use touchdown_models::{CoupledEnergy, CoupledState, RingEvent, Whole};
use touchdown_rotor::error::ConfigError;
use touchdown_rotor::scales::Scales;
use touchdown_rotor::{Precision, Stepper};

use super::parts::{ends, modelled_modes, seats, shape};
use super::seen::{FollowedDrop, ModelRun, RaceEnd, RingEnd, Seen, steps_of_run};
use touchdown_base::history::Recorder;
use touchdown_base::ledger::{Ledger, entries};
use touchdown_base::rings::Merge;
use touchdown_scene::sensors::PLANES;
use touchdown_scene::{Fidelity, RINGS, Scene};
use touchdown_truth::{Moving, TrueState, held};

/// Work ([`CoupledState::work`]) for each second of a run, and for a shorter one, before it is given up: some 5 s of
/// processor time. What chatters on a stiff ring, or jams, would take thousands of times as much. A sample costs a part of a
/// step besides, about as much as one: the budget is for both, whether samples are taken of the model or not.
const MOST_WORK: f64 = 5e6;

/// The machine after a step.
#[derive(Clone, Copy, Debug)]
pub struct StepView {
    /// Farthest of the axis beyond the wall of any ring, its clearance, and of a ring beyond its hard stop, rho0; below
    /// 0 before any.
    pub beyond: f64,
    /// Stretches and impacts taken so far.
    pub taken: u64,
    /// What energy there is and was, in m V^2.
    pub energy: CoupledEnergy<f64>,
}

/// Told of the machine after each step.
pub type OnStep<'a> = &'a mut dyn FnMut(StepView);

/// A drop of the machine of a scene.
pub(super) struct MachineDrop<'a, R, const N: usize, const Q: usize> {
    scene: &'a Scene,
    on_step: Option<OnStep<'a>>,
    of: Whole<R, N, Q>,
    seen: Seen,
    state: CoupledState<R, N, Q>,
    done: u64,
    told: Told<N>,
    /// Turned by the inner rings up to the last step, rad.
    turned: [f64; N],
    begun: CoupledEnergy<f64>,
    given_up: Option<f64>,
}

/// What has happened.
struct Told<const N: usize> {
    seen: [Seen; N],
    whole: Recorder,
    rings: Vec<Recorder>,
    merge: Merge,
    /// Farthest of the axis in each ring from the bearing's centre, and of the ring from its rest place, rho0.
    peaks: [[f64; 2]; N],
}

impl<const N: usize> Told<N> {
    fn new(scene: &Scene, scales: &Scales<f64>) -> Self {
        let recorder = Recorder::new(-scene.first_sample_time());
        let radii: Vec<f64> = seats(scene).iter().map(|it| it.radius).collect();
        Self {
            // Spin is told as surface speed in the ring.
            seen: std::array::from_fn(|ring| {
                let spin = scales.speed / radii[ring];
                Seen::new(scene, Scales { spin, ..*scales })
            }),
            whole: recorder.clone(),
            rings: vec![recorder; N],
            merge: Merge::new(N),
            peaks: [[0.0; 2]; N],
        }
    }

    fn take<R: Precision>(&mut self, it: &RingEvent<R>) {
        reaches(&mut self.peaks[it.ring][0], it.event.after.position);
        let happening = self.seen[it.ring].happening(&it.event);
        self.rings[it.ring].take(happening);
        if let Some(happening) = self.merge.take(it.ring, happening) {
            self.whole.take(happening);
        }
    }
}

impl<'a, R: Precision, const N: usize, const Q: usize> MachineDrop<'a, R, N, Q> {
    /// At the release.
    pub(super) fn new(
        scene: &'a Scene,
        on_step: Option<OnStep<'a>>,
        of: Whole<R, N, Q>,
        scales: Scales<f64>,
    ) -> Result<Self, ConfigError> {
        let mut told = Told::new(scene, &scales);
        let spin = R::lit(scene.rotor.spin / scales.spin);
        let take: &mut dyn FnMut(RingEvent<R>) = &mut |it| told.take(&it);
        let state = of.model.start(&of.start, spin, take)?;
        Ok(Self {
            scene,
            on_step,
            begun: of.model.energy(&state).to_f64(),
            of,
            seen: Seen::new(scene, scales),
            state,
            done: 0,
            told,
            turned: [0.0; N],
            given_up: None,
        })
    }

    /// One step, unless the run is given up.
    fn step(&mut self) {
        let step = self.scene.model.step;
        if self.state.work() as f64 > most_work(self.scene) {
            self.given_up.get_or_insert(self.done as f64 * step);
            return;
        }
        let before = self.race_spins(&self.state);
        let told = &mut self.told;
        let take = |it| told.take(&it);
        self.of.model.step(&mut self.state, take);
        let after = self.race_spins(&self.state);
        for (turned, (a, b)) in self.turned.iter_mut().zip(before.iter().zip(after)) {
            *turned += 0.5 * (a + b) * step;
        }
        self.farthest();
        self.done += 1;
        if let Some(on_step) = self.on_step.take() {
            on_step(self.view());
            self.on_step = Some(on_step);
        }
    }

    fn race_spins(&self, state: &CoupledState<R, N, Q>) -> [f64; N] {
        std::array::from_fn(|ring| {
            let race = self.of.model.ring(state, ring).race;
            race.map_or(0.0, |race| race.spin.to_f64() * self.seen.scales.spin)
        })
    }

    fn steps(&self, time: f64) -> (u64, f64) {
        steps_of_run(time / self.scene.model.step)
    }

    fn to(&mut self, steps: u64) {
        while self.done < steps && self.given_up.is_none() {
            self.step();
        }
    }

    fn view(&self) -> StepView {
        let (model, state) = (&self.of.model, &self.state);
        let rigid = (0..N).filter(|ring| !model.is_compliant(*ring));
        let walls = rigid.map(|ring| model.reach_at(state, ring).to_f64() - 1.0);
        let stops = (0..N).filter_map(|ring| model.beyond_stop(state, ring).map(R::to_f64));
        // NaN is the worst there is.
        let worse = |worst: f64, it: f64| if it <= worst { worst } else { it };
        StepView {
            beyond: walls.chain(stops).fold(-1.0, worse),
            taken: state.taken(),
            energy: model.energy(state).to_f64(),
        }
    }

    fn farthest(&mut self) {
        let (model, state) = (&self.of.model, &self.state);
        for (ring, [axis, own]) in self.told.peaks.iter_mut().enumerate() {
            reaches(axis, model.kinematics_at(state, ring).position);
            reaches(own, model.ring(state, ring).position);
        }
    }

    /// `unit` in J.
    fn ring_end(&self, ring: usize, unit: f64) -> RingEnd {
        let (model, scales) = (&self.of.model, &self.seen.scales);
        let [radius, excursion] = self.told.peaks[ring];
        let motion = model.ring(&self.state, ring);
        let [x_m, y_m] = self.seen.metres(motion.position);
        let [vx_m_s, vy_m_s] = motion.velocity.map(|v| v.to_f64() * scales.speed);
        let peak_radius_m = radius * scales.length;
        let held = model.load(&self.state, ring).held_peak.to_f64() * unit / scales.length;
        let seat = &seats(self.scene)[ring];
        let materials = &self.scene.materials;
        let known = materials.given || model.is_compliant(ring);
        let pressure = || materials.pressure(held, seat.radius, seat.clearance);
        RingEnd {
            x_m,
            y_m,
            vx_m_s,
            vy_m_s,
            peak_radius_m,
            peak_excursion_m: excursion * scales.length,
            clearance_left_m: self.scene.stator_gap.map(|gap| gap - peak_radius_m),
            held_peak_force_n: held,
            peak_pressure_pa: known.then(pressure).flatten(),
            race: motion.race.map(|race| RaceEnd {
                inner_ring_rad_s: race.spin.to_f64() * scales.spin,
                cage_rad_s: race.cage.to_f64() * scales.spin,
                temperature_rise_k: race.temperature.to_f64(),
            }),
        }
    }

    /// Where the sensors see the rotor, m.
    fn sensed(&self, state: &CoupledState<R, N, Q>) -> [[f64; 2]; PLANES] {
        let Some(machine) = ends(self.scene) else {
            return [self.seen.metres(state.centre().0); PLANES];
        };
        machine.sensors.map(|place| {
            let modes = shape(self.scene, place).map(R::lit);
            let shape = self.of.model.shape_at(R::lit(place), modes);
            self.seen.metres(state.axis_at(&shape).0)
        })
    }

    fn moving(&self, state: &CoupledState<R, N, Q>, since: f64) -> Moving {
        let (model, seen) = (&self.of.model, &self.seen);
        if self.scene.two_plane.is_some() {
            let mut ends = [[0.0; 2]; RINGS];
            for (ring, end) in ends.iter_mut().enumerate().take(N) {
                *end = seen.metres(model.displacement(state, ring));
            }
            return Moving::Ends(ends);
        }
        let race_spin = self.race_spins(state)[0];
        Moving::Ring {
            position: seen.metres(model.ring(state, 0).position),
            race_spin,
            race_angle: self.turned[0] + since * race_spin,
        }
    }
}

impl<R: Precision, const N: usize, const Q: usize> FollowedDrop for MachineDrop<'_, R, N, Q> {
    fn advance(&mut self, time: f64) -> Option<TrueState> {
        if time < 0.0 {
            return Some(held(self.scene, time));
        }
        let (steps, fraction) = self.steps(time);
        self.to(steps);
        if self.given_up.is_some() {
            return None;
        }
        let mut state = self.state;
        if fraction > 0.0 {
            let (model, part) = (&self.of.model, R::lit(fraction));
            model.part_step(&mut state, part, &mut |_| ());
        }
        Some(TrueState {
            rotor: self.seen.state(&self.of.kinematics(&state), time),
            phase: self.told.whole.phase(),
            sensed: self.sensed(&state),
            moving: self.moving(&state, fraction * self.scene.model.step),
        })
    }

    fn finish(mut self: Box<Self>) -> ModelRun {
        let scene = self.scene;
        let (steps, fraction) = self.steps(scene.run.duration);
        self.to(steps);
        if fraction > 0.0 && self.given_up.is_none() {
            let told = &mut self.told;
            let (model, part) = (&self.of.model, R::lit(fraction));
            model.part_step(&mut self.state, part, &mut |it| told.take(&it));
            self.farthest();
        }
        let (model, state, seen) = (&self.of.model, &self.state, &self.seen);
        let duration = self.given_up.unwrap_or(scene.run.duration);
        let end = seen.state(&self.of.kinematics(state), duration);
        let still = seen.still();
        let unit = scene.rotor.mass * seen.scales.speed * seen.scales.speed;
        let seats = (0..N).map(|ring| self.ring_end(ring, unit));
        let energy = [self.begun, model.energy(state).to_f64()];
        let mut run = ModelRun {
            given_up: self.given_up,
            work: state.work(),
            jammed: state.jammed().map(|it| it as f64 * scene.model.step),
            ledger: Some(ledger(scene, unit, &energy)),
            ..ModelRun::of_rotor(self.told.whole.clone().finish(end, still))
        };
        if scene.model.rung == Fidelity::Support {
            run.ring = seats.last();
        } else {
            run.seats = seats.collect();
            let rings = self.told.rings.into_iter().enumerate();
            let ended = rings.map(|(k, ring)| {
                let now = model.kinematics_at(state, k);
                ring.finish(self.told.seen[k].state(&now, duration), still)
            });
            run.histories.rings = ended.collect();
        }
        run
    }
}

/// Keeps the distance of `place` in `peak` where it is greater.
fn reaches<R: Precision>(peak: &mut f64, place: [R; 2]) {
    let [x, y] = place.map(R::to_f64);
    *peak = f64::max(*peak, x.hypot(y));
}

/// Work of the run's own steps before it is given up: the samples' share is taken off.
fn most_work(scene: &Scene) -> f64 {
    let samples = scene.model.step * scene.run.sample_rate;
    MOST_WORK * scene.run.duration.max(1.0) / (1.0 + samples)
}

/// Of the parts that there are; `unit` in J.
fn ledger(scene: &Scene, unit: f64, [start, end]: &[CoupledEnergy<f64>; 2]) -> Ledger {
    let seats = seats(scene);
    let mounts = seats.iter().filter_map(|it| it.mount);
    let stops = mounts.clone().any(|it| it.stop.is_some());
    let mounts = mounts.count() > 0;
    let races = seats.iter().any(|it| it.race.is_some());
    let gives_way = seats.iter().any(|it| it.compliant.is_some());
    let bends = modelled_modes(scene).next().is_some();
    let machine = ends(scene);
    let magnets = machine.is_some_and(|it| !it.magnets.is_empty());
    let driven =
        machine.is_some_and(|it| it.unbalance.eccentricity != 0.0 || it.unbalance.skew != 0.0);
    let moved = machine
        .is_some_and(|it| it.base.is_some() || it.magnets.iter().any(|magnet| magnet.on.is_some()));
    let damped = bends || magnets;
    let drive = match moved {
        true => "by base, switched magnets and drive of the spin",
        false => "by the drive of the spin",
    };
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
                (gives_way, "walls", end.contacts),
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
                (damped, "damping of bending and magnets", end.damped),
                (driven || moved, drive, -end.driven),
            ],
        ),
    }
}
