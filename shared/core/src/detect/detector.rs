//! The detector: learns while the rotor floats, finds the release, then follows the rotor or, where they part, its ends.

mod learnt;

pub(crate) use self::learnt::Afloat;
use crate::config::DetectorConfig;
use crate::detect::ends::{Ends, EndsTest};
use crate::detect::estimate::{Estimate, Exposure};
use crate::detect::event_writer::EventWriter;
use crate::detect::fall::{Blocks, FallTest, FallVerdict};
use crate::detect::flight::{FlightTest, NoiseFloor};
use crate::detect::levitation::{Learning, Levitation};
use crate::detect::measurement::Measurement;
use crate::detect::noise::Noise;
use crate::detect::orbit::{OrbitState, Orbiting};
use crate::detect::pending::Pending;
use crate::detect::phase_machine::{Disturbance, Lifting, PhaseMachine, PhaseState};
use crate::detect::possible::{Possible, PossibleTest};
use crate::detect::release::{Release, ReleaseBank, Released};
use crate::detect::ring_planes::RingPlanes;
use crate::detect::signals::Signals;
use crate::detect::slip::Slip;
use crate::event::{EventKind, Moment, Motion, Notices, Plane};
use crate::fault::SPEED;
use crate::phase::Phase;
use crate::sensing::{PLANES, PlanePositions, Reading, SensingConfig, mean};
use crate::vector::{direction, less, square, sum};
use touchdown_rotor::error::ConfigError;
use touchdown_rotor::real::ln;

/// Standard deviations by which a rotor has moved for certain.
const MOVED: f32 = 8.0;
/// Time after a withdrawn fall, or a change of what is taken off, for which no fall is declared, s.
const HOLD: f32 = 30e-3;
/// Angle beyond that of friction, rad, up to which a rotor at the wall may lie there still.
const RESTING_ANGLE: f32 = 0.1;

/// Coefficients.
#[derive(Clone, Copy, Debug)]
pub struct Detector {
    config: DetectorConfig,
    resolution: f32,
    ring_planes: RingPlanes,
    possible: PossibleTest,
    learning: Learning,
    orbiting: Orbiting,
    release: Release,
    falls: FallTest,
    /// Of the floating rotor.
    flight: FlightTest,
    phase_machine: PhaseMachine,
    ends: EndsTest,
    start_samples: u32,
    hold_samples: u32,
}

/// What the detector carries from sample to sample.
#[derive(Clone, Copy, Debug, Default)]
pub struct DetectorState {
    sample: u64,
    next_number: u16,
    /// As measured while the rotor last floated, rad/s.
    spin: Option<f32>,
    possible: Possible,
    noise: Noise,
    levitation: Levitation,
    orbit: OrbitState,
    release: ReleaseBank,
    blocks: Blocks,
    /// Samples for which no fall is declared.
    hold: u32,
    listener: NoiseFloor,
    pending: Option<Pending>,
    /// The rotor as a whole.
    rotor: PhaseState,
    ends: Ends,
    /// First position, m, and whether the rotor has been at the wall since.
    origin: Option<[f32; 2]>,
    off_wall: bool,
}

impl Detector {
    /// Checks `config`, and where the sensors are.
    pub fn try_new(config: &DetectorConfig, sensing: &SensingConfig) -> Result<Self, ConfigError> {
        config.validate()?;
        let rate = config.sample_rate;
        let tuning = &config.tuning;
        let threshold = -ln(tuning.false_alarm);
        Ok(Self {
            config: *config,
            resolution: sensing.resolution,
            ring_planes: RingPlanes::try_new(sensing.places.as_ref())?,
            possible: PossibleTest::new(config),
            learning: Learning::new(tuning, rate),
            orbiting: Orbiting::new(config),
            release: Release::new(tuning, rate, config.machine.gravity, threshold),
            falls: FallTest::new(config),
            hold_samples: (HOLD * rate) as u32,
            flight: FlightTest::new(config, threshold),
            phase_machine: PhaseMachine::new(config, threshold),
            ends: EndsTest::new(config, threshold),
            start_samples: ((0.2 * tuning.still_time * rate).max(1.0) as u32).max(64),
        })
    }

    /// One tick. Bounded; cannot fail.
    pub fn update(
        &self,
        state: &mut DetectorState,
        reading: &Reading,
        signals: &Signals,
        notices: &mut Notices,
    ) {
        let sample = state.sample;
        state.sample += 1;
        let mut writer = EventWriter {
            sample,
            plane: match reading.planes {
                [Some(_), None] => Plane::A,
                [None, Some(_)] => Plane::B,
                _ => Plane::Both,
            },
            motion: Motion::Cylindrical,
            next_number: state.next_number,
            notices,
        };
        for (channel, found) in (0..).zip(&reading.found) {
            if let Some(found) = found {
                writer.tell_fault(channel, found);
            }
        }
        if let Some(found) = signals.spin_fault {
            writer.tell_fault(SPEED, &found);
        }
        if reading.moved != [0.0; 2] {
            state.shift(reading.moved);
        }
        self.orbiting.advance(&mut state.orbit, signals.spin);
        if state.rotor.phase <= Phase::Levitated {
            state.spin = signals.spin;
        }
        let seen = self.possible(state, &reading.planes);
        let planes = self.ring_planes.positions(&seen);
        let measurement = self.measurement(state, &planes);
        match planes {
            [Some(a), Some(b)] if state.noise.is_known() => {
                let floats = state.rotor.phase == Phase::Levitated;
                let variance =
                    self.ring_planes.growth_apart * state.noise.variance(1, self.resolution);
                self.ends.take(&mut state.ends, a, b, variance, floats);
                writer.motion = state.ends.motion();
            }
            _ if seen == reading.planes => state.ends.lose_sight(),
            _ => {}
        }
        if state.ends.are_alone {
            self.apart(state, measurement.as_ref(), &planes, signals, &mut writer);
        } else {
            self.together(state, measurement.as_ref(), signals, &mut writer);
            if state.ends.have_parted() {
                self.part(state, &planes, &mut writer);
            }
        }
        state.next_number = writer.next_number;
    }

    /// The planes' positions, m: none where a rotor that floats cannot be.
    fn possible(&self, state: &mut DetectorState, planes: &PlanePositions) -> PlanePositions {
        let floats = state.rotor.phase == Phase::Levitated || state.pending.is_some();
        let variance = state.noise.variance(1, self.resolution);
        let is_known = state.noise.is_known();
        if is_known && !(self.possible).take(&mut state.possible, planes, variance, floats) {
            return [None; PLANES];
        }
        *planes
    }

    /// Mean of the planes, once the noise is known.
    fn measurement(
        &self,
        state: &mut DetectorState,
        planes: &PlanePositions,
    ) -> Option<Measurement> {
        let Some((position, planes)) = mean(planes) else {
            state.noise.skip();
            return None;
        };
        state.noise.take(position, planes);
        let is_known = state.noise.is_known();
        let variance = state.noise.variance(planes, self.resolution);
        is_known.then(|| self.measured(state, position, variance))
    }

    /// A position, m, of this variance, m^2.
    fn measured(&self, state: &DetectorState, position: [f32; 2], variance: f32) -> Measurement {
        Measurement {
            now: Moment::of_sample(state.sample.saturating_sub(1)),
            position,
            variance,
            spin: state.spin.unwrap_or(self.config.machine.spin),
        }
    }

    /// The rotor for a forecast, `spin` (rad/s) as measured: after an impact or in contact, while its ends move as one.
    pub(crate) fn estimate(&self, state: &DetectorState, spin: Option<f32>) -> Option<Estimate> {
        if state.ends.are_alone {
            return None;
        }
        let at = Moment::of_sample(state.sample.saturating_sub(1));
        self.phase_machine.estimate(&state.rotor, at, spin)
    }

    /// What the rotor goes through; of ends that are apart the one that is worse off.
    #[inline]
    pub(crate) fn strain<'a>(&self, state: &'a DetectorState) -> Exposure<'a> {
        let of = |phase_state: &'a PhaseState| self.phase_machine.strain(phase_state);
        match state.ends.alone() {
            [a, b] => {
                let mut both = of(a);
                both.add(&of(b));
                both
            }
            _ => of(&state.rotor),
        }
    }

    /// Each end's position, where seen.
    fn fixes(
        &self,
        state: &DetectorState,
        planes: &PlanePositions,
    ) -> [Option<Measurement>; PLANES] {
        let variance = state.noise.variance(1, self.resolution);
        let of = |plane: Option<[f32; 2]>, growth: f32| {
            plane.map(|position| self.measured(state, position, growth * variance))
        };
        let ([a, b], [of_a, of_b]) = (*planes, self.ring_planes.growth);
        [of(a, of_a), of(b, of_b)]
    }

    /// The rotor as a whole.
    fn together(
        &self,
        state: &mut DetectorState,
        measurement: Option<&Measurement>,
        signals: &Signals,
        writer: &mut EventWriter,
    ) {
        match (state.rotor.phase, measurement) {
            (Phase::Starting, Some(measurement)) => self.starting(state, measurement),
            (Phase::Levitated, Some(measurement)) => {
                self.levitated(state, measurement, signals, writer)
            }
            (Phase::FreeFall | Phase::Impact, Some(measurement)) => {
                self.airborne(state, measurement, signals, writer);
            }
            (Phase::Sliding | Phase::Rolling, measurement) => {
                self.touching(state, measurement, signals, writer)
            }
            (Phase::FreeFall | Phase::Impact, None) => {
                self.phase_machine.skip(&mut state.rotor);
                self.falls.advance(&mut state.blocks);
            }
            (Phase::Starting | Phase::Levitated, None) => {
                self.falls.advance(&mut state.blocks);
            }
        }
    }

    /// Switched on: floats, or lies on the wall already. What moves along the wall is in contact; what
    /// keeps still there is, if it could lie there.
    fn starting(&self, state: &mut DetectorState, measurement: &Measurement) {
        let (outward, _) = direction(measurement.position);
        let machine = &self.config.machine;
        state.off_wall |= !self.phase_machine.is_near(measurement.position);
        self.learning
            .take(&mut state.levitation, measurement.position);
        let origin = *state.origin.get_or_insert(measurement.position);
        let moved = square(measurement.position, origin) > MOVED * MOVED * measurement.variance;
        let since_start = state.sample.saturating_sub(1) as f32;
        if state.off_wall {
            state.rotor.phase = Phase::Levitated;
        } else if moved {
            self.phase_machine
                .lie(&mut state.rotor, measurement, since_start);
        } else if state.sample >= u64::from(self.start_samples) {
            let lies = outward[0].abs() <= -outward[1] * (machine.friction + RESTING_ANGLE);
            if lies || machine.gravity == 0.0 {
                self.phase_machine
                    .lie(&mut state.rotor, measurement, since_start);
            } else {
                state.rotor.phase = Phase::Levitated;
            }
        }
    }

    fn levitated(
        &self,
        state: &mut DetectorState,
        measurement: &Measurement,
        signals: &Signals,
        writer: &mut EventWriter,
    ) {
        let before = state.levitation.variance;
        let (released, is_full) = self.watch(state, measurement, (before, true));
        let is_armed = state.levitation.is_armed;
        self.listen(state, measurement);
        let threshold_scale = state.listener.threshold_scale();
        let variance = measurement.variance;
        let unforeseen = is_full
            .then(|| {
                (self.falls).unforeseen(&state.blocks, variance, state.orbit.learnt.is_certain)
            })
            .flatten();
        let home = state.levitation.mean;
        if is_full {
            let place = state.blocks.newest_without_orbit();
            if self.phase_machine.is_lifted(place, home, before) {
                return self.learn_again(state, writer);
            }
        }
        let is_near = is_full && self.phase_machine.is_near(state.blocks.newest());
        state.off_wall |= is_full && !is_near;
        let touches = is_near && state.off_wall;
        state.hold = state.hold.saturating_sub(1);
        let may_declare = is_armed && state.hold == 0;
        let declared = match (unforeseen, released.filter(|_| may_declare)) {
            (Some(age), _) => Some((age, Default::default())),
            (None, Some(it)) => {
                let period = 1.0 / self.config.sample_rate;
                let taken = [it.taken[0], it.taken[1] * period];
                let paths = state.orbit.paths(it.age, it.acceleration, taken);
                Some((it.age, paths))
            }
            (None, None) => None,
        };
        if declared.is_none() && !touches {
            return;
        }
        state.listener.interrupt();
        self.phase_machine
            .fly(&mut state.rotor, measurement, None, threshold_scale);
        if let Some((age, paths)) = declared {
            state.pending = Some(Pending {
                number: writer.declare(EventKind::FreeFall, age, 0.0),
                since: measurement.now.later(-age),
                declared: measurement.now,
                paths,
                ..Pending::default()
            });
        }
        if unforeseen.is_some() || signals.levitated == Some(false) {
            writer.resolve(&mut state.pending, true);
        }
    }

    /// How loud the impact test is, with the orbit taken off that ends with the levitation.
    fn listen(&self, state: &mut DetectorState, measurement: &Measurement) {
        let is_known = self.learning.has_position(&state.levitation) && state.orbit.is_settled();
        if is_known && !state.listener.is_known {
            let measurement = Measurement {
                position: less(measurement.position, state.orbit.ending()),
                ..*measurement
            };
            let (listener, flight) = (&mut state.listener, &mut state.rotor.flight);
            self.flight.listen(listener, flight, &measurement);
        }
    }

    /// Of a rotor that floats, for certain or perhaps: a release, and whether a block is full.
    fn watch(
        &self,
        state: &mut DetectorState,
        measurement: &Measurement,
        (variance, floats): (f32, bool),
    ) -> (Option<Released>, bool) {
        let noise = measurement.variance;
        let position = measurement.position;
        let residual = (self.orbiting).take(&mut state.orbit, position, (variance, noise), floats);
        if residual.first {
            state.release.forget();
            state.blocks = Blocks::default();
            state.hold = self.hold_samples;
        }
        let released = floats
            .then(|| {
                let memory = self.orbiting.memory(&state.orbit);
                (self.release).take(&mut state.release, residual.way, memory, noise)
            })
            .flatten();
        let is_full = self.falls.take(&mut state.blocks, residual.parts);
        if floats {
            self.learning.take(&mut state.levitation, position);
        }
        (released, is_full)
    }

    fn airborne(
        &self,
        state: &mut DetectorState,
        measurement: &Measurement,
        signals: &Signals,
        writer: &mut EventWriter,
    ) {
        let (rotor, pending) = (&mut state.rotor, &mut state.pending);
        let home = state.levitation.mean;
        let centre = pending.map_or(home, |pending| pending.would_be(measurement.now));
        self.phase_machine
            .land(rotor, measurement, centre, signals, pending, writer);
        if rotor.phase.is_contact() {
            return;
        }
        if self.resolve(state, measurement, writer) {
            return;
        }
        if self.phase_machine.floats(&mut state.rotor, measurement) {
            if state.pending.is_some() {
                return self.go_on(state, writer);
            }
            self.learn_again(state, writer);
            self.phase_machine.tell_levitated(writer);
        }
    }

    /// How a declared fall stands; true where it was none.
    fn resolve(
        &self,
        state: &mut DetectorState,
        measurement: &Measurement,
        writer: &mut EventWriter,
    ) -> bool {
        if state.pending.is_none() {
            return false;
        }
        let variance = state.levitation.variance;
        let (_, is_full) = self.watch(state, measurement, (variance, false));
        let (noise, orbits) = (measurement.variance, state.orbit.learnt.is_certain);
        let Some(pending) = &mut state.pending else {
            return false;
        };
        let is_unforeseen =
            is_full && (self.falls.unforeseen(&state.blocks, noise, orbits)).is_some();
        let fall = if is_unforeseen {
            FallVerdict::Certain
        } else if self.falls.judges(&state.blocks) {
            let (now, home) = (measurement.now, state.levitation.mean);
            (self.falls).judge(&state.blocks, pending, now, home, (noise, orbits))
        } else {
            FallVerdict::Open
        };
        match fall {
            FallVerdict::Open => return false,
            FallVerdict::Certain => writer.resolve(&mut state.pending, true),
            FallVerdict::Caught => self.go_on(state, writer),
        }
        fall == FallVerdict::Caught
    }

    /// It never fell: what is learnt of it holds.
    fn go_on(&self, state: &mut DetectorState, writer: &mut EventWriter) {
        writer.resolve(&mut state.pending, false);
        state.release.restart();
        state.hold = self.hold_samples;
        state.rotor.phase = Phase::Levitated;
    }

    /// Floats again: withdraws what is open.
    #[inline(never)]
    fn learn_again(&self, state: &mut DetectorState, writer: &mut EventWriter) {
        writer.resolve(&mut state.pending, false);
        state.rotor.phase = Phase::Levitated;
        state.levitation = Levitation::default();
        state.listener = NoiseFloor::default();
        state.release.forget();
        state.orbit.forget();
        state.blocks = Blocks::default();
        state.ends.forget();
    }

    fn touching(
        &self,
        state: &mut DetectorState,
        measurement: Option<&Measurement>,
        signals: &Signals,
        writer: &mut EventWriter,
    ) {
        let disturbance = &state.disturbance();
        let (machine, rotor) = (&self.phase_machine, &mut state.rotor);
        let findings = machine.feel(rotor, measurement, signals, (disturbance, true));
        let lifting = state.ends.lifting(&rotor.contact);
        if matches!(findings, [Some((EventKind::LiftOff, _)), _]) && lifting != Lifting::Both {
            // Nothing is told of one end before it has a ladder of its own.
            state.ends.lifts |= lifting == Lifting::One;
        } else if findings != [None, None] {
            machine.go_on(rotor, findings, measurement, disturbance, writer);
        }
    }

    /// Gives each end a ladder of its own where they have moved apart.
    fn part(&self, state: &mut DetectorState, planes: &PlanePositions, writer: &mut EventWriter) {
        let [Some(a), Some(b)] = self.fixes(state, planes) else {
            return;
        };
        let ends = [&a, &b];
        let threshold_scale = state.listener.threshold_scale();
        match state.rotor.phase {
            Phase::Starting => return,
            Phase::Levitated => {
                // The mean of both need not move when the rotor only tilts.
                let (homes, variance) = state.ends.homes(&state.levitation);
                let [home_a, home_b] = homes;
                let far = [(a, home_a), (b, home_b)].map(|(measurement, centre)| {
                    let position = measurement.position;
                    self.phase_machine.is_far(position, centre)
                        && !self.phase_machine.is_lifted(position, centre, variance)
                        && Ends::is_off(position, centre, variance)
                });
                if far == [false; PLANES] || !state.levitation.is_armed {
                    return;
                }
                let number = writer.declare_at(far, EventKind::FreeFall);
                state.pending = Some(Pending {
                    number,
                    since: ends[0].now,
                    declared: ends[0].now,
                    ..Pending::default()
                });
                writer.resolve(&mut state.pending, true);
                self.phase_machine
                    .fly(&mut state.rotor, ends[0], None, threshold_scale);
            }
            _ => {}
        }
        self.ends
            .part(&mut state.ends, &state.rotor, ends, threshold_scale);
    }

    /// Each end for itself, until they move as one again.
    fn apart(
        &self,
        state: &mut DetectorState,
        measurement: Option<&Measurement>,
        planes: &PlanePositions,
        signals: &Signals,
        writer: &mut EventWriter,
    ) {
        let fixes = &self.fixes(state, planes);
        let disturbance = state.disturbance();
        let (ends, pending) = (&mut state.ends, &mut state.pending);
        let floating = (&state.levitation, &disturbance);
        self.ends
            .step(ends, fixes, signals, floating, pending, writer);
        if let Some(measurement) = measurement
            && self.resolve(state, measurement, writer)
        {
            state.ends.unite();
            return;
        }
        let ends = &mut state.ends;
        if let Some(joined) = self.ends.join(ends, fixes) {
            state.rotor = *joined;
            if state.rotor.phase == Phase::Levitated {
                self.learn_again(state, writer);
            }
        }
    }
}

impl DetectorState {
    fn disturbance(&self) -> Disturbance {
        Disturbance {
            threshold_scale: self.listener.threshold_scale(),
            variance: self.levitation.learnt_variance() - self.orbit.ending_variance(),
        }
    }

    /// The mean over the planes has moved by `way` (m), the rotor has not.
    fn shift(&mut self, way: [f32; 2]) {
        self.levitation.shift(way);
        self.orbit.shift(way);
        self.blocks = Blocks::default();
        if let Some(origin) = &mut self.origin {
            *origin = sum(*origin, way);
        }
        if !self.ends.are_alone {
            let track = &mut self.rotor.flight.track;
            track.position = sum(track.position, way);
            self.rotor.flight.wall.shift(way);
            self.rotor.contact = self.rotor.contact.at_one_end(way);
        }
    }

    /// The present phase; of ends that are apart the one that is further on.
    pub fn phase(&self) -> Phase {
        let [a, b] = self.phases();
        a.max(b)
    }

    /// The present phase of each end.
    pub fn phases(&self) -> [Phase; PLANES] {
        self.ends.phases().unwrap_or([self.rotor.phase; PLANES])
    }

    /// How the rotor moves.
    pub fn motion(&self) -> Motion {
        self.ends.motion()
    }

    /// Whether the rotor lies still, as a whole.
    pub fn rests(&self) -> bool {
        self.ends.alone().is_empty() && self.rotor.phase.is_contact() && self.rotor.contact.rests()
    }

    /// Whether the wall has given way.
    pub(crate) fn wall_gives(&self) -> bool {
        let mut ends = self.ends.alone().iter();
        self.rotor.flight.gives || ends.any(|it| it.flight.gives)
    }

    /// Slip in contact, where it is measured against an inner ring that turns.
    pub fn slip(&self) -> Option<Slip> {
        let ends = self.ends.alone();
        let all = if ends.is_empty() {
            core::slice::from_ref(&self.rotor)
        } else {
            ends
        };
        let mut contacts = all
            .iter()
            .filter(|phase_state| phase_state.phase.is_contact());
        contacts.find_map(|phase_state| phase_state.contact.slip)
    }

    /// Whether noise and position have been learnt.
    pub fn is_armed(&self) -> bool {
        self.levitation.is_armed
    }

    /// Hands out the words that every tick's outcome depends on.
    pub(crate) fn fingerprint(&self, mut put: impl FnMut(u32)) {
        put(self.rotor.phase as u32);
        put(u32::from(self.next_number));
        let [x, y] = self.levitation.mean;
        let learnt = [x, y, self.levitation.variance, self.release.highest];
        let rotor = learnt.into_iter().chain(self.rotor.words());
        rotor.for_each(|value| put(bits(value)));
        for end in self.ends.alone() {
            put(end.phase as u32);
            end.words().into_iter().for_each(|value| put(bits(value)));
        }
        if let Some(slip) = self.slip() {
            put(bits(slip.speed));
        }
    }
}

/// The bits of a NaN differ between machines that agree on everything else.
pub(crate) fn bits(value: f32) -> u32 {
    if value.is_nan() {
        0x7fc0_0000
    } else {
        value.to_bits()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::config::Tuning;
    use crate::detect::noise::white;
    use crate::detect::series::tests::MACHINE;
    use crate::sensing::tests::CONFIG;
    use core::f32::consts::TAU;

    /// Of an orbit of 30 um, 450 um^2 on each axis, no more than runout of 8 um counts as noise on the wall.
    #[test]
    fn an_orbit_is_no_noise_on_the_wall() {
        let config = DetectorConfig {
            sample_rate: 20_000.0,
            machine: MACHINE,
            tuning: Tuning::default(),
        };
        let sensing = SensingConfig {
            resolution: 0.5e-6,
            ..CONFIG
        };
        let detector = Detector::try_new(&config, &sensing).expect("valid");
        let (mut state, mut seed) = (DetectorState::default(), 1);
        for k in 0..12_000_u16 {
            let (sin, cos) = libm::sincosf(TAU * 150.0 / 20_000.0 * f32::from(k));
            let place = [30e-6 * cos, 30e-6 * sin];
            let planes = [0; PLANES].map(|_| Some(place.map(|it| it + 1e-6 * white(&mut seed))));
            let reading = Reading {
                planes,
                unusable: 0,
                moved: [0.0; 2],
                found: Default::default(),
            };
            detector.update(
                &mut state,
                &reading,
                &Signals::default(),
                &mut Notices::new(),
            );
        }
        assert_eq!(state.rotor.phase, Phase::Levitated);
        assert!((state.levitation.learnt_variance() - 450e-12).abs() < 10e-12);
        let variance = state.disturbance().variance;
        assert!((20e-12..50e-12).contains(&variance), "{variance}");
    }
}
