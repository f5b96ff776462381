//! The phase ladder from the release on: flight, impacts, permanent contact, and what to tell of them.
//!
//! The rotor as a whole has one; so has each end while the two move apart.

use crate::config::{DetectorConfig, MachineConfig};
use crate::detect::contact::{ContactTest, Finding, Regime, Touching};
use crate::detect::estimate::{Estimate, Place};
use crate::detect::fix::Fix;
use crate::detect::flight::{Airborne, FlightTest, Landing, UNKNOWN_SPEED};
use crate::detect::levitation::Levitation;
use crate::detect::signals::Signals;
use crate::detect::slip::Kind;
use crate::detect::still::Still;
use crate::detect::strain::Strain;
use crate::detect::teller::{Pending, Teller};
use crate::event::{EventKind, Moment};
use crate::phase::Phase;
use crate::vector::{direction, square};
use touchdown_rotor::real::sqrt;

/// Standard deviations within which a caught rotor has come back.
const CAUGHT: f32 = 4.0;
/// Part of gravity's way that is less than any fall goes, whatever forces are left.
const FALLS: f32 = 0.5;
/// Faster than a controller puts a rotor down, m/s.
const LANDING_SPEED: f32 = 0.01;

/// Coefficients.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Ladder {
    machine: MachineConfig,
    /// Radius from which on the rotor may be at the wall, m.
    pub(crate) near: f32,
    /// Way that no caught disturbance goes, m.
    travel: f32,
    /// s.
    period: f32,
    flight: FlightTest,
    contact: ContactTest,
    still_samples: u32,
    catch_samples: u32,
}

/// Where on the ladder it is.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Rungs {
    pub(crate) phase: Phase,
    pub(crate) flight: Airborne,
    pub(crate) contact: Touching,
    pub(crate) still: Still,
}

/// How a declared fall stands.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Fall {
    Open,
    /// No caught disturbance goes so far.
    Certain,
    /// It came back.
    Caught,
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

impl Rungs {
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

impl Ladder {
    /// `config` must be valid.
    pub(crate) fn new(config: &DetectorConfig, threshold: f32) -> Self {
        let (machine, tuning) = (config.machine, &config.tuning);
        let samples = |time: f32| (time * config.sample_rate).max(1.0) as u32;
        Self {
            machine,
            near: machine.clearance * (1.0 - tuning.wall_tolerance),
            travel: tuning.confirm_travel * machine.clearance,
            period: 1.0 / config.sample_rate,
            flight: FlightTest::new(config, threshold),
            contact: ContactTest::new(config, threshold),
            still_samples: samples(tuning.still_time).max(16),
            catch_samples: samples(tuning.catch_time),
        }
    }

    /// Into flight, from lying on a wall at the radius `wall` (m) where it lifted off.
    pub(crate) fn fly(&self, rungs: &mut Rungs, fix: &Fix, wall: Option<f32>, loudness: f32) {
        self.flight.start(&mut rungs.flight, fix, wall, loudness);
        rungs.phase = Phase::FreeFall;
        rungs.still = Still::default();
    }

    /// One end, `fix`, goes on from the rotor as a whole; where that lies on the wall, the end does so `wall` (m)
    /// farther out.
    pub(crate) fn part(
        &self,
        rungs: &mut Rungs,
        rotor: &Rungs,
        fix: &Fix,
        wall: f32,
        loudness: f32,
    ) {
        rungs.phase = rotor.phase;
        if rotor.phase.is_contact() {
            rungs.flight.follow(&rotor.flight);
            rungs.contact = rotor.contact.at_one_end(wall);
            rungs.still = rotor.still;
        } else {
            (self.flight).part(&mut rungs.flight, &rotor.flight, fix, loudness);
            rungs.contact = rotor.contact;
            rungs.still = Still::default();
        }
    }

    /// The rotor at `at` for a forecast, once it has met the wall; `spin` (rad/s) as measured.
    pub(crate) fn estimate(
        &self,
        rungs: &Rungs,
        at: Moment,
        spin: Option<f32>,
    ) -> Option<Estimate> {
        let machine = &self.machine;
        let series = &rungs.flight.series;
        let mut estimate = Estimate {
            at,
            place: Place::Air {
                position: rungs.flight.track.position,
                velocity: rungs.flight.track.velocity,
            },
            speed_error: rungs.flight.track.speed_error(),
            spin: spin.unwrap_or(machine.spin),
            restitution: series.restitution(machine),
            clear_impacts: series.weight(),
        };
        match rungs.phase {
            Phase::FreeFall | Phase::Impact if series.last().is_some() => {}
            Phase::Sliding | Phase::Rolling => {
                let contact = &rungs.contact;
                let speed = contact.swing().rate * machine.clearance;
                let radius = machine.rotor_radius;
                // Against a ring that turns, or where it rolls, the slip is known and not the spin.
                if let Some(slip) = &contact.slip {
                    estimate.spin = (slip.speed - speed) / radius;
                } else if contact.kind == Some(Kind::Rolling) {
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
    pub(crate) fn strain(&self, rungs: &Rungs) -> Strain {
        let (track, contact) = (&rungs.flight.track, &rungs.contact);
        let clearance = self.machine.clearance;
        let [u, v] = track.velocity;
        let mut strain = Strain {
            is_released: rungs.phase >= Phase::FreeFall,
            speed: sqrt(u * u + v * v),
            speed_error: track.speed_error(),
            restitution: rungs.flight.series.restitution(&self.machine),
            ahead: rungs.flight.series.yet_to_come(&self.machine),
            ..Strain::default()
        };
        if rungs.phase.is_contact() {
            let rate = contact.swing().rate;
            strain.speed = clearance * rate.abs();
            strain.speed_error = clearance * contact.track.rate_spread();
            strain.contact_age = Some(contact.age());
            strain.whirl = contact.whirls().then_some(rate);
        }
        strain
    }

    /// Whether it may be at the wall.
    pub(crate) fn is_near(&self, fix: &Fix) -> bool {
        direction(fix.position).1 >= self.near
    }

    /// Without a usable sample.
    pub(crate) fn skip(&self, rungs: &mut Rungs) {
        self.flight.skip(&mut rungs.flight);
    }

    /// In flight: what the sample shows of the wall. It confirms a fall, unless the rotor was put down
    /// there from its place `home`, m.
    pub(crate) fn land(
        &self,
        rungs: &mut Rungs,
        fix: &Fix,
        home: [f32; 2],
        signals: &Signals,
        pending: &mut Option<Pending>,
        teller: &mut Teller,
    ) {
        let landing = self.flight.take(&mut rungs.flight, fix);
        if signals.levitated == Some(false) {
            teller.close(pending, true);
        }
        if let (Some(landing), Some(open)) = (&landing, pending.as_ref()) {
            let fell =
                landing.speed() > LANDING_SPEED || self.fell(open, fix.now, fix.position, home);
            teller.close(pending, fell);
        }
        match landing {
            Some(Landing::Impact { age, normal_speed }) => {
                rungs.phase = Phase::Impact;
                rungs.still = Still::default();
                teller.tell(EventKind::Impact, age, normal_speed);
            }
            Some(Landing::Contact { age }) => self.touch(rungs, fix, 0.05, age),
            None => {}
        }
    }

    /// Whether a fall goes too far to be a caught disturbance, or has come back.
    pub(crate) fn fall(
        &self,
        rungs: &Rungs,
        fix: &Fix,
        levitation: &Levitation,
        pending: &mut Pending,
    ) -> Fall {
        let home = levitation.mean;
        let at = rungs.flight.track.position;
        if self.is_far(at, home) && self.fell(pending, fix.now, at, home) {
            return Fall::Certain;
        }
        let variance = levitation.variance;
        if self.is_caught(pending, is_home(fix, home, variance), variance) {
            return Fall::Caught;
        }
        Fall::Open
    }

    /// Takes whether the rotor is where it floated, with this variance (m^2); whether it has been for long enough.
    pub(crate) fn is_caught(&self, pending: &mut Pending, is_home: bool, variance: f32) -> bool {
        pending.back = if is_home { pending.back + 1 } else { 0 };
        pending.back >= self.catch_samples && !self.may_fall_for(pending.back, variance)
    }

    /// Whether a rotor that was thrown up, and falls, may be within noise of home for so many samples: one that goes
    /// through a circle of radius r from below and back is in it for up to 4 sqrt(r/g).
    fn may_fall_for(&self, samples: u32, variance: f32) -> bool {
        let time = samples as f32 * self.period;
        let way = self.machine.gravity * time * time / 16.0;
        way * way < CAUGHT * CAUGHT * variance && way > 0.0
    }

    /// Whether no caught disturbance goes from `home` to `position`, m.
    pub(crate) fn is_far(&self, position: [f32; 2], home: [f32; 2]) -> bool {
        square(position, home) > self.travel * self.travel
    }

    /// Whether a rotor that went from `home` to `at` (m) since the fall was declared went as fast as one
    /// that falls.
    pub(crate) fn fell(
        &self,
        pending: &Pending,
        now: Moment,
        at: [f32; 2],
        home: [f32; 2],
    ) -> bool {
        let time = now.since(pending.since) * self.period;
        let least = FALLS * 0.5 * self.machine.gravity * time * time;
        square(at, home) >= least * least
    }

    /// In flight: whether it floats again, clear of the wall and quiet.
    pub(crate) fn floats(&self, rungs: &mut Rungs, fix: &Fix) -> bool {
        let block = rungs.still.take(fix.position, self.still_samples);
        let clearance = self.machine.clearance;
        let quiet = block.filter(|block| {
            let (_, radius) = direction(block.mean);
            radius < self.near
                && block.variance < 0.0625 * clearance * clearance
                && block.moved < 0.02 * clearance
        });
        quiet.is_some()
    }

    /// Tells that it floats again.
    pub(crate) fn tell_levitated(&self, teller: &mut Teller) {
        teller.tell(EventKind::Levitated, 2.0 * self.still_samples as f32, 0.0);
    }

    /// Into permanent contact, `age` samples old, from an unknown motion.
    pub(crate) fn lie(&self, rungs: &mut Rungs, fix: &Fix, age: f32) {
        self.touch(rungs, fix, UNKNOWN_SPEED, age);
    }

    fn touch(&self, rungs: &mut Rungs, fix: &Fix, spread: f32, age: f32) {
        let machine = &self.machine;
        let nominal = machine.rotor_radius * machine.spin;
        let slip_left = rungs.flight.series.slip_left(nominal, machine);
        let velocity = rungs.flight.track.velocity;
        rungs.contact = self.contact.start(fix, velocity, spread, age, slip_left);
        rungs.phase = Phase::Sliding;
    }

    /// In contact; `whose` says whose lift-off it would be. False where it is that of one end: nothing is
    /// told then.
    pub(crate) fn touching(
        &self,
        rungs: &mut Rungs,
        fix: Option<&Fix>,
        signals: &Signals,
        loudness: f32,
        whose: impl FnOnce(&Touching) -> Lifting,
        teller: &mut Teller,
    ) -> bool {
        let findings = self.contact.take(&mut rungs.contact, fix, signals);
        let lifting = whose(&rungs.contact);
        if matches!(findings, [Some(Finding::LiftOff(_)), _]) && lifting != Lifting::Both {
            return lifting == Lifting::Unclear;
        }
        for finding in findings.into_iter().flatten() {
            let (kind, age) = match finding {
                Finding::Kind(Kind::Sliding, age) => {
                    rungs.phase = Phase::Sliding;
                    (EventKind::Sliding, age)
                }
                Finding::Kind(Kind::Rolling, age) => {
                    rungs.phase = Phase::Rolling;
                    (EventKind::Rolling, age)
                }
                Finding::Regime(regime, age) => match regime {
                    Regime::Unknown => continue,
                    Regime::Rest => (EventKind::Rest, age),
                    Regime::Pendulum => (EventKind::Pendulum, age),
                    Regime::ForwardWhirl => (EventKind::ForwardWhirl, age),
                    Regime::BackwardWhirl => (EventKind::BackwardWhirl, age),
                },
                Finding::LiftOff(age) => {
                    let wall = rungs.contact.wall();
                    if let Some(fix) = fix {
                        self.fly(rungs, fix, Some(wall), loudness);
                    }
                    (EventKind::LiftOff, age)
                }
            };
            teller.tell(kind, age, 0.0);
        }
        true
    }
}

/// Whether `fix` is within noise of `home` (m), around which the rotor floats with this variance (m^2).
pub(crate) fn is_home(fix: &Fix, home: [f32; 2], variance: f32) -> bool {
    square(fix.position, home) <= CAUGHT * CAUGHT * variance.max(fix.variance)
}
