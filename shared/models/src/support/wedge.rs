//! A light ring that wedges between rotor and stop.
//!
//! The stop has no friction. Where the rotor's push on the ring leans by less than the angle of friction
//! from the stop's normal, each push of the rotor calls for a larger one of the stop, and that for a larger
//! one of the rotor, if the ring is lighter than about mu^2/4 of the rotor: rigid bodies then have no
//! answer, or one that gains energy (Painleve's paradox). Rotor and stop are then solved for without
//! friction, and friction follows: between the rotor and a ring that the stop holds, limited by the
//! normal impulse. Both can only lose energy.

use super::mount::Mount;
use super::race::Race;
use super::{Support, SupportState};
use crate::vector::Vector;
use touchdown_rotor::precision::Precision;

impl<R: Precision, M: Mount<R>, B: Race<R>> Support<R, M, B> {
    /// Friction by a normal impulse that is past; whether it stopped the slip.
    pub(super) fn wedge(
        &self,
        state: &mut SupportState<R, M::State, B::State>,
        normal: Vector<R>,
        impulse: R,
    ) -> bool {
        let mobility = R::ONE + R::ONE / self.law.inertia_ratio + self.race.mobility();
        let surface = state.spin.value() - B::surface(&state.race);
        let slip = normal.cross(state.velocity.value()) + surface;
        let stick = -slip / mobility;
        let limit = self.law.friction * impulse;
        let rub = stick.within(limit);
        let heat = -(rub * (slip + R::HALF * mobility * rub));
        state.velocity.add(normal.turned().times(rub));
        state.spin.add(rub / self.law.inertia_ratio);
        self.race.strike(&mut state.race, rub, heat);
        state.heat.add(heat);
        stick.abs() <= limit
    }
}
