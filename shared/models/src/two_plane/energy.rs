//! What the rotor's energy is, and where it went.

use super::{TwoPlane, TwoPlaneState};
use touchdown_rotor::precision::Precision;
use touchdown_rotor::real::Real;
use touchdown_rotor::sum::Sum;

/// Energy per mass, V^2.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Energy<R> {
    /// Of the centre of mass and of the tilt.
    pub motion: R,
    /// Of the spin.
    pub spin: R,
    /// Against gravity, from the centre.
    pub height: R,
    /// In the magnets' force, from the centre.
    pub magnets: R,
    /// Turned into heat by friction so far.
    pub heat: R,
    /// Lost in impacts so far.
    pub lost: R,
    /// Given by the drive that keeps an unbalanced rotor's spin, so far.
    pub driven: R,
}

impl<R: Real> Energy<R> {
    /// Energy in the rotor.
    pub fn stored(&self) -> R {
        self.motion + self.height + self.magnets + self.spin
    }

    /// Stored and gone, without what came in: the same at all times.
    pub fn total(&self) -> R {
        let mut sum = Sum::new(self.spin);
        for part in [self.motion, self.height, self.magnets] {
            sum.add(part);
        }
        for part in [self.heat, self.lost, -self.driven] {
            sum.add(part);
        }
        sum.value()
    }
}

impl<R: Real> Energy<R> {
    /// Every number widened.
    pub fn to_f64(&self) -> Energy<f64> {
        Energy {
            motion: self.motion.to_f64(),
            spin: self.spin.to_f64(),
            height: self.height.to_f64(),
            magnets: self.magnets.to_f64(),
            heat: self.heat.to_f64(),
            lost: self.lost.to_f64(),
            driven: self.driven.to_f64(),
        }
    }
}

impl<R: Precision, const N: usize> TwoPlane<R, N> {
    /// The energy now, and what became of the rest.
    pub fn energy(&self, state: &TwoPlaneState<R, N>) -> Energy<R> {
        let [velocity, rate] = [&state.velocity[0], &state.velocity[1]].map(|v| v.value());
        let spin = state.spin.value();
        let magnets = self.magnets.iter().fold(R::ZERO, |sum, magnet| {
            let place = state.at(magnet.zeta).0;
            sum - R::HALF * magnet.stiffness * place.square() - magnet.force.dot(place)
        });
        Energy {
            motion: R::HALF * (velocity.square() + rate.square()),
            spin: R::HALF * self.inertia_ratio * spin * spin,
            height: -self.gravity.dot(state.place[0].value()),
            magnets,
            heat: state.ledger.heat.value(),
            lost: state.ledger.lost.value(),
            driven: state.ledger.driven.value(),
        }
    }
}
