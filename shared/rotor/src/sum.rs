//! Compensated sum: a running value that keeps what rounding takes off.

use crate::real::Real;

/// What rounding takes off a product (Dekker's, without fused multiply-add).
pub fn product_error<R: Real>(a: R, b: R) -> R {
    let halves = |x: R| {
        let scaled = x * R::SPLITTER;
        let high = scaled - (scaled - x);
        (high, x - high)
    };
    let ((a1, a2), (b1, b2)) = (halves(a), halves(b));
    ((a1 * b1 - a * b) + a1 * b2 + a2 * b1) + a2 * b2
}

/// A value and the part of it that does not fit.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Sum<R> {
    value: R,
    rest: R,
}

impl<R: Real> Sum<R> {
    /// Without a rest.
    pub fn new(value: R) -> Self {
        Self {
            value,
            rest: R::ZERO,
        }
    }

    /// Without the rest.
    pub fn value(self) -> R {
        self.value
    }

    /// The value plus `term`, rounded once: exact where the two nearly cancel.
    pub fn plus(self, term: R) -> R {
        (self.value + term) + self.rest
    }

    /// The difference, with its rest.
    pub fn minus(self, other: Self) -> Self {
        let mut difference = Self::new(self.value);
        difference.add(-other.value);
        difference.add(self.rest - other.rest);
        difference
    }

    /// Adds `term` `count` times; what rounding takes off the product is kept.
    pub fn add_times(&mut self, count: R, term: Self) {
        let rest = core::mem::take(&mut self.rest);
        self.add(count * term.value);
        self.add(rest + product_error(count, term.value) + count * term.rest);
    }

    /// What does not fit in the value.
    pub fn rest(self) -> R {
        self.rest
    }

    /// Of the other sign.
    pub fn negative(self) -> Self {
        Self {
            value: -self.value,
            rest: -self.rest,
        }
    }

    /// Knuth's two-sum, for terms of any size.
    pub fn add(&mut self, term: R) {
        let term = term + self.rest;
        let sum = self.value + term;
        let back = sum - self.value;
        self.rest = (self.value - (sum - back)) + (term - back);
        self.value = sum;
    }
}
