//! The phase ladder from the release on: flight, impacts, permanent contact, and what to tell of them.
//!
//! The rotor as a whole has one; so has each end while the two move apart.

use crate::config::{DetectorConfig, MachineConfig};
use crate::detect::contact::{ContactTest, Findings, Touching};
use crate::detect::estimate::{Estimate, Exposure, Place};
use crate::detect::event_writer::EventWriter;
use crate::detect::fall::BLOCK;
use crate::detect::flight::{Airborne, FlightTest, Landing, UNKNOWN_SPEED};
use crate::detect::lift_off::{LiftOff, Lifted};
use crate::detect::measurement::Measurement;
use crate::detect::pending::Pending;
use crate::detect::signals::Signals;
use crate::detect::still::Still;
use crate::event::{EventKind, Moment};
use crate::phase::Phase;
use crate::vector::{direction, length, square};

/// Part of gravity's way that is less than any fall goes, whatever forces are left.
const FALLS: f32 = 0.5;
/// Times the mean square of their wavering on the wall that sensors may be off there.
const WAVERING: f32 = 2.0;
/// Faster than a controller puts a rotor down, m/s.
const LANDING_SPEED: f32 = 0.01;

/// Coefficients.
#[derive(Clone, Copy, Debug)]
pub(crate) struct PhaseMachine {
    machine: MachineConfig,
    /// Square of the radius from which on the rotor may be at the wall, m^2.
    near_square: f32,
    /// Likewise of the way that no caught disturbance goes.
    travel_square: f32,
    /// s.
    period: f32,
    flight: FlightTest,
    contact: ContactTest,
    still_samples: u32,
}

/// Where on the ladder it is.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct PhaseState {
    pub(crate) phase: Phase,
    pub(crate) flight: Airborne,
    pub(crate) contact: Touching,
    pub(crate) still: Still,
}

/// What besides the rotor moves the sensors, as learnt while it floated.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Disturbance {
    /// Factor on the threshold of the impact test.
    pub(crate) threshold_scale: f32,
    /// On the wall, of one axis, m^2.
    pub(crate) variance: f32,
}

/// What a lift-off is that of.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Lifting {
    /// Of both ends, or of one that has a ladder of its own.
    Both,
    /// Of one end.
    One,
    /// The next samples will tell.
    Unclear,
}

impl PhaseState {
    /// What the next tick goes on from.
    pub(crate) fn words(&self) -> [f32; 10] {
        let (flight, wall) = (&self.flight.track, &self.contact.track);
        [
            flight.position[0],
            flight.position[1],
            flight.velocity[0],
            flight.velocity[1],
            wall.slide.sin,
            wall.slide.rate,
            wall.roll.sin,
            wall.roll.rate,
            wall.for_rolling.sum,
            wall.for_sliding.sum,
        ]
    }
}

impl PhaseMachine {
    /// `config` must be valid.
    pub(crate) fn new(config: &DetectorConfig, threshold: f32) -> Self {
        let (machine, tuning) = (config.machine, &config.tuning);
        let near = machine.clearance * (1.0 - tuning.wall_tolerance);
        let travel = tuning.confirm_travel * machine.clearance;
        let samples = |time: f32| (time * config.sample_rate).max(1.0) as u32;
        Self {
            machine,
            near_square: near * near,
            travel_square: travel * travel,
            period: 1.0 / config.sample_rate,
            flight: FlightTest::new(config, threshold),
            contact: ContactTest::new(config, threshold),
            still_samples: samples(tuning.still_time).max(16),
        }
    }

    /// Into flight, from lying on a wall at the radius `wall` (m) where it lifted off.
    pub(crate) fn fly(
        &self,
        phase_state: &mut PhaseState,
        measurement: &Measurement,
        wall: Option<f32>,
        threshold_scale: f32,
    ) {
        self.flight
            .start(&mut phase_state.flight, measurement, wall, threshold_scale);
        phase_state.phase = Phase::FreeFall;
        phase_state.still = Still::default();
    }

    /// One end, `measurement`, goes on from the rotor as a whole; where that lies on the wall, the end does so `way` (m)
    /// beside it.
    pub(crate) fn part(
        &self,
        phase_state: &mut PhaseState,
        rotor: &PhaseState,
        measurement: &Measurement,
        way: [f32; 2],
        threshold_scale: f32,
    ) {
        phase_state.phase = rotor.phase;
        if rotor.phase.is_contact() {
            phase_state.flight.follow(&rotor.flight);
            phase_state.flight.wall.shift(way);
            phase_state.contact = rotor.contact.at_one_end(way);
            phase_state.still = rotor.still;
        } else {
            (self.flight).part(
                &mut phase_state.flight,
                &rotor.flight,
                measurement,
                threshold_scale,
            );
            phase_state.contact = rotor.contact;
            phase_state.still = Still::default();
        }
    }

    /// One end goes on for both: on the wall, where that is must be learnt anew.
    pub(crate) fn both(&self, phase_state: &mut PhaseState) {
        if phase_state.phase.is_contact() {
            self.flight.end_contact(&mut phase_state.flight, None);
            self.flight.begin_contact(&mut phase_state.flight);
        }
        phase_state.contact.lift = LiftOff::on(phase_state.flight.give());
    }

    /// The rotor at `at` for a forecast, once it has met the wall; `spin` (rad/s) as measured.
    pub(crate) fn estimate(
        &self,
        phase_state: &PhaseState,
        at: Moment,
        spin: Option<f32>,
    ) -> Option<Estimate> {
        let machine = &self.machine;
        let series = &phase_state.flight.series;
        let mut estimate = Estimate {
            at,
            place: Place::Air {
                position: phase_state.flight.track.position,
                velocity: phase_state.flight.track.velocity,
            },
            speed_error: phase_state.flight.track.speed_error(),
            spin: spin.unwrap_or(machine.spin),
            restitution: series.restitution(machine),
            clear_impacts: series.weight(),
        };
        match phase_state.phase {
            Phase::FreeFall | Phase::Impact if series.last().is_some() => {}
            Phase::Sliding | Phase::Rolling => {
                let contact = &phase_state.contact;
                let speed = contact.swing().rate * machine.clearance;
                let radius = machine.rotor_radius;
                // Against a ring that turns, or where it rolls, the slip is known and not the spin.
                if let Some(slip) = &contact.slip {
                    estimate.spin = (slip.speed - speed) / radius;
                } else if contact.kind == Some(EventKind::Rolling) {
                    estimate.spin = -speed / radius;
                }
                estimate.speed_error = contact.track.rate_spread() * machine.clearance;
                estimate.place = contact.place(speed, self.period);
            }
            _ => return None,
        }
        Some(estimate)
    }

    /// What the rotor goes through, for its severity.
    #[inline]
    pub(crate) fn strain<'a>(&self, phase_state: &'a PhaseState) -> Exposure<'a> {
        let (flight, contact) = (&phase_state.flight, &phase_state.contact);
        let (is_released, series) = (phase_state.phase >= Phase::FreeFall, &flight.series);
        if !phase_state.phase.is_contact() {
            return Exposure {
                is_released,
                speed: length(flight.track.velocity),
                speed_variance: flight.track.speed_variance(),
                contact_age: None,
                whirl: None,
                series,
            };
        }
        let (clearance, rate) = (self.machine.clearance, contact.swing().rate);
        Exposure {
            is_released,
            speed: clearance * rate.abs(),
            speed_variance: clearance * clearance * contact.track.rate_variance(),
            contact_age: Some(contact.age),
            whirl: contact.whirls().then_some(rate),
            series,
        }
    }

    /// Whether a rotor at `position`, m, may be at the wall.
    pub(crate) fn is_near(&self, position: [f32; 2]) -> bool {
        square(position, [0.0; 2]) >= self.near_square
    }

    /// Without a usable sample.
    pub(crate) fn skip(&self, phase_state: &mut PhaseState) {
        self.flight.skip(&mut phase_state.flight);
    }

    /// In flight: what the sample shows of the wall. It confirms a fall, unless the rotor was put down
    /// there from `centre` (m), where it would be, or was held by the magnets until then.
    pub(crate) fn land(
        &self,
        phase_state: &mut PhaseState,
        measurement: &Measurement,
        centre: [f32; 2],
        signals: &Signals,
        pending: &mut Option<Pending>,
        writer: &mut EventWriter,
    ) {
        let flight = &mut phase_state.flight;
        let open = (pending.as_ref()).map(|it| (it.since, centre));
        let landing = self.flight.take(flight, measurement, open);
        let is_off = signals.levitated == Some(false);
        if (is_off || landing.is_some())
            && let Some(open) = pending
        {
            let (age, impact) = (landing.as_ref()).map_or((0.0, None), |it| (it.age, it.impact));
            let fell = is_off || self.fell(open, age, impact, measurement, centre);
            writer.resolve(pending, fell);
        }
        let Some(Landing { age, impact }) = landing else {
            return;
        };
        if let Some(normal_speed) = impact {
            phase_state.phase = Phase::Impact;
            phase_state.still = Still::default();
            writer.declare(EventKind::Impact, age, normal_speed);
        } else {
            self.touch(phase_state, measurement, 0.05, age);
        }
    }

    /// Whether no caught disturbance goes from `centre` to `position`, m.
    pub(crate) fn is_far(&self, position: [f32; 2], centre: [f32; 2]) -> bool {
        square(position, centre) > self.travel_square
    }

    /// Whether a rotor that was taken to float at `home`, with `variance` on an axis (m^2), and is at `place` (m) has been lifted
    /// from there: it may have lain on a wall that was told wrong. An orbit of radius r has the variance r^2/2, and goes no
    /// farther than 2 r from any of its places.
    #[inline(never)]
    pub(crate) fn is_lifted(&self, place: [f32; 2], home: [f32; 2], variance: f32) -> bool {
        let way = square(place, home);
        let is_nearer = square(place, [0.0; 2]) < square(home, [0.0; 2]);
        let rises = self.machine.gravity == 0.0 || place[1] > home[1];
        way > self.travel_square && way > 8.0 * variance && is_nearer && rises
    }

    /// Whether a rotor that met the wall so many samples ago, with an impact (m/s) or without, fell there from where it would be,
    /// `centre` (m): faster than a controller puts one down, or than gravity makes it, as a fall that begins upward goes
    /// less far; or as far as one that falls. None that the magnets held until then fell.
    fn fell(
        &self,
        pending: &Pending,
        age: f32,
        impact: Option<f32>,
        measurement: &Measurement,
        centre: [f32; 2],
    ) -> bool {
        let time = measurement.now.since(pending.since) * self.period;
        let speed = FALLS * self.machine.gravity * time;
        let least = 0.5 * speed * time;
        let is_far = square(measurement.position, centre) >= least * least;
        let fell = is_far || impact > Some(LANDING_SPEED.min(speed));
        let blocks = 1.0 + age * self.period * (1.0 / BLOCK);
        fell && !pending.was_held(blocks as u32)
    }

    /// In flight: whether it floats again: clear of the wall, and still, or off the wall for longer than any flight.
    pub(crate) fn floats(&self, phase_state: &mut PhaseState, measurement: &Measurement) -> bool {
        let block = phase_state
            .still
            .take(measurement.position, self.still_samples);
        let clearance = self.machine.clearance;
        let quiet = block.filter(|block| {
            let (outward, radius) = direction(block.mean);
            let near = self.flight.near(&phase_state.flight, outward);
            radius < near
                && block.variance < 0.0625 * clearance * clearance
                && (block.moved < 0.02 * clearance
                    || self.machine.gravity > 0.0 && block.farthest < near * near)
        });
        quiet.is_some()
    }

    /// Tells that it floats again.
    pub(crate) fn tell_levitated(&self, writer: &mut EventWriter) {
        writer.declare(EventKind::Levitated, 2.0 * self.still_samples as f32, 0.0);
    }

    /// Into permanent contact, `age` samples old, from an unknown motion.
    pub(crate) fn lie(&self, phase_state: &mut PhaseState, measurement: &Measurement, age: f32) {
        self.touch(phase_state, measurement, UNKNOWN_SPEED, age);
    }

    fn touch(
        &self,
        phase_state: &mut PhaseState,
        measurement: &Measurement,
        spread: f32,
        age: f32,
    ) {
        let machine = &self.machine;
        let nominal = machine.rotor_radius * machine.spin;
        let slip_left = phase_state.flight.series.slip_left(nominal, machine);
        let velocity = (phase_state.flight.track.velocity, spread);
        let flight = &mut phase_state.flight;
        let lifted = flight.lifted.take();
        if let Some(it) = lifted.filter(|it| it.is_nearer_than(FALLS, self.period)) {
            flight.held = flight.held.max(it.depth);
        }
        let give = flight.give();
        self.flight.begin_contact(flight);
        phase_state.contact = self
            .contact
            .start(measurement, velocity, give, age, slip_left);
        phase_state.phase = Phase::Sliding;
    }

    /// In contact, of the rotor as a whole or of one end: what the sample shows.
    pub(crate) fn feel(
        &self,
        phase_state: &mut PhaseState,
        measurement: Option<&Measurement>,
        signals: &Signals,
        (disturbance, is_whole): (&Disturbance, bool),
    ) -> Findings {
        let is_rigid = is_whole && !phase_state.flight.gives;
        let contact = &mut phase_state.contact;
        let (wall, pull) = self.flight.seen_in_contact(&mut phase_state.flight);
        let measurement = measurement.map(|it| disturbance.on_wall(it, contact));
        let measurement = measurement.as_ref();
        self.contact
            .take(contact, wall, (pull, is_rigid), measurement, signals)
    }

    /// Tells what a sample in contact has shown, and goes on from there.
    #[inline(never)]
    pub(crate) fn go_on(
        &self,
        phase_state: &mut PhaseState,
        findings: Findings,
        measurement: Option<&Measurement>,
        disturbance: &Disturbance,
        writer: &mut EventWriter,
    ) {
        for (kind, age) in findings.into_iter().flatten() {
            match kind {
                EventKind::Sliding => phase_state.phase = Phase::Sliding,
                EventKind::Rolling => phase_state.phase = Phase::Rolling,
                EventKind::LiftOff => {
                    let wall = Some(phase_state.contact.lift.lately);
                    let wall = wall.filter(|&it| it >= self.contact.nearest);
                    self.flight.end_contact(&mut phase_state.flight, wall);
                    if let Some(measurement) = measurement {
                        let measurement = disturbance.on_wall(measurement, &phase_state.contact);
                        let threshold_scale = disturbance.threshold_scale;
                        self.fly(phase_state, &measurement, wall, threshold_scale);
                        let pressing = self
                            .contact
                            .normal_acceleration(phase_state.contact.swing());
                        let since = measurement.now.later(-age);
                        phase_state.flight.lifted = wall.map(|_| Lifted::new(since, pressing));
                    }
                }
                _ => {}
            }
            writer.declare(kind, age, 0.0);
        }
    }
}

impl Disturbance {
    /// A measurement on the wall, where the sensors waver.
    fn on_wall(&self, measurement: &Measurement, contact: &Touching) -> Measurement {
        let wavering = contact.lift.wavering();
        let most = wavering.map_or(f32::INFINITY, |it| WAVERING * it);
        Measurement {
            variance: measurement.variance.max(self.variance.min(most)),
            ..*measurement
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::config::Tuning;
    use crate::detect::series::tests::MACHINE;

    fn machine() -> PhaseMachine {
        let config = DetectorConfig {
            sample_rate: 20_000.0,
            machine: MACHINE,
            tuning: Tuning::default(),
        };
        PhaseMachine::new(&config, 25.3)
    }

    #[test]
    fn what_comes_up_and_nearer_to_the_centre_was_lifted() {
        let machine = machine();
        let at = |part: f32| [0.0, part * MACHINE.clearance];
        for (home, place, orbit, is_lifted) in [
            (-0.9, -0.7, 0.0, true),
            (-0.9, -0.8, 0.0, false),
            (0.3, 0.1, 0.0, false),
            (0.0, -0.5, 0.0, false),
            (-0.1, 0.15, 0.0, false),
            (-0.8, -0.3, 0.24, true),
            (-0.8, -0.3, 0.26, false),
        ] {
            let variance = 0.5 * square(at(orbit), [0.0; 2]);
            assert_eq!(
                machine.is_lifted(at(place), at(home), variance),
                is_lifted,
                "{home} {place}"
            );
        }
    }

    /// Half of gravity's way is a fall, less is none.
    #[test]
    fn what_goes_half_as_far_as_gravity_takes_it_fell() {
        let machine = machine();
        let pending = Pending {
            number: 0,
            since: Moment::of_sample(1_000),
            declared: Moment::of_sample(1_010),
            ..Pending::default()
        };
        let way = 0.5 * MACHINE.gravity * 0.005 * 0.005;
        let fell = |part: f32| {
            let measurement = Measurement {
                now: Moment::of_sample(1_100),
                position: [0.0, -part * way],
                variance: 1e-12,
                spin: 0.0,
            };
            machine.fell(&pending, 0.0, None, &measurement, [0.0; 2])
        };
        assert!(fell(0.6) && !fell(0.4));
    }

    /// Turns done when a whirl of 100 turns a second against the spin is told.
    fn turns_when_told(is_whole: bool, gives: bool) -> f32 {
        let machine = machine();
        let turns = |k: u16| -MACHINE.spin.signum() * 5e-3 * f32::from(k);
        let measurement = |k: u16| {
            let (sin, cos) = libm::sincosf(core::f32::consts::TAU * turns(k));
            Measurement {
                now: Moment::of_sample(k.into()),
                position: [MACHINE.clearance * sin, -MACHINE.clearance * cos],
                variance: 1e-12,
                spin: 0.0,
            }
        };
        let mut phase_state = PhaseState::default();
        machine.lie(&mut phase_state, &measurement(0), 0.0);
        phase_state.flight.gives = gives;
        let disturbance = Disturbance {
            threshold_scale: 1.0,
            variance: 1e-12,
        };
        let whirl = (1..2_000).find(|&k| {
            let sample = Some(measurement(k));
            let signals = Signals::default();
            let of_it = (&disturbance, is_whole);
            let found = machine.feel(&mut phase_state, sample.as_ref(), &signals, of_it);
            let kinds = found.iter().flatten();
            kinds
                .map(|it| it.0)
                .any(|kind| kind == EventKind::BackwardWhirl)
        });
        turns(whirl.expect("it is told")).abs()
    }

    #[test]
    fn a_whirl_of_one_end_or_on_a_wall_that_gives_way_is_told_after_its_turn() {
        assert!(turns_when_told(true, false) < 0.25);
        for (is_whole, gives) in [(false, false), (true, true)] {
            let turns = turns_when_told(is_whole, gives);
            assert!((0.95..1.05).contains(&turns), "{is_whole} {gives}: {turns}");
        }
    }
}
