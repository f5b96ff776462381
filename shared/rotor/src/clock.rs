//! Time as whole steps and a fraction: exact after any number of steps.

use crate::real::Real;
use crate::sum::{Sum, product_error};

/// Length of a step, in units of T, and the part of it that its rounding took off: over the impacts of
/// a long run the rounding of the length alone would shift all moments alike.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct StepLength<R> {
    length: R,
    /// Rest over length.
    rest: R,
}

impl<R: Real> StepLength<R> {
    /// A length that is exact.
    pub fn new(length: R) -> Self {
        Self {
            length,
            rest: R::ZERO,
        }
    }

    /// Whole steps in `time` and the fraction beyond them; the fraction is as accurate as after a short
    /// time.
    fn split(&self, time: R) -> (R, R) {
        if time < self.length {
            let part = time / self.length;
            return (R::ZERO, part - part * self.rest);
        }
        let whole = (time / self.length).floor();
        let left = (time - whole * self.length) - product_error(whole, self.length);
        (whole, left / self.length - (time / self.length) * self.rest)
    }

    /// Whole steps in `count` times `time`, and the fraction beyond them: the fraction of `time` is kept
    /// with twice the digits, so that it can be taken a million times.
    pub fn times(&self, count: R, time: Sum<R>) -> Instant<R> {
        let whole = (time.value() / self.length).floor();
        let exact = (time.value() - whole * self.length) - product_error(whole, self.length);
        let first = exact / self.length;
        let left = (exact - first * self.length) - product_error(first, self.length);
        let second = (left + time.rest()) / self.length - (whole + first) * self.rest;
        let mut steps = Sum::new(R::ZERO);
        let mut fraction = Sum::new(first);
        fraction.add(second);
        steps.add_times(count, fraction);
        let carry = steps.value().floor();
        steps.add(-carry);
        let tick = whole.to_u64().saturating_mul(count.to_u64());
        Instant::at_tick(tick.saturating_add_signed(carry.to_i64())).later(0, steps.value())
    }

    /// Time of `steps`.
    pub fn time(&self, steps: R) -> R {
        let time = steps * self.length;
        time + time * self.rest
    }
}

impl StepLength<f64> {
    /// Rounded once, with the rest.
    pub fn rounded<R: Real>(&self) -> StepLength<R> {
        let length = R::lit(self.length);
        StepLength {
            length,
            rest: R::lit(self.length / length.to_f64() - 1.0),
        }
    }
}

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
    pub const NEVER: Self = Self {
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

    /// `time` (0 or more) later.
    pub fn after(self, time: R, step: &StepLength<R>) -> Self {
        let (whole, part) = step.split(time);
        self.later(whole.to_u64(), part)
    }

    /// `span` later.
    pub fn plus(self, span: Self) -> Self {
        self.later(span.tick, span.fraction)
    }

    /// `whole` steps and `part` of one later.
    fn later(self, whole: u64, part: R) -> Self {
        let sum = self.fraction + part;
        if !sum.is_finite() {
            return Self::NEVER;
        }
        let carry = sum.floor();
        let tick = self.tick.saturating_add(whole);
        Self {
            tick: tick.saturating_add_signed(carry.to_i64()),
            fraction: sum - carry,
        }
    }

    /// `steps` (0 to 1) earlier, not before the release.
    pub fn before(self, steps: R) -> Self {
        if steps <= self.fraction {
            Self {
                tick: self.tick,
                fraction: self.fraction - steps,
            }
        } else if self.tick > 0 {
            Self {
                tick: self.tick - 1,
                fraction: self.fraction + (R::ONE - steps),
            }
        } else {
            Self::default()
        }
    }

    /// Steps from `earlier` to here; 0 if `earlier` is later.
    pub fn since(self, earlier: Self) -> R {
        if self.tick < earlier.tick {
            return R::ZERO;
        }
        let steps = R::from_u64(self.tick - earlier.tick) + (self.fraction - earlier.fraction);
        steps.most(R::ZERO)
    }

    /// The first whole step not before.
    pub fn next_tick(self) -> u64 {
        if self.fraction > R::ZERO {
            self.tick.saturating_add(1)
        } else {
            self.tick
        }
    }

    /// Whether the moment has come at `now`.
    pub fn is_reached_at(self, now: Self) -> bool {
        self.tick < now.tick || (self.tick == now.tick && self.fraction <= now.fraction)
    }
}
