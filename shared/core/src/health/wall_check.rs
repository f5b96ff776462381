//! Whether wall and zero of a plane are still where the commissioning check found them: rest and touches show it.
//!
//! A touch that goes beyond the wall tells nothing, since a retainer gives way. One that ends short of it does, where
//! no magnet can have turned the rotor back so fast.

use crate::event::Touch;
use touchdown_rotor::real::sqrt;

/// Part of the clearance by which the wall may seem off. The check's own errors, 2 % of zero and of gain at 95 %, add up
/// to 3 %; sag of the retainer and temperature have the rest.
const OFF: f32 = 0.05;
/// Part of the clearance that is at the wall, at least: no rotor floats there.
const AT_WALL: f32 = 0.7;
/// Part of the clearance within which a rotor at rest begins and ends what its mean place is taken over.
const STILL: f32 = 0.04;
/// Such times in a row, 0.1 s each.
const RESTS: u8 = 2;
/// Touches in a row that end short.
const TOUCHES: u8 = 3;
/// Part of the clearance at which a touch begins.
const TOUCH: f32 = 0.8;
/// Most with which magnets turn a rotor, m/s^2.
const STRONGEST: f32 = 200.0;
/// Samples of a touch: in a shorter one the turn may have been farther out between two of them, by 2 % and more.
const LEAST: u64 = 8;

/// Coefficients.
#[derive(Clone, Copy, Debug)]
pub(crate) struct WallCheck {
    per_clearance: f32,
    /// Square of the samples in which a magnet turns a rotor back, per part of the clearance that it goes.
    turn: f32,
    /// Only what has been checked can have moved.
    is_on: bool,
}

/// Of a plane.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct WallCheckState {
    rests: u8,
    short: u8,
    told: bool,
}

impl WallCheck {
    /// For a `clearance` (m) and a `sample_rate` (Hz).
    pub(crate) fn new(clearance: f32, sample_rate: f32, is_on: bool) -> Self {
        Self {
            per_clearance: 1.0 / clearance,
            turn: 8.0 * clearance * sample_rate * sample_rate / STRONGEST,
            is_on,
        }
    }

    /// Takes a mean place, and those at the beginning and the end of what it was taken over, m.
    pub(crate) fn rest(&self, it: &mut WallCheckState, mean: [f32; 2], ends: [[f32; 2]; 2]) {
        let far = |[x, y]: [f32; 2]| sqrt(x * x + y * y) * self.per_clearance;
        let is_still = ends
            .iter()
            .all(|[x, y]| far([x - mean[0], y - mean[1]]) < STILL);
        let distance = far(mean);
        let is_off = is_still && distance > AT_WALL && (distance - 1.0).abs() > OFF;
        it.rests = if is_off {
            it.rests.saturating_add(1)
        } else {
            0
        };
    }

    /// Takes a touch that has ended. One that was too slow to tell counts for nothing.
    pub(crate) fn touch(&self, it: &mut WallCheckState, touch: &Touch) {
        let samples = touch.end.unwrap_or(0).saturating_sub(touch.onset);
        // Of a parabola to the peak: less than its time.
        let turn = self.turn * (touch.peak - TOUCH);
        if touch.peak >= 1.0 - OFF {
            it.short = 0;
        } else if samples >= LEAST && (samples * samples) as f32 <= turn {
            it.short = it.short.saturating_add(1);
        }
    }

    /// Whether it is to be told now: once.
    #[inline]
    pub(crate) fn tell(&self, it: &mut WallCheckState) -> bool {
        let tells = self.is_on && !it.told && (it.rests >= RESTS || it.short >= TOUCHES);
        it.told |= tells;
        tells
    }
}
