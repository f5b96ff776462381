//! The wall that a stretch goes beyond, and when: the square of the distance is taken for a parabola through its value
//! and slope before and its value after.

use super::passage::Passage;
use super::vector::Vector;
use super::{Coupled, CoupledState, at};
use touchdown_rotor::precision::Precision;
use touchdown_rotor::real::Real;

/// Distance from a wall, in units of epsilon and its radius, that counts as on it.
const ON_WALL: f64 = 64.0;

/// What the square of the distance from a wall of radius 1 may lack of being on it.
pub(super) fn on_wall<R: Real>() -> R {
    R::lit(ON_WALL) * R::EPSILON
}

/// Who arrived at which wall.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Arrival {
    Axis(usize),
    Ring(usize),
}

/// The wall that a stretch goes beyond.
#[derive(Clone, Copy, Debug)]
pub(super) struct Beyond<R> {
    pub(super) who: Arrival,
    /// Part of the stretch until then.
    pub(super) share: R,
    /// Whether it is there before the stretch begins.
    pub(super) now: bool,
}

/// What is free inside a wall during a stretch.
struct Flyer<R> {
    who: Arrival,
    place: Vector<R>,
    moved: Vector<R>,
    velocity: Vector<R>,
    /// Change of the velocity.
    kick: Vector<R>,
    radius: R,
}

impl<R: Precision> Flyer<R> {
    fn beyond(&self, time: R) -> Option<Beyond<R>> {
        let square = self.radius * self.radius;
        let end = self.place + self.moved;
        let over = end.square() - square;
        let value = self.place.square() - square;
        let near = on_wall::<R>() * square;
        let inward = end.dot(self.velocity + self.kick) <= R::ZERO;
        if over <= R::ZERO || (inward && over <= value.most(R::ZERO) + near) {
            return None;
        }
        let outward = self.place.dot(self.velocity);
        Some(Beyond {
            who: self.who,
            share: crossing(value, R::TWO * time * outward, over),
            now: value >= -near && outward > R::ZERO,
        })
    }
}

/// Where the parabola with this value and slope at 0 and this value (> 0) at 1 rises through 0; its
/// lowest point if it never is below. 0 to 1.
fn crossing<R: Real>(value: R, slope: R, end: R) -> R {
    let bend = end - value - slope;
    let discriminant = slope * slope - R::lit(4.0) * bend * value;
    let share = if discriminant <= R::ZERO {
        -slope / (R::TWO * bend)
    } else if slope > R::ZERO {
        -R::TWO * value / (slope + discriminant.sqrt())
    } else {
        (discriminant.sqrt() - slope) / (R::TWO * bend)
    };
    share.most(R::ZERO).least(R::ONE)
}

impl<R: Precision, const N: usize, const Q: usize> Coupled<R, N, Q> {
    /// The first wall that the stretch goes beyond.
    pub(super) fn beyond(
        &self,
        state: &CoupledState<R, N, Q>,
        passage: &Passage<R, N, Q>,
    ) -> Option<Beyond<R>> {
        let mut first: Option<Beyond<R>> = None;
        for (i, ring) in self.rings.iter().enumerate() {
            let (ring_moved, ring_kick) = (passage.ring_moved(i), passage.ring_kick(i));
            let axis = (!state.is_held(i)).then(|| Flyer {
                who: Arrival::Axis(i),
                place: self.within(state, i),
                moved: at(&ring.shape, &passage.moved) - ring_moved,
                velocity: self.relative(state, i),
                kick: at(&ring.shape, &passage.kick) - ring_kick,
                radius: ring.limit,
            });
            let travel = ring.mount.as_ref().and_then(|mount| mount.travel);
            let travel = travel.filter(|_| !state.is_stopped(i));
            let stop = travel.map(|radius| Flyer {
                who: Arrival::Ring(i),
                place: state.ring_place(i),
                moved: ring_moved,
                velocity: state.ring_velocity(i),
                kick: ring_kick,
                radius,
            });
            for flyer in [axis, stop].into_iter().flatten() {
                let beyond = flyer.beyond(passage.time);
                let earlier = |it: &Beyond<R>| first.is_none_or(|first| it.share < first.share);
                first = beyond.filter(earlier).or(first);
            }
        }
        first
    }
}
