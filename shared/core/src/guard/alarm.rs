//! When a plane rises through a limit.

use super::GuardConfig;
use super::window::{Tally, Window};
use crate::event::Level;
use touchdown_rotor::real::sqrt;

/// Part of the clearance that a plane must fall by before the same alarm is told again.
pub(super) const FALLEN: f32 = 0.1;

/// Coefficients.
#[derive(Clone, Copy, Debug)]
pub(super) struct Limits {
    window: Window,
    per_clearance: f32,
    /// Squares, m^2: of each level, and of where it has fallen.
    squares: [[f32; 2]; 2],
}

/// Of a plane.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct AlarmState {
    /// Of each level: beyond it, and beyond where it has fallen.
    beyond: [[Tally; 2]; 2],
    /// Below the floor.
    below: Tally,
    told: [bool; 2],
    started: bool,
}

impl Limits {
    pub(super) fn new(config: &GuardConfig, clearance: f32, window: Window) -> Self {
        let square = |part: f32| (part * clearance) * (part * clearance);
        Self {
            window,
            per_clearance: 1.0 / clearance,
            squares: [config.alert, config.danger].map(|it| [square(it), square(it - FALLEN)]),
        }
    }

    /// Takes a plane's place, m, above or below its floor; the limits that it has just risen through, at the first
    /// sample only the higher one.
    #[inline]
    pub(super) fn take(
        &self,
        state: &mut AlarmState,
        [x, y]: [f32; 2],
        floor: f32,
    ) -> [Option<Level>; 2] {
        let square = x * x + y * y;
        if !state.started {
            return self.begin(state, square);
        }
        self.window.take(&mut state.below, y < floor);
        let [alert, danger] = &mut state.beyond;
        let [told_alert, told_danger] = &mut state.told;
        let [of_alert, of_danger] = &self.squares;
        let is_alert = self.rises(alert, told_alert, of_alert, square);
        let is_danger = self.rises(danger, told_danger, of_danger, square);
        [
            is_alert.then_some(Level::Alert),
            is_danger.then_some(Level::Danger),
        ]
    }

    /// Whether a sample at this distance (square, m^2) completes a rise through a limit.
    #[inline]
    fn rises(
        &self,
        [beyond, fallen]: &mut [Tally; 2],
        told: &mut bool,
        [limit, least]: &[f32; 2],
        square: f32,
    ) -> bool {
        self.window.take(beyond, square >= *limit);
        self.window.take(fallen, square >= *least);
        let is_beyond = self.window.holds(*beyond);
        let risen = is_beyond && !*told;
        *told = is_beyond || *told && self.window.holds(*fallen);
        risen
    }

    /// The first sample: as if it had been there for a millisecond.
    #[cold]
    fn begin(&self, state: &mut AlarmState, square: f32) -> [Option<Level>; 2] {
        state.started = true;
        let fill = |limit: f32| self.window.fill(square >= limit);
        state.beyond = self.squares.map(|limits| limits.map(fill));
        let [[alert, _], [danger, _]] = self.squares;
        state.told = [square >= alert, square >= danger];
        match state.told {
            [_, true] => [None, Some(Level::Danger)],
            [true, false] => [Some(Level::Alert), None],
            _ => [None; 2],
        }
    }

    /// Whether the plane is beyond a limit; below its floor is danger.
    pub(super) fn is_beyond(&self, state: &AlarmState, level: Level) -> bool {
        let [[alert, _], [danger, _]] = state.beyond;
        match level {
            Level::Alert => self.window.holds(alert),
            Level::Danger => self.window.holds(danger) || self.window.holds(state.below),
        }
    }

    /// Distance of a place (m), as a part of the clearance.
    pub(super) fn fraction(&self, [x, y]: [f32; 2]) -> f32 {
        sqrt(x * x + y * y) * self.per_clearance
    }
}

impl AlarmState {
    /// Whether no sample was beyond even the least limit, or below the floor.
    pub(super) fn is_clear(&self) -> bool {
        let [[_, least], _] = self.beyond;
        self.started && least.is_none() && self.below.is_none()
    }
}
