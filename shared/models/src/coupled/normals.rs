//! The normals of the walls in a stretch, which act along the middle of the places before and after.
//!
//! What a wall presses depends on its normal, and where the stretch ends on what it presses: a light ring goes
//! round by more than its normal turns. Each normal is turned to where it should be, by a secant where that gains
//! little.

use super::passage::{REACH, Walls};
use super::vector::Vector;
use super::{Coupled, CoupledState};
use touchdown_rotor::precision::Precision;
use touchdown_rotor::real::Real;

/// Repetitions.
const NORMALS: usize = 20;
/// Least change of what is off by a turn for a secant.
const LEAST_SLOPE: f64 = 0.1;

/// The last turn of a normal, and how far off it was before, rad.
#[derive(Clone, Copy, Debug, Default)]
struct Search<R> {
    turn: R,
    off: R,
}

impl<R: Real> Search<R> {
    /// By how much to turn it, `off` from where it should be.
    fn next(&mut self, off: R) -> R {
        let slow = self.turn != R::ZERO && off.abs() > R::HALF * self.off.abs();
        let slope = (off - self.off) / self.turn;
        let turn = if slow && slope.abs() > R::lit(LEAST_SLOPE) {
            (-off / slope).within(R::lit(REACH))
        } else {
            off
        };
        *self = Self { turn, off };
        turn
    }
}

impl<R: Precision, const N: usize, const Q: usize> Coupled<R, N, Q> {
    /// Finds impulses and normals; false where there are none, or a wall is gone round too far.
    pub(super) fn settle(&self, state: &CoupledState<R, N, Q>, walls: &mut Walls<R, N>) -> bool {
        let half = R::HALF * walls.time;
        let surfaces: [R; N] = core::array::from_fn(|i| {
            let link = walls.contacts[i].and_then(|it| walls.links.get(it));
            link.map_or(R::ZERO, |link| link.surface)
        });
        let mut searches = [[Search::default(); 2]; N];
        let (mut changed, mut farthest) = (R::INFINITY, R::INFINITY);
        for _ in 0..NORMALS {
            for i in 0..N {
                if let Some(link) = walls.contacts[i].and_then(|it| walls.links.get_mut(it)) {
                    // Friction is for the slip at the end: twice the mean less that at the start.
                    let along = half * link.normal.cross(self.relative(state, i));
                    link.surface = surfaces[i] - along;
                    link.before = half * self.surface(state, i) + along;
                }
            }
            if !walls.links.solve() {
                return false;
            }
            (changed, farthest) = (R::ZERO, R::ZERO);
            for (i, searches) in searches.iter_mut().enumerate() {
                let places = [walls.contacts[i], walls.stops[i]];
                let from = [self.within(state, i), state.ring_place(i)];
                for ((place, from), search) in places.into_iter().zip(from).zip(searches) {
                    let Some(place) = place else {
                        continue;
                    };
                    let moved = walls.links.motion(place);
                    farthest = farthest.most(moved.length() / from.length());
                    let sum = from.times(R::TWO) + moved;
                    if let Some(link) = walls.links.get_mut(place) {
                        let off = link.normal.cross(sum).atan2(link.normal.dot(sum));
                        changed = changed.most(off.abs());
                        let (sin, cos) = search.next(off).sin_cos();
                        link.normal = link.normal * Vector::new([cos, sin]);
                    }
                }
            }
            if changed <= R::TWO * R::EPSILON {
                break;
            }
        }
        changed * changed <= R::EPSILON && farthest <= R::TWO * R::lit(REACH)
    }
}
