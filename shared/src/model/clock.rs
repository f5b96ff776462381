//! Time as whole steps and a fraction: exact after any number of steps.

use crate::real::Real;

/// A moment on the model's clock.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Instant<R> {
    /// Whole steps since the release.
    pub tick: u64,
    /// Fraction of a step, 0 to 1.
    pub fraction: R,
}

impl<R: Real> Instant<R> {
    /// A moment that never comes.
    pub(crate) const NEVER: Self = Self {
        tick: u64::MAX,
        fraction: R::ZERO,
    };

    /// The start of step `tick`.
    pub fn at_tick(tick: u64) -> Self {
        Self {
            tick,
            fraction: R::ZERO,
        }
    }

    /// `steps` (0 or more, not whole) later.
    pub(crate) fn after(self, steps: R) -> Self {
        let sum = self.fraction + steps;
        if !sum.is_finite() {
            return Self::NEVER;
        }
        let whole = sum.floor();
        Self {
            tick: self.tick.saturating_add(whole.to_u64()),
            fraction: sum - whole,
        }
    }

    /// Steps from `earlier` to here; 0 if `earlier` is later.
    pub(crate) fn since(self, earlier: Self) -> R {
        if self.tick < earlier.tick {
            return R::ZERO;
        }
        let steps = R::from_u64(self.tick - earlier.tick) + (self.fraction - earlier.fraction);
        steps.most(R::ZERO)
    }

    /// Whether the moment has come at `now`.
    pub(crate) fn is_reached_at(self, now: Self) -> bool {
        self.tick < now.tick || (self.tick == now.tick && self.fraction <= now.fraction)
    }
}
