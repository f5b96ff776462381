//! The guard: simple limits on the distance of each plane from the told centre, in every mode from the
//! first sample on. It learns nothing and believes nobody: neither the sensors' health nor the detector.
//!
//! | file | says |
//! |---|---|
//! | `window` | what three quarters of the samples of the last millisecond say |
//! | `alarm` | when a plane rises through a limit |
//! | `proof` | whether the rotor has been seen to float |
//! | `touch` | when the rotor reaches the wall, whatever holds it |

mod alarm;
mod proof;
mod touch;
mod window;

use self::alarm::{AlarmState, FALLEN, Limits};
use self::proof::{Proof, ProofState};
use self::touch::{CLEAR, PlaneTouch, TouchState, Touches};
use self::window::Window;
use crate::config::DetectorConfig;
use crate::event::{Alarm, Level, Notice, Notices, Plane};
use crate::sensing::PLANES;
use touchdown_rotor::error::ConfigError;

/// Longest time without a position of any plane, s.
const LOST_TIME: f32 = 1e-3;
/// Samples with the levitation signal off that are believed.
const OFF_SAMPLES: u8 = 3;

/// Limits, as parts of the told clearance.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(default, deny_unknown_fields))]
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

impl GuardConfig {
    fn validate(&self) -> Result<(), ConfigError> {
        if !(0.2..=0.9).contains(&self.alert) {
            return Err(ConfigError::OutOfRange("alert", "0.2 to 0.9"));
        }
        if !(self.danger > self.alert && self.danger <= 0.95) {
            return Err(ConfigError::OutOfRange("danger", "above alert, to 0.95"));
        }
        Ok(())
    }
}

/// Coefficients.
#[derive(Clone, Copy, Debug)]
pub struct Guard {
    stride: u8,
    /// Square of the distance within which nothing happens, m^2.
    clear_square: f32,
    limits: Limits,
    proof: Proof,
    touches: Touches,
    lost_samples: u16,
}

/// What it carries from sample to sample.
#[derive(Clone, Copy, Debug, Default)]
pub struct GuardState {
    sample: u64,
    planes: [PlaneState; PLANES],
    proof: ProofState,
    touch: TouchState,
    /// Samples until one counts for the window.
    wait: u8,
    /// In a row.
    lost: u16,
    off: u8,
    verdict: Verdict,
}

/// Of a plane.
#[derive(Clone, Copy, Debug, Default)]
struct PlaneState {
    alarm: AlarmState,
    touch: PlaneTouch,
    /// Nothing of the last millisecond is of interest.
    is_quiet: bool,
}

/// What the guard says after a sample.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Verdict {
    /// A plane is beyond the danger limit, or on its way back to where it was lifted from.
    pub danger: bool,
    /// No plane has delivered a position for a millisecond.
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
        config.validate()?;
        let rate = detector.sample_rate;
        let window = Window::new(rate);
        Ok(Self {
            stride: window.stride,
            clear_square: {
                let clear = (config.alert - FALLEN).min(CLEAR) * detector.machine.clearance;
                clear * clear
            },
            limits: Limits::new(config, detector.machine.clearance, window),
            proof: Proof::new(config, detector, fitted, commissioned),
            touches: Touches::new(detector.machine.clearance, rate),
            lost_samples: ((LOST_TIME * rate) as u16).max(2),
        })
    }

    /// One tick: each plane's place (m), `None` where it did not deliver, and the levitation signal, where it is
    /// wired. Bounded; cannot fail.
    pub fn update(
        &self,
        state: &mut GuardState,
        planes: [Option<[f32; 2]>; PLANES],
        levitated: Option<bool>,
        notices: &mut Notices,
    ) {
        let sample = state.sample;
        state.sample += 1;
        let counts = state.wait == 0;
        state.wait = if counts { self.stride } else { state.wait } - 1;
        let mut is_quiet = true;
        for (it, (place, floor)) in state
            .planes
            .iter_mut()
            .zip(planes.into_iter().zip(state.proof.floors()))
        {
            let Some([x, y]) = place else {
                is_quiet &= it.is_quiet;
                continue;
            };
            let square = x * x + y * y;
            if it.is_quiet && square < self.clear_square && y >= floor {
                it.touch.stay([x, y]);
            } else {
                is_quiet = false;
            }
        }
        let (alert, danger) = if is_quiet {
            (false, false)
        } else {
            self.near(state, planes, sample, counts, notices)
        };
        let sees = planes.iter().any(Option::is_some);
        state.lost = if sees {
            0
        } else {
            state.lost.saturating_add(1)
        };
        let is_off = levitated == Some(false);
        state.off = if is_off {
            state.off.saturating_add(1)
        } else {
            0
        };
        let floats = self.proof.take(&mut state.proof, planes, levitated);
        state.verdict = Verdict {
            danger,
            lost: state.lost >= self.lost_samples,
            off: state.off >= OFF_SAMPLES,
            floats: floats && !alert,
        };
    }
}

impl Guard {
    /// Where a plane is near a limit or has been in the last millisecond: whether one is beyond alert, and beyond
    /// danger or below its floor.
    #[inline(never)]
    fn near(
        &self,
        state: &mut GuardState,
        places: [Option<[f32; 2]>; PLANES],
        sample: u64,
        counts: bool,
        notices: &mut Notices,
    ) -> (bool, bool) {
        let (mut alert, mut danger) = (false, false);
        let floors = state.proof.floors();
        let planes = state.planes.iter_mut().zip(places);
        for ((it, place), (plane, floor)) in
            planes.zip([Plane::A, Plane::B].into_iter().zip(floors))
        {
            if let Some(place) = place {
                if counts {
                    let risen = self.limits.take(&mut it.alarm, place, floor);
                    if risen != [None; 2] {
                        self.tell_alarms(risen, plane, place, sample, notices);
                    }
                }
                self.touches.follow(&mut it.touch, place);
            }
            alert |= self.limits.is_beyond(&it.alarm, Level::Alert);
            danger |= self.limits.is_beyond(&it.alarm, Level::Danger);
            it.is_quiet = it.alarm.is_clear() && it.touch.is_clear();
        }
        let [a, b] = &state.planes;
        let planes = [&a.touch, &b.touch];
        if let Some(touch) = self.touches.take(&mut state.touch, planes, sample) {
            tell(notices, Notice::Touch(touch));
        }
        (alert, danger)
    }

    #[cold]
    fn tell_alarms(
        &self,
        risen: [Option<Level>; 2],
        plane: Plane,
        place: [f32; 2],
        sample: u64,
        notices: &mut Notices,
    ) {
        let fraction = self.limits.fraction(place);
        for level in risen.into_iter().flatten() {
            let alarm = Alarm {
                plane,
                level,
                fraction,
                sample,
            };
            tell(notices, Notice::Alarm(alarm));
        }
    }
}

impl GuardState {
    /// What the guard says after the last sample.
    pub fn verdict(&self) -> Verdict {
        self.verdict
    }

    /// Touches so far.
    pub fn touches(&self) -> u32 {
        self.touch.count()
    }

    /// As if the rotor had been seen where it is lifted from.
    pub fn assume_lift(&mut self) {
        self.proof.assume_lift();
    }

    /// A proof was lost: where the rotor is lifted from has to be seen anew.
    pub fn lose_proof(&mut self) {
        self.proof = ProofState::default();
    }

    /// What was seen so far of a floating rotor does not count.
    pub fn restart_proof(&mut self) {
        self.proof.restart();
    }
}

/// There is room for all that a tick can say; without it nothing else may suffer.
#[cold]
#[inline(never)]
fn tell(notices: &mut Notices, notice: Notice) {
    let _ = notices.push(notice);
}
