//! Ends the passes over the rings early: each gains a constant factor on the one before, near the last
//! of them, so that three tell where they lead (Aitken's extrapolation, for vectors).
//!
//! Two rings at +-zeta gain (1 - zeta^2)^2/(1 + zeta^2)^2 in a pass, 0.85 at 0.2 and 5.

use crate::vector::Vector;
use touchdown_rotor::real::Real;

/// Passes over the rings.
pub(super) const PASSES: usize = 64;
/// Largest factor that is trusted.
const SLOWEST: f64 = 0.999;

/// The last passes; impulses as (normal, tangential) of each ring.
pub(super) struct Settling<R, const N: usize> {
    last: [Vector<R>; N],
    step: [Vector<R>; N],
    /// Since the last extrapolation.
    passes: u32,
}

impl<R: Real, const N: usize> Settling<R, N> {
    pub(super) fn new() -> Self {
        Self {
            last: [Vector::default(); N],
            step: [Vector::default(); N],
            passes: 0,
        }
    }

    /// Takes what a pass gave; where the passes lead, if they show it.
    pub(super) fn lead(&mut self, now: &[Vector<R>; N]) -> Option<[Vector<R>; N]> {
        let (mut along, mut square) = (R::ZERO, R::ZERO);
        for ((last, step), now) in self.last.iter_mut().zip(&mut self.step).zip(now) {
            let next = *now - *last;
            along += next.dot(*step);
            square += step.square();
            *step = next;
            *last = *now;
        }
        self.passes += 1;
        if self.passes < 3 || square <= R::ZERO || along.abs() > R::lit(SLOWEST) * square {
            return None;
        }
        self.passes = 0;
        let factor = along / (square - along);
        let mut led = *now;
        for (led, step) in led.iter_mut().zip(&self.step) {
            *led = *led + step.times(factor);
        }
        self.last = led;
        Some(led)
    }
}
