//! The normals of the walls in a stretch, which act along the middle of the places before and after.
//!
//! What a wall presses depends on its normal, and where the stretch ends on what it presses. Normals are put where the
//! stretch asks for them, again and again; where that gains little, as for a light ring between rotor and stop, by
//! Broyden's method (Broyden, "A class of methods for solving nonlinear simultaneous equations", 1965).

use core::array::from_fn;

use super::links::{Links, contact, stop};
use super::passage::REACH;
use super::vector::Vector;
use super::{Coupled, CoupledState};
use touchdown_rotor::precision::Precision;
use touchdown_rotor::real::Real;

/// Most walls: a contact and a stop in each of four rings.
const MOST: usize = 8;
/// Repetitions; a ring of a millionth of the rotor between rotor and stop takes nearly as many.
const NORMALS: usize = 40;

/// Angle up to which its sine stands for it, rad: off by 2e-7 of it.
const SMALL: f64 = 1e-3;

/// An angle of each wall, rad.
type Angles<R> = [R; MOST];

fn dot<R: Real>(a: &Angles<R>, b: &Angles<R>) -> R {
    a.iter().zip(b).fold(R::ZERO, |sum, (a, b)| sum + *a * *b)
}

/// Angle from one direction to another. Both have length 1: its sine tells a small one.
fn apart<R: Real>(from: Vector<R>, to: Vector<R>) -> R {
    let sine = from.cross(to);
    if sine.abs() <= R::lit(SMALL) && from.dot(to) > R::ZERO {
        sine
    } else {
        sine.atan2(from.dot(to))
    }
}

/// How far the normals were off before the last turn, and what turn that calls for.
struct Search<R> {
    off: Angles<R>,
    turn: Angles<R>,
    /// Turn by what is off, once it is not just that.
    inverse: Option<[Angles<R>; MOST]>,
}

impl<R: Real> Search<R> {
    fn new() -> Self {
        Self {
            off: [R::INFINITY; MOST],
            turn: [R::ZERO; MOST],
            inverse: None,
        }
    }

    fn size(off: &Angles<R>) -> R {
        off.iter().fold(R::ZERO, |most, it| most.most(it.abs()))
    }

    /// By how much to turn the normals, `off` from where they should be; none for just that.
    fn next(&mut self, off: Angles<R>) -> Option<Angles<R>> {
        let gains = Self::size(&off) <= R::HALF * Self::size(&self.off);
        if gains && self.inverse.is_none() {
            (self.off, self.turn) = (off, off);
            return None;
        }
        let mut inverse = self.inverse.unwrap_or_else(|| {
            let one = |i| from_fn(|j| if i == j { R::ONE } else { R::ZERO });
            from_fn(one)
        });
        let changed: Angles<R> = from_fn(|i| off[i] - self.off[i]);
        let told: Angles<R> = from_fn(|i| dot(&inverse[i], &changed));
        let weight: Angles<R> =
            from_fn(|j| (0..MOST).fold(R::ZERO, |sum, i| sum + self.turn[i] * inverse[i][j]));
        let size = dot(&self.turn, &told);
        if size != R::ZERO {
            for (i, row) in inverse.iter_mut().enumerate() {
                let missing = -(self.turn[i] + told[i]) / size;
                for (value, weight) in row.iter_mut().zip(&weight) {
                    *value += missing * *weight;
                }
            }
        }
        let turn = from_fn(|i| dot(&inverse[i], &off).within(R::lit(REACH)));
        *self = Self {
            off,
            turn,
            inverse: Some(inverse),
        };
        Some(turn)
    }
}

impl<R: Precision, const N: usize, const Q: usize> Coupled<R, N, Q> {
    /// Finds impulses and normals; false where there are none, or a wall is gone round too far.
    pub(super) fn settle(
        &self,
        state: &CoupledState<R, N, Q>,
        links: &mut Links<R, N>,
        time: R,
    ) -> bool {
        let half = R::HALF * time;
        let surface = |i| links.get(contact(i)).map_or(R::ZERO, |it| it.surface);
        let surfaces: [R; N] = from_fn(surface);
        let mut search = Search::new();
        let (mut changed, mut farthest) = (R::INFINITY, R::INFINITY);
        for _ in 0..NORMALS {
            for i in 0..N {
                if let Some(link) = links.get_mut(contact(i)) {
                    // Friction is for the slip at the end: twice the mean less that at the start.
                    let along = half * link.normal.cross(self.relative(state, i));
                    link.surface = surfaces[i] - along;
                    link.before = half * self.surface(state, i) + along;
                }
            }
            if !links.solve() {
                return false;
            }
            let mut off = [R::ZERO; MOST];
            let mut wanted = [Vector::default(); MOST];
            farthest = R::ZERO;
            for i in 0..N {
                let places = [
                    (contact(i), self.within(state, i)),
                    (stop(i), state.ring_place(i)),
                ];
                for (place, from) in places {
                    let Some(link) = links.get(place) else {
                        continue;
                    };
                    let moved = links.motion(place);
                    farthest = farthest.most(moved.length() / from.length());
                    let sum = from.times(R::TWO) + moved;
                    wanted[place] = sum.times(R::ONE / sum.length());
                    off[place] = apart(link.normal, wanted[place]);
                }
            }
            changed = Search::size(&off);
            changed = changed.most(self.linearize_all(state, links, time));
            let turns = search.next(off);
            for (place, wanted) in wanted.into_iter().enumerate() {
                if let Some(link) = links.get_mut(place) {
                    link.normal = match turns {
                        None => wanted,
                        Some(turns) => {
                            let (sin, cos) = turns[place].sin_cos();
                            link.normal * Vector::new([cos, sin])
                        }
                    };
                }
            }
            if changed <= R::TWO * R::EPSILON {
                break;
            }
        }
        changed * changed <= R::EPSILON && farthest <= R::TWO * R::lit(REACH)
    }

    /// Of all walls and stops that give way; the most.
    fn linearize_all(&self, state: &CoupledState<R, N, Q>, links: &mut Links<R, N>, time: R) -> R {
        let mut most = R::ZERO;
        for (i, ring) in self.rings.iter().enumerate() {
            let soft = ring.mount.as_ref().and_then(|it| it.soft_stop.as_ref());
            if let Some(soft) = soft
                && links.get(stop(i)).is_some()
            {
                let (from, moved) = ((state.ring_place(i), time), links.motion(stop(i)));
                if let Some(link) = links.get_mut(stop(i)) {
                    most = most.most(soft.linearize(link, None, from, moved));
                }
            }
            if ring.compliant.is_some() && links.get(contact(i)).is_some() {
                let moved = links.motion(contact(i));
                if let Some(link) = links.get_mut(contact(i)) {
                    most = most.most(self.linearize(state, i, time, link, moved));
                }
            }
        }
        most
    }
}
