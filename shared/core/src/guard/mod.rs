//! The guard: simple limits on the distance of each plane from the told centre, in every mode from the
//! first sample on. It learns nothing and believes nobody: neither the sensors' health nor the detector.

mod limits;
mod proof;

use self::limits::{ALERT, BELOW, DANGER, Limits, PlaneLimits};
use self::proof::Proof;
pub use self::proof::ProofState;
use crate::config::DetectorConfig;
use crate::event::{Alarm, Level, Notice, Notices, Plane};
use crate::sample::{Sample, count_in_a_row};
use crate::sensing::PLANES;
use touchdown_rotor::error::ConfigError;
use touchdown_rotor::real::sqrt;

/// Longest time without a position of a plane that is fitted, s.
const LOST_TIME: f32 = 1e-3;
/// Samples with the levitation signal off that are believed.
const OFF_SAMPLES: u32 = 3;

/// Limits, as parts of the told clearance.
#[derive(Clone, Copy, Debug, PartialEq, serde::Serialize, serde::Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct GuardConfig {
    /// Distance that is told, and within which levitation is proven.
    pub alert: f32,
    /// Distance that trips.
    pub danger: f32,
}

impl Default for GuardConfig {
    fn default() -> Self {
        Self {
            alert: 0.5,
            danger: 0.67,
        }
    }
}

/// Coefficients.
#[derive(Clone, Copy, Debug)]
pub struct Guard {
    per_clearance: f32,
    limits: Limits,
    proof: Proof,
    /// Samples without a place that each plane may have in a row; any number where it is not fitted.
    most_lost: [u32; PLANES],
}

/// What it carries from sample to sample.
#[derive(Clone, Copy, Debug, Default)]
pub struct GuardState {
    planes: [PlaneState; PLANES],
    /// Of levitation.
    pub proof: ProofState,
    /// Samples until one counts for the limits.
    wait: u8,
    /// In a row.
    off: u32,
    is_alert: bool,
    /// After the last sample.
    pub verdict: Verdict,
}

/// Of a plane.
#[derive(Clone, Copy, Debug, Default)]
struct PlaneState {
    limits: PlaneLimits,
    /// Samples in a row without a place.
    lost: u32,
    /// Alarms that are still to be told, samples since then, and the square of the distance then, m^2.
    alarms: u32,
    late: u8,
    square: f32,
}

/// What the guard says after a sample.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Verdict {
    /// A plane is beyond the danger limit, or on its way back to where it was lifted from.
    pub danger: bool,
    /// A plane that is fitted has not delivered a position for a millisecond, or a channel told one count for 10 ms.
    pub lost: bool,
    /// The levitation signal is off.
    pub off: bool,
    /// This sample completes a proof of levitation.
    pub floats: bool,
}

impl Guard {
    /// Checks `config`; that of the detector must be valid. `fitted` has a bit for each channel; `commissioned` says
    /// whether a commissioning check is on record.
    pub fn try_new(
        config: &GuardConfig,
        detector: &DetectorConfig,
        fitted: u8,
        commissioned: bool,
    ) -> Result<Self, ConfigError> {
        let GuardConfig { alert, danger } = *config;
        if !(0.2..=0.9).contains(&alert) {
            return Err(ConfigError::OutOfRange("alert", "0.2 to 0.9"));
        }
        if !(danger > alert && danger <= 0.95) {
            return Err(ConfigError::OutOfRange("danger", "above alert, to 0.95"));
        }
        let (clearance, rate) = (detector.machine.clearance, detector.sample_rate);
        let most_lost = ((LOST_TIME * rate) as u32).max(2) - 1;
        let most_lost = match fitted {
            0b0011 => [most_lost, u32::MAX],
            0b1100 => [u32::MAX, most_lost],
            0b1111 => [most_lost; PLANES],
            _ => return Err(ConfigError::OutOfRange("fitted", "one plane or two")),
        };
        Ok(Self {
            per_clearance: 1.0 / clearance,
            limits: Limits::new(config, clearance, rate),
            proof: Proof::new(config, detector, fitted, commissioned),
            most_lost,
        })
    }

    /// One tick: each plane's place (m), `None` where it did not deliver, and the levitation signal, where it is
    /// wired. Bounded; cannot fail.
    #[inline]
    pub fn update(
        &self,
        state: &mut GuardState,
        places: [Option<[f32; 2]>; PLANES],
        levitated: Option<bool>,
    ) {
        let counts = state.wait == 0;
        state.wait = state.wait.checked_sub(1).unwrap_or(self.limits.stride - 1);
        let [of_a, of_b] = &mut state.planes;
        let [floor_a, floor_b] = state.proof.floors();
        let [a, b] = places;
        let beyond = self.see(of_a, a, floor_a, counts) | self.see(of_b, b, floor_b, counts);
        let [most_a, most_b] = self.most_lost;
        let lost = of_a.lost > most_a || of_b.lost > most_b;
        count_in_a_row(&mut state.off, levitated == Some(false));
        state.is_alert = beyond & ALERT != 0;
        state.verdict = Verdict {
            danger: beyond & (DANGER | BELOW) != 0,
            lost,
            off: state.off >= OFF_SAMPLES,
            floats: false,
        };
    }

    /// Takes a plane's place, m, which may count; what the plane is beyond.
    #[inline]
    fn see(&self, it: &mut PlaneState, place: Option<[f32; 2]>, floor: f32, counts: bool) -> u32 {
        let Some([x, y]) = place else {
            it.lost = it.lost.saturating_add(1);
            return self.limits.beyond(&it.limits);
        };
        it.lost = 0;
        let square = x * x + y * y;
        let is_near = square >= self.limits.least() || y < floor;
        if is_near || !it.limits.is_clear() {
            self.look(it, square, y < floor, counts)
        } else {
            0
        }
    }

    /// Likewise, near a limit, or not long after.
    #[inline(never)]
    fn look(&self, it: &mut PlaneState, square: f32, is_below: bool, counts: bool) -> u32 {
        if counts {
            let flags = self.limits.flags(square, is_below);
            let alarms = self.limits.take(&mut it.limits, flags);
            if alarms != 0 {
                (it.alarms, it.late, it.square) = (alarms, 0, square);
            }
        }
        self.limits.beyond(&it.limits)
    }

    /// What follows from a tick and needs not be on time, in the same `sample` of this `number`: proof, and the next
    /// alarm.
    #[inline]
    pub fn follow(
        &self,
        state: &mut GuardState,
        places: &[Option<[f32; 2]>; PLANES],
        sample: &Sample,
        number: u64,
        notices: &mut Notices,
    ) {
        let floats = self.proof.take(&mut state.proof, places, sample);
        state.verdict.floats = floats && !state.is_alert;
        state.verdict.lost |= state.proof.frozen;
        let [a, b] = &mut state.planes;
        if a.alarms != 0 {
            b.late += u8::from(b.alarms != 0);
            self.tell(a, Plane::A, number, notices);
        } else if b.alarms != 0 {
            self.tell(b, Plane::B, number, notices);
        }
    }

    #[inline(never)]
    fn tell(&self, it: &mut PlaneState, plane: Plane, sample: u64, notices: &mut Notices) {
        let (level, flag) = if it.alarms & ALERT != 0 {
            (Level::Alert, ALERT)
        } else {
            (Level::Danger, DANGER)
        };
        let alarm = Alarm {
            plane,
            level,
            fraction: sqrt(it.square) * self.per_clearance,
            sample: sample.saturating_sub(u64::from(it.late)),
        };
        it.alarms &= !flag;
        it.late += 1;
        // There is room for all that a tick can say; without it nothing else may suffer.
        let _ = notices.push(Notice::Alarm(alarm));
    }
}
