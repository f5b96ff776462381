//! Ends the swing of held rings across their walls.
//!
//! The midpoint rule ends on the wall, but the mean of two velocities along it does not turn with it: what
//! is missing, of the square of the step, is put into one stretch and taken from the next, and friction
//! lets that swing grow with the angle that is gone. The mean of the speeds across the wall before and
//! after a stretch has no swing; with it contact stays of second order. What that takes is given back
//! along the motion, so that the energy stays.

use super::TwoPlane;
use super::settle::{PASSES, Settling};
use super::state::TwoPlaneState;
use super::vector::Vector;
use crate::model::precision::Precision;

/// Part of the energy up to which it is given back; more is no error of a stretch, and is booked as lost.
const MOST_RETURNED: f64 = 0.01;

/// A held ring after a stretch.
#[derive(Clone, Copy, Debug)]
struct Leaving<R> {
    normal: Vector<R>,
    /// Speed across the wall.
    speed: R,
    /// By how much it is to change.
    change: R,
    /// Impulse along the normal for that.
    push: R,
}

impl<R: Precision, const N: usize> TwoPlane<R, N> {
    pub(super) fn calm(&self, before: &TwoPlaneState<R, N>, state: &mut TwoPlaneState<R, N>) {
        let across = |(place, velocity): (Vector<R>, Vector<R>)| {
            let normal = place.times(R::ONE / place.length());
            (normal, normal.dot(velocity))
        };
        let mut leaving = [None; N];
        for (i, (ring, leaving)) in self.rings.iter().zip(&mut leaving).enumerate() {
            if state.is_held(i) {
                let (normal, speed) = across(state.at(ring.zeta));
                *leaving = Some(Leaving {
                    normal,
                    speed,
                    change: R::HALF * (across(before.at(ring.zeta)).1 - speed),
                    push: R::ZERO,
                });
            }
        }
        self.solve(&mut leaving);
        for (ring, leaving) in self.rings.iter().zip(&leaving) {
            if let Some(leaving) = leaving {
                let push = leaving.normal.times(leaving.push);
                state.velocity[0].add(push);
                state.velocity[1].add(push.times(ring.zeta));
            }
        }
        let mut taken = R::ZERO;
        for (ring, leaving) in self.rings.iter().zip(&leaving) {
            if let Some(leaving) = leaving {
                let after = leaving.normal.dot(state.at(ring.zeta).1);
                taken += -(R::HALF * leaving.push * (leaving.speed + after));
            }
        }
        let velocity = [state.velocity[0].value(), state.velocity[1].value()];
        let left = R::HALF * (velocity[0].square() + velocity[1].square());
        if taken.abs() > R::lit(MOST_RETURNED) * left {
            state.ledger.lost.add(taken);
            return;
        }
        if left <= R::ZERO {
            return;
        }
        let part = taken / left;
        let more = part / (R::ONE + (R::ONE + part).sqrt());
        for (sums, velocity) in state.velocity.iter_mut().zip(velocity) {
            sums.add(velocity.times(more));
        }
    }

    fn solve(&self, leaving: &mut [Option<Leaving<R>>; N]) {
        let mut settling = Settling::new();
        for pass in 1..=PASSES {
            let mut settled = true;
            for (i, ring) in self.rings.iter().enumerate() {
                let Some(own) = leaving.get(i).copied().flatten() else {
                    continue;
                };
                let mut change = own.change;
                for (j, (other, also)) in self.rings.iter().zip(leaving.iter()).enumerate() {
                    if let Some(also) = also.filter(|_| i != j) {
                        let facing = own.normal.dot(also.normal);
                        change += -(Self::mobility(ring, other) * facing * also.push);
                    }
                }
                let push = change / Self::mobility(ring, ring);
                settled &= (push - own.push).abs() <= R::EPSILON * push.abs();
                if let Some(Some(own)) = leaving.get_mut(i) {
                    own.push = push;
                }
            }
            if settled {
                break;
            }
            let pushes =
                leaving.map(|ring| ring.map_or(Vector::default(), |ring| Vector::real(ring.push)));
            let lead = settling.lead(&pushes).filter(|_| pass < PASSES);
            for (ring, lead) in leaving.iter_mut().zip(lead.iter().flatten()) {
                if let Some(ring) = ring {
                    ring.push = lead.x;
                }
            }
        }
    }
}
