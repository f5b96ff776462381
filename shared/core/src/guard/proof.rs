//! Whether the rotor has been seen to float: it stays still above the lowest place that it was seen at.
//!
//! Distance alone does not show it: with gap, zero and gain told wrong the wall reads as near as a floating rotor
//! reads far. A rotor on the wall lies where it is lowest, one that floats has been lifted from there. The two places
//! give a floor that needs nothing told: below it the rotor is on its way back to where it lay.

use super::GuardConfig;
use crate::config::DetectorConfig;
use crate::sensing::PLANES;

/// Time at or below a height that makes it one where the rotor was, s: longer than most bursts of disturbance.
const HELD: f32 = 0.01;
/// Times that, which a floating rotor stays: 0.1 s.
const HELDS: u8 = 10;
/// Part of the clearance that a floating rotor's mean place is above the lowest one.
const HEIGHT: f32 = 0.25;
/// Part of the height of a proven rotor above the lowest place, at which the floor is. Told right, from the centre, it
/// is 0.65 of the clearance below.
const FLOOR: f32 = 0.35;
/// Part of the clearance that it stays within, of its mean place.
const SPREAD: f32 = 0.2;

/// Coefficients; m.
#[derive(Clone, Copy, Debug)]
pub(super) struct Proof {
    fitted: [bool; PLANES],
    /// Whether weight shows where the rotor lies.
    has_weight: bool,
    commissioned: bool,
    /// Even: each plane is looked at in every other one.
    held_samples: u16,
    /// 1 over a plane's samples of a stay.
    scale: f32,
    height: f32,
    spread_square: f32,
    alert_square: f32,
}

/// What was seen of a plane; m.
#[derive(Clone, Copy, Debug)]
struct PlaneProof {
    sum: [f32; 2],
    least: [f32; 2],
    most: [f32; 2],
    /// Of the present part of the stay.
    highest: f32,
    /// Lowest since proof was lost.
    lowest: f32,
    /// Since the first proof after that; infinitely low before it, and where a lift was assumed.
    floor: f32,
}

/// What was seen of the planes.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct ProofState {
    samples: u16,
    helds: u8,
    planes: [PlaneProof; PLANES],
}

impl Default for PlaneProof {
    fn default() -> Self {
        Self {
            sum: [0.0; 2],
            least: [f32::INFINITY; 2],
            most: [f32::NEG_INFINITY; 2],
            highest: f32::NEG_INFINITY,
            lowest: f32::INFINITY,
            floor: f32::NEG_INFINITY,
        }
    }
}

impl Proof {
    pub(super) fn new(
        config: &GuardConfig,
        detector: &DetectorConfig,
        fitted: u8,
        commissioned: bool,
    ) -> Self {
        let clearance = detector.machine.clearance;
        let rate = detector.sample_rate;
        let of_plane = ((0.5 * HELD * rate) as u16).max(4);
        let spread = SPREAD * clearance;
        let alert = config.alert * clearance;
        Self {
            fitted: [fitted & 0b0011 != 0, fitted & 0b1100 != 0],
            has_weight: detector.machine.gravity > 0.0,
            commissioned,
            held_samples: 2 * of_plane,
            scale: 1.0 / (f32::from(of_plane) * f32::from(HELDS)),
            height: HEIGHT * clearance,
            spread_square: spread * spread,
            alert_square: alert * alert,
        }
    }

    /// Takes each plane's place, m; whether this sample completes a proof. Every plane that is fitted has to
    /// deliver.
    pub(super) fn take(
        &self,
        state: &mut ProofState,
        planes: [Option<[f32; 2]>; PLANES],
        levitated: Option<bool>,
    ) -> bool {
        let mut delivers = true;
        let turns = [state.samples & 1 == 0, state.samples & 1 != 0];
        let fitted = self.fitted.into_iter().zip(turns);
        for ((it, place), (fitted, turn)) in state.planes.iter_mut().zip(planes).zip(fitted) {
            match place {
                Some(place) => {
                    if turn {
                        it.take(place);
                    }
                }
                None => delivers &= !fitted,
            }
        }
        if !delivers || levitated == Some(false) {
            state.restart();
            return false;
        }
        state.samples += 1;
        if state.samples < self.held_samples {
            return false;
        }
        state.samples = 0;
        state.helds += 1;
        let is_over = state.helds >= HELDS;
        let signal = if self.has_weight {
            true
        } else {
            self.commissioned && levitated == Some(true)
        };
        let mut floats = is_over && signal;
        for (it, fitted) in state.planes.iter_mut().zip(self.fitted) {
            floats &= !fitted || self.floats(it);
            it.lowest = it.lowest.min(it.highest);
            it.highest = f32::NEG_INFINITY;
        }
        if floats {
            state.planes.iter_mut().for_each(|it| self.put_floor(it));
        }
        if is_over {
            state.restart();
        }
        floats
    }

    /// Under a rotor that has just been proven to float, where it has none.
    fn put_floor(&self, it: &mut PlaneProof) {
        let height = it.sum[1] * self.scale - it.lowest;
        if self.has_weight && it.floor == f32::NEG_INFINITY && height.is_finite() {
            it.floor = it.lowest + FLOOR * height;
        }
    }

    /// Whether a plane has stayed where only a floating rotor does.
    fn floats(&self, it: &PlaneProof) -> bool {
        let [x, y] = it.sum.map(|sum| sum * self.scale);
        let reach = |mean: f32, least: f32, most: f32| (most - mean).max(mean - least);
        let dx = reach(x, it.least[0], it.most[0]);
        let dy = reach(y, it.least[1], it.most[1]);
        let is_lifted = !self.has_weight || y - it.lowest >= self.height;
        is_lifted && dx * dx + dy * dy <= self.spread_square && x * x + y * y <= self.alert_square
    }
}

impl PlaneProof {
    #[inline]
    fn take(&mut self, place: [f32; 2]) {
        let axes = self.sum.iter_mut().zip(&mut self.least);
        for (((sum, least), most), value) in axes.zip(&mut self.most).zip(place) {
            *sum += value;
            // `min` and `max` are calls where the core has no instruction for them.
            if value < *least {
                *least = value;
            }
            if value > *most {
                *most = value;
            }
        }
        if place[1] > self.highest {
            self.highest = place[1];
        }
    }
}

impl ProofState {
    /// The floor of each plane, m.
    #[inline]
    pub(super) fn floors(&self) -> [f32; PLANES] {
        let [a, b] = &self.planes;
        [a.floor, b.floor]
    }

    /// As if the rotor had been seen far below.
    pub(super) fn assume_lift(&mut self) {
        for it in &mut self.planes {
            it.lowest = f32::NEG_INFINITY;
        }
    }

    /// Begins a stay, and keeps where the rotor was lowest.
    pub(super) fn restart(&mut self) {
        (self.samples, self.helds) = (0, 0);
        for it in &mut self.planes {
            *it = PlaneProof {
                lowest: it.lowest,
                floor: it.floor,
                ..PlaneProof::default()
            };
        }
    }
}
