//! Two contacts that change each other, solved for in turn.

use crate::model::vector::Vector;
use crate::real::Real;

/// Most that a pass goes on beyond what it found. Chosen, because a ring of 1e-6 of the rotor's mass needs it.
const MOST_AHEAD: f64 = 1e9;

/// Where the next pass starts, by Aitken's rule: from the last two passes as if each shortened the
/// way left by the same factor.
#[derive(Clone, Copy, Debug)]
pub(super) struct Settling<R> {
    last: Option<Vector<R>>,
    factor: R,
}

impl<R: Real> Settling<R> {
    pub(super) fn new() -> Self {
        Self {
            last: None,
            factor: R::ONE,
        }
    }

    /// What to add, where a pass changed its start by `changed`.
    pub(super) fn next(&mut self, changed: Vector<R>) -> Vector<R> {
        if let Some(last) = self.last {
            let gained = last - changed;
            let square = gained.square();
            if square > R::ZERO {
                let factor = self.factor * last.dot(gained) / square;
                self.factor = factor.most(R::ONE).least(R::lit(MOST_AHEAD));
            }
        }
        self.last = Some(changed);
        changed.times(self.factor)
    }
}
