//! A stretch of motion before its contacts are known.

use super::Ring;
use crate::vector::Vector;
use touchdown_rotor::real::Real;

/// The inverse of A: symmetric.
#[derive(Clone, Copy, Debug)]
pub(super) struct Inverse<R> {
    pub(super) direct: Vector<R>,
    pub(super) cross: Vector<R>,
    pub(super) tilting: Vector<R>,
}

impl<R: Real> Inverse<R> {
    pub(super) fn apply(&self, [force, moment]: [Vector<R>; 2]) -> [Vector<R>; 2] {
        [
            self.direct * force + self.cross * moment,
            self.cross * force + self.tilting * moment,
        ]
    }

    /// Displacement at ring `to` by a unit at ring `from`.
    pub(super) fn mobility(&self, to: &Ring<R>, from: &Ring<R>) -> Vector<R> {
        self.direct
            + self.cross.times(to.zeta + from.zeta)
            + self.tilting.times(to.zeta * from.zeta)
    }
}

/// What is known of a stretch before the contacts are.
#[derive(Clone, Copy, Debug)]
pub(super) struct Free<R> {
    pub(super) time: R,
    pub(super) inverse: Inverse<R>,
    /// Of p and psi, without contact.
    pub(super) moved: [Vector<R>; 2],
    /// Of their rates.
    pub(super) kick: [Vector<R>; 2],
    /// Mean force and moment of the unbalance.
    pub(super) unbalance: [Vector<R>; 2],
}
