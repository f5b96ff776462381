//! The rotor on the wall: where it is, how fast, and how the contact point moves.

use crate::model::sum::Sum;
use crate::real::Real;

/// How the contact point moves.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Mode<R> {
    /// With slip; friction over normal force, signed along the wall (counter-clockwise).
    Sliding(R),
    /// Without.
    Rolling,
}

/// Where the rotor is on the wall, and how fast.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct WallState<R> {
    pub(crate) sin: Sum<R>,
    pub(crate) cos: Sum<R>,
    /// Velocity along the wall.
    pub(crate) tangential: Sum<R>,
    /// Surface speed of the spin.
    pub(crate) spin: Sum<R>,
}

impl<R: Real> WallState<R> {
    /// Velocity of the contact point along the wall: exactly 0 where it rolls.
    pub(crate) fn slip(&self) -> R {
        self.spin.plus(self.tangential.value()) + self.tangential.rest()
    }
}
