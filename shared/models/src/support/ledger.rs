//! Where the energy is, and where it went.

use super::mount::Mount;
use super::race::Race;
use super::{Support, SupportState};
use touchdown_rotor::precision::Precision;
use touchdown_rotor::real::Real;
use touchdown_rotor::sum::Sum;

/// Energy over the rotor's mass, V^2. What went is impulse times mean velocity of each stretch of
/// a step, so that the total is the same at all times but for rounding.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Ledger<R> {
    /// Of the rotor's centre.
    pub motion: R,
    /// Of its spin.
    pub spin: R,
    /// Against gravity, from the retainer's centre at rest.
    pub height: R,
    /// Of the ring's motion.
    pub ring: R,
    /// In the support's spring.
    pub spring: R,
    /// Of the inner ring.
    pub race: R,
    /// Turned into heat by friction so far.
    pub heat: R,
    /// Lost by restitution so far, and by what puts the rotor back onto a wall that it is not quite on.
    pub lost: R,
    /// Taken by the support's damper so far, and by the support in impacts that are shorter than it moves.
    pub damped: R,
    /// Taken by the hard stop so far.
    pub stop: R,
    /// Taken by the drag of the ball bearing so far.
    pub drag: R,
}

impl<R: Real> Ledger<R> {
    /// Energy that is still there.
    pub fn stored(&self) -> R {
        sum([
            self.spin,
            self.motion,
            self.height,
            self.ring,
            self.spring,
            self.race,
        ])
    }

    /// Energy that went so far.
    pub fn dissipated(&self) -> R {
        sum([self.heat, self.lost, self.damped, self.stop, self.drag])
    }

    /// Both: the same at all times.
    pub fn total(&self) -> R {
        self.stored() + self.dissipated()
    }
}

impl<R: Real> Ledger<R> {
    /// Every number widened.
    pub fn to_f64(&self) -> Ledger<f64> {
        Ledger {
            motion: self.motion.to_f64(),
            spin: self.spin.to_f64(),
            height: self.height.to_f64(),
            ring: self.ring.to_f64(),
            spring: self.spring.to_f64(),
            race: self.race.to_f64(),
            heat: self.heat.to_f64(),
            lost: self.lost.to_f64(),
            damped: self.damped.to_f64(),
            stop: self.stop.to_f64(),
            drag: self.drag.to_f64(),
        }
    }
}

fn sum<R: Real, const N: usize>(parts: [R; N]) -> R {
    let mut sum = Sum::default();
    for part in parts {
        sum.add(part);
    }
    sum.value()
}

impl<R: Precision, M: Mount<R>, B: Race<R>> Support<R, M, B> {
    /// The energy now, and what became of the rest.
    pub fn ledger(&self, state: &SupportState<R, M::State, B::State>) -> Ledger<R> {
        let spin = state.spin.value();
        let place = state.place.value() + M::place(&state.ring);
        let [ring, spring, damped, stop] = self.mount.energy(&state.ring);
        let [race, drag] = self.race.energy(&state.race);
        Ledger {
            motion: R::HALF * state.velocity.value().square(),
            spin: R::HALF * self.law.inertia_ratio * spin * spin,
            height: self.law.gravity * place.y,
            ring,
            spring,
            race,
            heat: state.heat.value(),
            lost: state.lost.value(),
            damped,
            stop,
            drag,
        }
    }
}
