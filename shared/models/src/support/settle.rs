//! Two contacts that change each other, solved for in turn.

use crate::vector::Vector;
use touchdown_rotor::real::Real;

/// Part of the product of two changes that must be across each other for both to count.
const LEAST_ACROSS: f64 = 1e-3;

/// A pass: what it started from, and by how much it changed that.
#[derive(Clone, Copy, Debug)]
struct Pass<R> {
    start: Vector<R>,
    changed: Vector<R>,
}

impl<R: Real> Pass<R> {
    fn minus(self, other: Self) -> Self {
        Self {
            start: self.start - other.start,
            changed: self.changed - other.changed,
        }
    }
}

/// Where the next pass starts: where, as the last three tell it, a pass would change nothing (Anderson's
/// rule with all that a plane needs). Passes alone gain 1/(1 + m), m the ring's mass over the rotor's.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Settling<R> {
    last: Option<Pass<R>>,
    before: Option<Pass<R>>,
}

impl<R: Real> Settling<R> {
    /// The next start, where a pass from `start` changed it by `changed`.
    pub(super) fn next(&mut self, start: Vector<R>, changed: Vector<R>) -> Vector<R> {
        let pass = Pass { start, changed };
        let Some(last) = self.last.replace(pass) else {
            return start + changed;
        };
        let now = pass.minus(last);
        let square = now.changed.square();
        if square <= R::ZERO {
            return start + changed;
        }
        if let Some(before) = self.before.replace(now) {
            let across = before.changed.cross(now.changed);
            let least = R::lit(LEAST_ACROSS);
            if across * across > least * least * square * before.changed.square() {
                let old = -changed.cross(now.changed) / across;
                let new = -before.changed.cross(changed) / across;
                return start + before.start.times(old) + now.start.times(new);
            }
        }
        let new = -changed.dot(now.changed) / square;
        start + changed + (now.start + now.changed).times(new)
    }
}
