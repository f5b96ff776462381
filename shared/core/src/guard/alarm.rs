//! When a plane rises through a limit.

use super::GuardConfig;
use super::window::Window;
use crate::event::Level;
use touchdown_rotor::real::sqrt;

/// Part of the clearance that a plane must fall by before the same alarm is told again.
const FALLEN: f32 = 0.1;

/// Coefficients.
#[derive(Clone, Copy, Debug)]
pub(super) struct Limits {
    clearance: f32,
    /// Squares, m^2: of each level, and of where it has fallen.
    squares: [[f32; 2]; 2],
}

/// Of a plane.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct AlarmState {
    /// Of each level: samples beyond it, and beyond where it has fallen; the newest is bit 0.
    beyond: [[u32; 2]; 2],
    told: [bool; 2],
    /// 0 before the first sample, 1 at it, 2 after it.
    seen: u8,
    square: f32,
}

impl Limits {
    pub(super) fn new(config: &GuardConfig, clearance: f32) -> Self {
        let square = |part: f32| (part * clearance) * (part * clearance);
        Self {
            clearance,
            squares: [config.alert, config.danger].map(|it| [square(it), square(it - FALLEN)]),
        }
    }

    /// Takes a plane's place, m.
    pub(super) fn take(&self, state: &mut AlarmState, [x, y]: [f32; 2]) {
        state.square = x * x + y * y;
        let is_first = state.seen == 0;
        state.seen = (state.seen + 1).min(2);
        for (bits, squares) in state.beyond.iter_mut().zip(&self.squares) {
            for (bits, square) in bits.iter_mut().zip(squares) {
                let is_beyond = state.square >= *square;
                *bits = match (is_first, is_beyond) {
                    (false, _) => *bits << 1 | u32::from(is_beyond),
                    // As if it had been there before the first sample.
                    (true, true) => u32::MAX,
                    (true, false) => 0,
                };
            }
        }
    }

    /// Whether the plane is beyond a limit.
    pub(super) fn is_beyond(&self, state: &AlarmState, window: Window, level: Level) -> bool {
        let bits = state.beyond.get(level as usize);
        bits.is_some_and(|[beyond, _]| window.holds(*beyond))
    }

    /// The limits that the plane has just risen through; at the first sample only the higher one.
    pub(super) fn rises(&self, state: &mut AlarmState, window: Window) -> [Option<Level>; 2] {
        let mut risen = [None; 2];
        let levels = state.beyond.iter().zip(&mut state.told).zip(Level::ALL);
        for (([beyond, fallen], told), level) in levels {
            if window.holds(*beyond) && !*told {
                *told = true;
                if let Some(slot) = risen.get_mut(level as usize) {
                    *slot = Some(level);
                }
            } else if !window.holds(*fallen) {
                *told = false;
            }
        }
        if state.seen == 1 && risen == Level::ALL.map(Some) {
            risen = [None, Some(Level::Danger)];
        }
        risen
    }

    /// Distance in the newest sample that counts, as a part of the clearance.
    pub(super) fn fraction(&self, state: &AlarmState) -> f32 {
        sqrt(state.square) / self.clearance
    }
}
