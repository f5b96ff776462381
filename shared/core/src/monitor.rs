//! The whole tick: the guard, sensing, the sensors' health, then the detector.

use crc::Digest;

use crate::checksum::CRC;
use crate::detect::{Detector, DetectorConfig, DetectorState, Phase, Retainer, Signals, bits};
use crate::event::{Notice, Notices};
use crate::forecast::{ForecastInput, ForecastTask};
use crate::guard::{Guard, GuardConfig, GuardState};
use crate::health::{Condition, Health, HealthState};
use crate::sample::{CHANNELS, Sample};
use crate::sensing::{PLANES, PlanePositions, Reading, Sensing, SensingConfig, mean};
use crate::severity::{SeverityModel, SeverityState};
use crate::spin::{SpinCheck, SpinState};
use crate::tachometer::{Speed, Tachometers, TachometersConfig, TachometersState};
use crate::touch::{TouchState, Touches};
use touchdown_rotor::error::ConfigError;

/// All that the monitor is told.
#[derive(Clone, Copy, Debug, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct MonitorConfig {
    /// Bit i is set if channel i is fitted.
    pub fitted: u8,
    /// Counts to displacement.
    pub sensing: SensingConfig,
    /// Pulses to the inner ring's speed, where the retainer is a ball bearing that is watched.
    pub tachometers: Option<TachometersConfig>,
    /// Displacement to events.
    pub detector: DetectorConfig,
    /// Displacement to alarms, touches and proof of levitation.
    pub guard: GuardConfig,
    /// Whether a commissioning check is on record. A machine without weight across its axis is not proven to float
    /// without one.
    pub commissioned: bool,
}

/// Coefficients of the tick.
#[derive(Clone, Debug)]
pub struct Monitor {
    guard: Guard,
    touches: Touches,
    sensing: Sensing,
    health: Health,
    spin: SpinCheck,
    tachometers: Option<Tachometers>,
    detector: Detector,
    severeness: SeverityModel,
}

/// What the sensors say in a tick.
pub type Seen = (Reading, Signals);

/// What the tick carries from sample to sample; by default that before the first one.
#[derive(Clone, Debug, Default)]
pub struct MonitorState {
    /// Samples seen.
    pub samples: u64,
    /// Channel values that were unusable, or not used.
    pub faults: u64,
    /// Of the guard, as it sees the last sample.
    pub guard: GuardState,
    /// Of the touches, whatever held the rotor.
    pub touch: TouchState,
    /// What is known of the sensors.
    pub health: HealthState,
    pub(crate) tachometers: TachometersState,
    planes: PlanePositions,
    /// Whether a channel that is fitted gave no value of its own.
    pub lacks: bool,
    /// Speed of the ball bearing's inner ring, where known.
    pub inner_ring: Option<Speed>,
    /// Phase, motion and slip of the rotor.
    pub detector: DetectorState,
    pub(crate) spin: SpinState,
    pub(crate) levitated: Option<bool>,
    /// What the last drop has done to the machine so far; zeros before the first.
    pub severity: SeverityState,
}

/// What a whole run adds up to.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Summary {
    /// Samples seen.
    pub samples: u64,
    /// Channel values that were unusable, or not used.
    pub faults: u64,
    /// What can be had of each channel at the end.
    pub conditions: [Condition; CHANNELS],
    /// Fingerprint of the detector's state over all ticks.
    pub state_hash: u32,
}

impl Monitor {
    /// Checks `config` and prepares the tick.
    pub fn try_new(config: &MonitorConfig) -> Result<Self, ConfigError> {
        let detector = &config.detector;
        let (clearance, rate) = (detector.machine.clearance, detector.sample_rate);
        let tachometers = config.tachometers;
        let tachometers = tachometers.map(|it| Tachometers::try_new(&it, rate));
        Ok(Self {
            sensing: Sensing::try_new(&config.sensing)?,
            tachometers: tachometers.transpose()?,
            detector: Detector::try_new(detector, &config.sensing)?,
            health: Health::new(detector, &config.sensing, config.fitted),
            spin: SpinCheck::new(detector),
            severeness: SeverityModel::new(detector),
            touches: Touches::new(clearance, rate),
            guard: Guard::try_new(&config.guard, detector, config.fitted, config.commissioned)?,
        })
    }

    /// The state before the first sample.
    pub fn start(&self) -> MonitorState {
        MonitorState::default()
    }

    /// One tick: what it has to say. Bounded; cannot fail.
    pub fn update(&self, state: &mut MonitorState, sample: &Sample) -> Notices {
        let mut notices = Notices::new();
        self.take(state, sample, false, &mut notices);
        notices
    }

    /// Likewise, with a place for what it has to say: they are half a kilobyte, which a tick has no time to copy. A sample
    /// that was `missed` was never taken: time goes on, and no sensor is blamed.
    #[inline]
    pub fn take(
        &self,
        state: &mut MonitorState,
        sample: &Sample,
        missed: bool,
        notices: &mut Notices,
    ) {
        let places = self.guard(state, sample);
        self.tell(state, &places, sample, notices);
        let seen = if missed {
            self.miss(state, sample)
        } else {
            self.sense(state, sample)
        };
        self.detect(state, &seen, notices);
        self.update_severity(state, notices);
    }

    /// First part of a tick: the guard, on what the sensors say, believed or not; each plane's place, m.
    #[inline]
    pub fn guard(&self, state: &mut MonitorState, sample: &Sample) -> [Option<[f32; 2]>; PLANES] {
        let places = self.sensing.planes(sample);
        self.guard
            .update(&mut state.guard, places, sample.levitated);
        places
    }

    /// Second part: proof, alarms and touches. What was in `notices` goes.
    #[inline]
    pub fn tell(
        &self,
        state: &mut MonitorState,
        places: &[Option<[f32; 2]>; PLANES],
        sample: &Sample,
        notices: &mut Notices,
    ) {
        notices.clear();
        let number = state.samples;
        // No proof comes from a machine of which a sensor does not work.
        let believed = if state.lacks { &[None; PLANES] } else { places };
        let guard = &mut state.guard;
        self.guard.follow(guard, believed, sample, number, notices);
        self.touches
            .update(&mut state.touch, places, number, notices);
    }

    /// Third part: what the sensors say, and whether they can be believed.
    #[inline]
    pub fn sense(&self, state: &mut MonitorState, sample: &Sample) -> Seen {
        let contact = (state.detector.phases(), state.detector.wall_gives());
        let reading = self.health.update(
            &mut state.health,
            &self.sensing,
            sample,
            contact,
            &state.touch,
        );
        let spin = &mut state.spin;
        let (is_unused, spin_fault) = self.spin.update(spin, sample.spin, state.samples);
        state.faults += u64::from(is_unused);
        state.levitated = sample.levitated;
        let signals = Signals {
            spin_fault,
            ..self.signals(state, sample)
        };
        state.planes = if reading.is_own() {
            reading.planes
        } else {
            [None; PLANES]
        };
        state.lacks = reading.unusable != 0;
        if state.lacks {
            state.faults += u64::from(reading.unusable.count_ones());
        }
        (reading, signals)
    }

    /// In place of the third part, of a sample that was never taken.
    #[inline(never)]
    fn miss(&self, state: &mut MonitorState, missed: &Sample) -> Seen {
        state.planes = [None; PLANES];
        (Reading::default(), self.signals(state, missed))
    }

    /// What the detector is told of a sample beside the position; then the next one is due.
    #[inline]
    fn signals(&self, state: &mut MonitorState, sample: &Sample) -> Signals {
        let spin = state.spin.believed;
        let mut retainer = Retainer::Fixed;
        if let Some(tachometers) = &self.tachometers {
            let rings = &mut state.tachometers;
            state.inner_ring = tachometers.update(rings, state.samples, &sample.edges);
            if let Some(spin) = spin {
                let bore = state.inner_ring.map(|speed| tachometers.bore(speed, spin));
                retainer = Retainer::Turning(bore);
            }
        }
        state.samples += 1;
        Signals {
            spin,
            retainer,
            levitated: sample.levitated,
            spin_fault: None,
        }
    }

    /// Fourth part: the detector.
    #[inline]
    pub fn detect(&self, state: &mut MonitorState, seen: &Seen, notices: &mut Notices) {
        let (reading, signals) = seen;
        self.detector
            .update(&mut state.detector, reading, signals, notices);
    }

    /// Last part: what it does to the machine.
    #[inline]
    pub fn update_severity(&self, state: &mut MonitorState, notices: &[Notice]) {
        // A rotor that floats goes through nothing.
        if !state.severity.was_released && state.detector.phase() < Phase::FreeFall {
            return;
        }
        let strain = self.detector.strain(&state.detector);
        self.severeness.take(&mut state.severity, &strain, notices);
    }

    /// What the forecast below the tick needs of the last one; an estimate only where it `asks` for one.
    pub fn forecast_input(&self, state: &MonitorState, wants_input: bool) -> ForecastInput {
        let is_released = state.detector.phase() >= Phase::FreeFall;
        let rests = state.detector.rests();
        let estimate = if wants_input && is_released && !rests {
            self.detector.estimate(&state.detector, state.spin.believed)
        } else {
            None
        };
        ForecastInput {
            sample: state.samples.saturating_sub(1),
            is_released,
            rests,
            estimate,
        }
    }

    /// A slice of the forecast after a tick, where the two take turns.
    pub fn look(&self, state: &MonitorState, forecast_task: &mut ForecastTask) -> Option<Notice> {
        forecast_task.work(&self.forecast_input(state, forecast_task.wants_input()))
    }
}

impl MonitorState {
    /// The rotor's place in the last sample, mean over the planes, m; `None` where no plane delivers values of its own.
    pub fn position(&self) -> Option<[f32; 2]> {
        mean(&self.planes).map(|(position, _)| position)
    }

    /// Likewise of each plane; a plane that is not seen is where the other one is.
    pub fn places(&self) -> Option<[[f32; 2]; PLANES]> {
        let [a, b] = self.planes;
        Some([a.or(b)?, b.or(a)?])
    }

    /// Tells a wall that has moved once more, where it is seen again.
    pub fn forget_wall(&mut self) {
        self.health.wall = Default::default();
        self.touch.short = [0; PLANES];
    }
}

/// Fingerprint of the state over a run: equal on two machines only if every tick left the same bits. Not part of the tick.
#[derive(Clone)]
pub struct Fingerprint(Digest<'static, u32>);

impl Default for Fingerprint {
    fn default() -> Self {
        Self(CRC.digest())
    }
}

impl Fingerprint {
    /// Takes in the state after a tick, and that of the forecast below it.
    pub fn take(&mut self, state: &MonitorState, forecast_task: &ForecastTask) {
        self.0.update(&state.samples.to_le_bytes());
        self.0.update(&state.faults.to_le_bytes());
        state
            .health
            .fingerprint(|value| self.0.update(&bits(value).to_le_bytes()));
        state
            .detector
            .fingerprint(|word| self.0.update(&word.to_le_bytes()));
        let severity = state.severity.so_far.words();
        for value in forecast_task.words().into_iter().chain(severity) {
            self.0.update(&bits(value).to_le_bytes());
        }
    }

    /// What the run added up to.
    pub fn summary(self, state: &MonitorState) -> Summary {
        Summary {
            samples: state.samples,
            faults: state.faults,
            conditions: state.health.conditions(),
            state_hash: self.0.finalize(),
        }
    }
}
