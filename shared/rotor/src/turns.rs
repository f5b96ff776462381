//! An angle that may go round many times.

use core::f64::consts::TAU;

use crate::real::Real;
use crate::sum::Sum;

/// Whole turns and the angle beyond them: short steps of a long whirl lose no digits.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Turns<R> {
    whole: i64,
    /// rad, less than a turn either way.
    rest: Sum<R>,
}

impl<R: Real> Turns<R> {
    /// Adds `angle`, rad.
    pub fn add(&mut self, angle: R) {
        self.rest.add(angle);
        let full = R::lit(TAU);
        if self.rest.value().abs() >= full {
            let whole = (self.rest.value() / full).floor();
            self.whole = self.whole.saturating_add(whole.to_i64());
            self.rest.add(-(whole * full));
        }
    }

    /// Whole turns, and the angle beyond them, rad.
    pub fn parts(self) -> (i64, R) {
        (self.whole, self.rest.value())
    }
}
