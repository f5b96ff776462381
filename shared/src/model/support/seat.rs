//! Puts rotor and ring onto the walls that hold them, where they are not but for rounding: at the start
//! of a contact, and when rounding has taken them off.

use super::mount::Mount;
use super::race::Race;
use super::{Support, SupportState};
use crate::model::precision::Precision;
use crate::real::Real;

/// What the square of the distance may be off, in units of epsilon.
const OFF: f64 = 64.0;

impl<R: Precision, M: Mount<R>, B: Race<R>> Support<R, M, B> {
    /// What holds, where it is off.
    pub(super) fn seat(&self, state: &mut SupportState<R, M::State, B::State>) {
        let off = R::lit(OFF) * R::EPSILON;
        let distance = state.place.value().square() - R::ONE;
        if state.held.is_some() && distance.abs() > off {
            self.seat_rotor(state);
        }
        let ring = M::place(&state.ring).square();
        let travel = self.mount.travel().filter(|_| M::is_stopped(&state.ring));
        if travel.is_some_and(|travel| (ring - travel * travel).abs() > off * travel * travel) {
            self.seat_ring(state);
        }
    }

    pub(super) fn seat_rotor(&self, state: &mut SupportState<R, M::State, B::State>) {
        let place = state.place.value();
        let moved = place.times(R::ONE / place.length() - R::ONE);
        state.place.add(moved);
        state.lost.add(-(self.law.gravity * moved.y));
    }

    /// With the rotor in it.
    pub(super) fn seat_ring(&self, state: &mut SupportState<R, M::State, B::State>) {
        let moved = self.mount.seat(&mut state.ring);
        state.lost.add(-(self.law.gravity * moved.y));
    }
}
