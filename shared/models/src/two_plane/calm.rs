//! Keeps held rings on their walls, in place and in speed.
//!
//! The midpoint rule keeps its distance, but the mean of two velocities along the wall does not turn with
//! it: what is missing, of the square of the step, is put into one stretch and taken from the next, and
//! friction lets that swing grow with the angle that is gone. The mean of the speeds across the wall
//! before and after a stretch has no swing; with it contact stays of second order. What that takes is
//! given back along the motion, so that the energy stays.

use super::TwoPlane;
use super::settle::{PASSES, Settling};
use super::state::TwoPlaneState;
use crate::vector::Vector;
use touchdown_rotor::precision::Precision;

/// Part of the energy up to which it is given back; more is no error of a stretch, and stays.
const MOST_RETURNED: f64 = 0.01;

/// Distance from the wall, in units of epsilon and the clearance, from which a held ring is put back.
/// Chosen, because rounding needs thousands of steps to go so far.
const OFF: f64 = 64.0;

/// A held ring.
#[derive(Clone, Copy, Debug)]
struct Across<R> {
    normal: Vector<R>,
    /// Speed across the wall.
    speed: R,
    /// By how much speed, or place, is to change.
    change: R,
    /// Along the normal for that.
    push: R,
}

impl<R: Precision, const N: usize> TwoPlane<R, N> {
    /// Puts held rings onto their walls, where they are not but for rounding: at the start of a contact.
    pub(super) fn seat(&self, state: &mut TwoPlaneState<R, N>) {
        let mut rings = self.across(state);
        let mut off = R::ZERO;
        for (ring, across) in self.rings.iter().zip(&mut rings) {
            if let Some(across) = across {
                across.change = ring.limit - across.normal.dot(state.at(ring.zeta).0);
                off = off.most(across.change.abs() / ring.limit);
            }
        }
        if off <= R::lit(OFF) * R::EPSILON {
            return;
        }
        self.solve(&mut rings);
        let mut seated = *state;
        let mut still = R::ZERO;
        for (ring, across) in self.rings.iter().zip(&rings) {
            if let Some(across) = across {
                let push = across.normal.times(across.push);
                seated.place[0].add(push);
                seated.place[1].add(push.times(ring.zeta));
            }
        }
        for (ring, across) in self.rings.iter().zip(&rings) {
            if across.is_some() {
                let distance = seated.at(ring.zeta).0.length();
                still = still.most((distance / ring.limit - R::ONE).abs());
            }
        }
        // More rings than the rotor can lie on at once.
        if still > off {
            return;
        }
        let (before, after) = (self.energy(state), self.energy(&seated));
        *state = seated;
        let lost = &mut state.ledger.lost;
        lost.add(before.height - after.height);
        lost.add(before.magnets - after.magnets);
    }

    fn across(&self, state: &TwoPlaneState<R, N>) -> [Option<Across<R>>; N] {
        let mut rings = [None; N];
        for (i, (ring, across)) in self.rings.iter().zip(&mut rings).enumerate() {
            if state.is_held(i) {
                let (place, velocity) = state.at(ring.zeta);
                let normal = place.times(R::ONE / place.length());
                *across = Some(Across {
                    normal,
                    speed: normal.dot(velocity),
                    change: R::ZERO,
                    push: R::ZERO,
                });
            }
        }
        rings
    }

    /// Takes the swing across the walls from the velocity, after a stretch.
    pub(super) fn calm(&self, before: &TwoPlaneState<R, N>, state: &mut TwoPlaneState<R, N>) {
        let mut rings = self.across(state);
        for (across, before) in rings.iter_mut().zip(self.across(before)) {
            if let (Some(across), Some(before)) = (across, before) {
                across.change = R::HALF * (before.speed - across.speed);
            }
        }
        self.solve(&mut rings);
        let mut calmed = *state;
        for (ring, across) in self.rings.iter().zip(&rings) {
            if let Some(across) = across {
                let push = across.normal.times(across.push);
                calmed.velocity[0].add(push);
                calmed.velocity[1].add(push.times(ring.zeta));
            }
        }
        let mut taken = R::ZERO;
        for (ring, across) in self.rings.iter().zip(&rings) {
            if let Some(across) = across {
                let after = across.normal.dot(calmed.at(ring.zeta).1);
                taken += -(R::HALF * across.push * (across.speed + after));
            }
        }
        let velocity = [calmed.velocity[0].value(), calmed.velocity[1].value()];
        let left = R::HALF * (velocity[0].square() + velocity[1].square());
        if left <= R::ZERO || taken.abs() > R::lit(MOST_RETURNED) * left {
            return;
        }
        let part = taken / left;
        let more = part / (R::ONE + (R::ONE + part).sqrt());
        for (sums, velocity) in calmed.velocity.iter_mut().zip(velocity) {
            sums.add(velocity.times(more));
        }
        *state = calmed;
    }

    fn solve(&self, rings: &mut [Option<Across<R>>; N]) {
        let mut settling = Settling::new();
        for pass in 1..=PASSES {
            let mut settled = true;
            for (i, ring) in self.rings.iter().enumerate() {
                let Some(own) = rings.get(i).copied().flatten() else {
                    continue;
                };
                let mut change = own.change;
                for (j, (other, also)) in self.rings.iter().zip(rings.iter()).enumerate() {
                    if let Some(also) = also.filter(|_| i != j) {
                        let facing = own.normal.dot(also.normal);
                        change += -(Self::mobility(ring, other) * facing * also.push);
                    }
                }
                let push = change / Self::mobility(ring, ring);
                settled &= (push - own.push).abs() <= R::EPSILON * push.abs();
                if let Some(Some(own)) = rings.get_mut(i) {
                    own.push = push;
                }
            }
            if settled {
                break;
            }
            let pushes =
                rings.map(|ring| ring.map_or(Vector::default(), |ring| Vector::real(ring.push)));
            let lead = settling.lead(&pushes).filter(|_| pass < PASSES);
            for (ring, lead) in rings.iter_mut().zip(lead.iter().flatten()) {
                if let Some(ring) = ring {
                    ring.push = lead.x;
                }
            }
        }
    }
}
