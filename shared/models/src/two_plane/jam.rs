//! Rings that jam: with much friction in several of them the contact laws, taken for all rings at once,
//! may have no solution, or one that gains energy. Taken one after the other they always have one that
//! does not.

use super::passage::Passage;
use super::state::TwoPlaneState;
use super::strike::ActiveContact;
use super::{Ring, TwoPlane};
use crate::impulse::{Impulse, Mobility};
use crate::vector::Vector;
use touchdown_rotor::precision::Precision;

/// Passes over the rings, one impact each.
const PASSES: usize = 16;

impl<R: Precision, const N: usize> TwoPlane<R, N> {
    /// The impacts one after the other, the first of each ring with its restitution.
    pub(super) fn strike_in_turn(
        &self,
        state: &mut TwoPlaneState<R, N>,
        meetings: &mut [Option<ActiveContact<R>>; N],
    ) {
        for meeting in meetings.iter_mut().flatten() {
            meeting.impulse = Impulse::default();
        }
        for pass in 0..PASSES {
            let mut moved = false;
            for (ring, meeting) in self.rings.iter().zip(meetings.iter_mut()) {
                let Some(meeting) = meeting else {
                    continue;
                };
                let velocity = state.at(ring.zeta).1;
                let speed = meeting.normal.dot(velocity);
                if speed <= R::ZERO {
                    continue;
                }
                let restitution = if pass == 0 {
                    meeting.restitution
                } else {
                    R::ZERO
                };
                let slip = meeting.normal.cross(velocity) + ring.surface * state.spin.value();
                let impulse =
                    self.own_mobility(ring)
                        .strike(restitution, ring.friction, speed, slip);
                self.give(state, ring, meeting.normal, impulse);
                meeting.impulse.normal += impulse.normal;
                meeting.impulse.tangential += impulse.tangential;
                meeting.impulse.stuck = impulse.stuck;
                moved = true;
            }
            if !moved {
                return;
            }
        }
    }

    /// Friction of a stretch that was gone without it, limited by the normal impulses there.
    pub(super) fn rub_in_turn(&self, state: &mut TwoPlaneState<R, N>, passage: &Passage<R, N>) {
        for (ring, press) in self.rings.iter().zip(&passage.presses) {
            let Some(press) = press else {
                continue;
            };
            let (place, velocity) = state.at(ring.zeta);
            let normal = place.times(R::ONE / place.length());
            let slip = normal.cross(velocity) + ring.surface * state.spin.value();
            let most = ring.friction * R::TWO * press.pressed / passage.free.time;
            let stick = -slip / self.own_mobility(ring).tangential;
            let impulse = Impulse {
                normal: R::ZERO,
                tangential: stick.within(most),
                stuck: stick.abs() <= most,
            };
            self.give(state, ring, normal, impulse);
        }
    }

    pub(super) fn own_mobility(&self, ring: &Ring<R>) -> Mobility<R> {
        let normal = Self::mobility(ring, ring);
        Mobility {
            normal,
            tangential: normal + self.spin_mobility(ring, ring),
        }
    }

    /// One impulse, and its work.
    fn give(
        &self,
        state: &mut TwoPlaneState<R, N>,
        ring: &Ring<R>,
        normal: Vector<R>,
        impulse: Impulse<R>,
    ) {
        let before = (state.at(ring.zeta).1, state.spin.value());
        let push = Vector::new([-impulse.normal, impulse.tangential]) * normal;
        state.velocity[0].add(push);
        state.velocity[1].add(push.times(ring.zeta));
        let turned = ring.surface * impulse.tangential / self.inertia_ratio;
        state.spin.add(turned);
        let mean = (before.0 + state.at(ring.zeta).1).times(R::HALF);
        let spin = R::HALF * (before.1 + state.spin.value());
        let slip = normal.cross(mean) + ring.surface * spin;
        state.ledger.lost.add(impulse.normal * normal.dot(mean));
        state.ledger.heat.add(-(impulse.tangential * slip));
    }
}
