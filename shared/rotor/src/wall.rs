//! The rotor on the wall: where it is, how fast, and how the contact point moves.

use crate::real::Real;
use crate::sum::Sum;

/// How the contact point moves.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Mode<R> {
    /// With slip; friction over normal force, signed along the wall (counter-clockwise).
    Sliding(R),
    /// Without.
    Rolling,
}

/// Where the rotor is on the wall, and how fast.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct WallState<R> {
    /// Sine of the angle from the bottom, counter-clockwise.
    pub sin: Sum<R>,
    /// Cosine of it.
    pub cos: Sum<R>,
    /// Velocity along the wall.
    pub tangential: Sum<R>,
    /// Surface speed of the spin.
    pub spin: Sum<R>,
}

impl<R: Real> WallState<R> {
    /// Velocity of the contact point along the wall: exactly 0 where it rolls.
    pub fn slip(&self) -> R {
        self.spin.plus(self.tangential.value()) + self.tangential.rest()
    }
}
