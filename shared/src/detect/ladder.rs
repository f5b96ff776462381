//! The phase ladder: which phase the tests make, and what to tell of it.

use crate::detect::config::DetectorConfig;
use crate::detect::contact::{ContactTest, Finding, Kind, Regime, Touching};
use crate::detect::flight::{
    Airborne, Fix, FlightTest, Landing, Listener, UNKNOWN_SPEED, direction,
};
use crate::detect::levitation::{Learning, Levitation};
use crate::detect::noise::Noise;
use crate::detect::release::{Release, ReleaseBank};
use crate::detect::still::Still;
use crate::detect::teller::{Pending, Teller};
use crate::error::ConfigError;
use crate::event::{EventKind, Moment, Notices, Plane};
use crate::sensing::Reading;

/// Standard deviations within which a caught rotor has come back.
const CAUGHT: f32 = 4.0;
/// Standard deviations by which a rotor has moved for certain.
const MOVED: f32 = 8.0;
/// Angle beyond that of friction, rad, up to which a rotor at the wall may lie there still.
const RESTING_ANGLE: f32 = 0.1;

/// Phase of the rotor.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Phase {
    /// Switched on, not judged yet.
    #[default]
    Starting = 0,
    /// Floating.
    Levitated = 1,
    /// In flight, before the first impact or after a lift-off.
    FreeFall = 2,
    /// Between impacts.
    Impact = 3,
    /// Permanent contact with slip, or not yet known.
    Sliding = 4,
    /// Permanent contact without.
    Rolling = 5,
}

/// Coefficients.
#[derive(Clone, Copy, Debug)]
pub struct Detector {
    config: DetectorConfig,
    resolution: f32,
    /// Radius from which on the rotor may be at the wall, m.
    near: f32,
    learning: Learning,
    release: Release,
    flight: FlightTest,
    contact: ContactTest,
    start_samples: u32,
    still_samples: u32,
    catch_samples: u32,
}

/// What the detector carries from sample to sample.
#[derive(Clone, Copy, Debug, Default)]
pub struct DetectorState {
    sample: u64,
    next_number: u16,
    phase: Phase,
    noise: Noise,
    levitation: Levitation,
    release: ReleaseBank,
    pending: Option<Pending>,
    flight: Airborne,
    listener: Listener,
    contact: Touching,
    still: Still,
    /// First position, m, and whether the rotor has been at the wall since.
    origin: Option<[f32; 2]>,
    off_wall: bool,
    /// Channels whose fault has been told.
    faulty: u8,
}

impl Detector {
    /// Checks `config`; `resolution` is the displacement of one count, m.
    pub fn try_new(config: &DetectorConfig, resolution: f32) -> Result<Self, ConfigError> {
        config.validate()?;
        let rate = config.sample_rate;
        let tuning = &config.tuning;
        let threshold = -libm::logf(tuning.false_alarm);
        let samples = |time: f32| (time * rate).max(1.0) as u32;
        Ok(Self {
            config: *config,
            resolution,
            near: config.machine.clearance * (1.0 - tuning.wall_tolerance),
            learning: Learning::new(tuning, rate),
            release: Release::new(tuning, rate, config.machine.gravity, threshold),
            flight: FlightTest::new(config, threshold),
            contact: ContactTest::new(config, threshold),
            start_samples: samples(0.2 * tuning.still_time).max(64),
            still_samples: samples(tuning.still_time).max(16),
            catch_samples: samples(tuning.catch_time),
        })
    }

    /// One tick. Bounded; cannot fail.
    pub fn update(
        &self,
        state: &mut DetectorState,
        reading: &Reading,
        spin: Option<f32>,
        levitated: Option<bool>,
        notices: &mut Notices,
    ) {
        let sample = state.sample;
        state.sample += 1;
        let mut next_number = state.next_number;
        let mut teller = Teller {
            sample,
            plane: match reading.planes {
                [Some(_), None] => Plane::A,
                [None, Some(_)] => Plane::B,
                _ => Plane::Both,
            },
            next_number: &mut next_number,
            notices,
        };
        self.faults(state, reading, &mut teller);
        let fix = reading.mean().map(|(position, planes)| {
            state.noise.take(position, planes);
            Fix {
                now: Moment::of_sample(sample),
                position,
                variance: state.noise.variance(planes, self.resolution),
            }
        });
        if fix.is_none() {
            state.noise.skip();
        }
        let fix = fix.filter(|_| state.noise.is_known());
        match state.phase {
            Phase::Starting => {
                if let Some(fix) = fix {
                    self.starting(state, &fix);
                }
            }
            Phase::Levitated => {
                if let Some(fix) = fix {
                    self.levitated(state, &fix, levitated, &mut teller);
                }
            }
            Phase::FreeFall | Phase::Impact => match fix {
                Some(fix) => self.airborne(state, &fix, levitated, &mut teller),
                None => self.flight.skip(&mut state.flight),
            },
            Phase::Sliding | Phase::Rolling => {
                self.touching(state, fix.as_ref(), spin, &mut teller);
            }
        }
        state.next_number = next_number;
    }

    fn faults(&self, state: &mut DetectorState, reading: &Reading, teller: &mut Teller) {
        let new = reading.unusable & !state.faulty;
        state.faulty = reading.unusable;
        if new != 0 {
            let plane = teller.plane;
            teller.plane = match (new & 0b0011 != 0, new & 0b1100 != 0) {
                (true, false) => Plane::A,
                (false, true) => Plane::B,
                _ => Plane::Both,
            };
            teller.tell(EventKind::SensorFault, 0.0, 0.0);
            teller.plane = plane;
        }
    }

    /// Switched on: floats, or lies on the wall already. What moves along the wall is in contact; what
    /// keeps still there is, if it could lie there.
    fn starting(&self, state: &mut DetectorState, fix: &Fix) {
        let (outward, radius) = direction(fix.position);
        let machine = &self.config.machine;
        state.off_wall |= radius < self.near;
        self.learning.take(&mut state.levitation, fix.position);
        let origin = *state.origin.get_or_insert(fix.position);
        let moved = square(fix.position, origin) > MOVED * MOVED * fix.variance;
        let since_start = state.sample.saturating_sub(1) as f32;
        if state.off_wall {
            state.phase = Phase::Levitated;
        } else if moved {
            self.touch(state, fix, UNKNOWN_SPEED, since_start);
        } else if state.sample >= u64::from(self.start_samples) {
            let lies = outward[0].abs() <= -outward[1] * (machine.friction + RESTING_ANGLE);
            if lies || machine.gravity == 0.0 {
                self.touch(state, fix, UNKNOWN_SPEED, since_start);
            } else {
                state.phase = Phase::Levitated;
            }
        }
    }

    fn levitated(
        &self,
        state: &mut DetectorState,
        fix: &Fix,
        levitated: Option<bool>,
        teller: &mut Teller,
    ) {
        self.learning.take(&mut state.levitation, fix.position);
        if state.levitation.is_fresh() {
            // It still moved: what the tests learnt of it goes as well.
            state.listener = Listener::default();
            state.release = ReleaseBank::default();
        }
        let [x, y] = state.levitation.mean;
        let residual = [fix.position[0] - x, fix.position[1] - y];
        let variance = state.levitation.variance.max(fix.variance);
        if !self.learning.has_position(&state.levitation) {
            self.flight.listen(&mut state.listener, fix);
        }
        let released = self
            .learning
            .has_position(&state.levitation)
            .then(|| self.release.take(&mut state.release, residual, variance))
            .flatten();
        if !state.levitation.is_armed() {
            // Fell before anything was learnt: the wall shows it.
            let (_, radius) = direction(fix.position);
            if state.off_wall && radius >= self.near {
                state.flight = self.flight.start(fix, None, state.listener.loudness());
                state.phase = Phase::FreeFall;
                state.still = Still::default();
            }
            return;
        }
        let Some(age) = released else {
            return;
        };
        state.flight = self.flight.start(fix, None, state.listener.loudness());
        state.phase = Phase::FreeFall;
        state.still = Still::default();
        let number = teller.tell(EventKind::FreeFall, f32::from(age), 0.0);
        state.pending = Some(Pending { number, back: 0 });
        if levitated == Some(false) {
            teller.close(&mut state.pending, true);
        }
    }

    fn airborne(
        &self,
        state: &mut DetectorState,
        fix: &Fix,
        levitated: Option<bool>,
        teller: &mut Teller,
    ) {
        let landing = self.flight.take(&mut state.flight, fix);
        if landing.is_some() || levitated == Some(false) {
            teller.close(&mut state.pending, true);
        }
        match landing {
            Some(Landing::Impact { age, normal_speed }) => {
                state.phase = Phase::Impact;
                state.still = Still::default();
                teller.tell(EventKind::Impact, age, normal_speed);
            }
            Some(Landing::Contact { age }) => {
                self.touch(state, fix, 0.05, age);
                return;
            }
            None => {}
        }
        self.caught(state, fix, teller);
        let block = state.still.take(fix.position, self.still_samples);
        let clearance = self.config.machine.clearance;
        let quiet = block.filter(|block| {
            let (_, radius) = direction(block.mean);
            radius < self.near
                && block.variance < 0.0625 * clearance * clearance
                && block.moved < 0.02 * clearance
        });
        if quiet.is_some() {
            teller.close(&mut state.pending, false);
            state.phase = Phase::Levitated;
            state.levitation = Levitation::default();
            state.listener = Listener::default();
            state.release = ReleaseBank::default();
            teller.tell(EventKind::Levitated, 2.0 * self.still_samples as f32, 0.0);
        }
    }

    /// Confirms a fall that goes too far to be a caught disturbance; withdraws one that came back.
    fn caught(&self, state: &mut DetectorState, fix: &Fix, teller: &mut Teller) {
        let Some(pending) = &mut state.pending else {
            return;
        };
        let travel = self.config.tuning.confirm_travel * self.config.machine.clearance;
        let home = state.levitation.mean;
        if square(state.flight.track.position, home) > travel * travel {
            teller.close(&mut state.pending, true);
            return;
        }
        let near = CAUGHT * CAUGHT * state.levitation.variance.max(fix.variance);
        if square(fix.position, home) > near {
            pending.back = 0;
            return;
        }
        pending.back += 1;
        if pending.back >= self.catch_samples {
            teller.close(&mut state.pending, false);
            state.release.restart();
            state.phase = Phase::Levitated;
        }
    }

    /// Into permanent contact, `age` samples old.
    fn touch(&self, state: &mut DetectorState, fix: &Fix, spread: f32, age: f32) {
        let machine = &self.config.machine;
        let nominal = machine.rotor_radius * machine.spin;
        let slip_left = state.flight.series.slip_left(nominal, machine);
        state.contact =
            self.contact
                .start(fix, state.flight.track.velocity, spread, age, slip_left);
        state.phase = Phase::Sliding;
    }

    fn touching(
        &self,
        state: &mut DetectorState,
        fix: Option<&Fix>,
        spin: Option<f32>,
        teller: &mut Teller,
    ) {
        // On the wall, what else moves the sensors is there as it was while levitated.
        let fix = fix.map(|fix| Fix {
            variance: fix.variance.max(state.levitation.learnt_variance()),
            ..*fix
        });
        let fix = fix.as_ref();
        for finding in self
            .contact
            .take(&mut state.contact, fix, spin)
            .into_iter()
            .flatten()
        {
            let (kind, age) = match finding {
                Finding::Kind(Kind::Sliding, age) => {
                    state.phase = Phase::Sliding;
                    (EventKind::Sliding, age)
                }
                Finding::Kind(Kind::Rolling, age) => {
                    state.phase = Phase::Rolling;
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
                    if let Some(fix) = fix {
                        state.flight = self.flight.start(
                            fix,
                            Some(state.contact.wall()),
                            state.listener.loudness(),
                        );
                    }
                    state.phase = Phase::FreeFall;
                    state.still = Still::default();
                    (EventKind::LiftOff, age)
                }
            };
            teller.tell(kind, age, 0.0);
        }
    }
}

impl DetectorState {
    /// The present phase.
    pub fn phase(&self) -> Phase {
        self.phase
    }

    /// Whether noise and position have been learnt.
    pub fn is_armed(&self) -> bool {
        self.levitation.is_armed()
    }

    /// Hands out the words that every tick's outcome depends on.
    pub(crate) fn fingerprint(&self, mut put: impl FnMut(u32)) {
        put(self.phase as u32);
        put(u32::from(self.next_number));
        let flight = &self.flight.track;
        let wall = &self.contact.track;
        let floats = [
            self.levitation.mean[0],
            self.levitation.mean[1],
            self.levitation.variance,
            self.release.statistic,
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
        ];
        for value in floats {
            // The bits of a NaN differ between machines that agree on everything else.
            put(if value.is_nan() {
                0x7fc0_0000
            } else {
                value.to_bits()
            });
        }
    }
}

fn square(a: [f32; 2], b: [f32; 2]) -> f32 {
    let (dx, dy) = (a[0] - b[0], a[1] - b[1]);
    dx * dx + dy * dy
}
