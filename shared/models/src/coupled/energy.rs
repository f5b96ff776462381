//! Where the energy is, and where it went.

use super::{Coupled, CoupledState};
use touchdown_rotor::precision::Precision;
use touchdown_rotor::real::Real;
use touchdown_rotor::sum::Sum;

/// Energy over the rotor's mass, V^2.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct CoupledEnergy<R> {
    /// Of centre, tilt and bending.
    pub motion: R,
    /// Of the spin.
    pub spin: R,
    /// Against gravity, from the centre.
    pub height: R,
    /// In the magnets' force.
    pub magnets: R,
    /// In the bent rotor.
    pub bending: R,
    /// In walls that give way.
    pub contacts: R,
    /// Of the rings' motion.
    pub rings: R,
    /// In the rings' springs.
    pub springs: R,
    /// Of the inner rings.
    pub races: R,
    /// Turned into heat by friction so far.
    pub heat: R,
    /// Lost in impacts so far, and by what puts the rotor back onto a wall that it is not quite on.
    pub lost: R,
    /// Taken by the rings' dampers so far.
    pub mounts: R,
    /// Taken by the hard stops so far.
    pub stops: R,
    /// Taken by the drag of the ball bearings so far.
    pub drag: R,
    /// Taken so far by the damping of modes and magnets.
    pub damped: R,
    /// Given so far by the drive that keeps an unbalanced rotor's spin, by the base's motion, and by switched magnets.
    pub driven: R,
}

impl<R: Real> CoupledEnergy<R> {
    /// Energy that is there.
    pub fn stored(&self) -> R {
        let rotor = [
            self.spin,
            self.motion,
            self.height,
            self.magnets,
            self.bending,
        ];
        sum(rotor) + sum([self.contacts, self.rings, self.springs, self.races])
    }

    /// Stored and gone, without what came in: the same at all times.
    pub fn total(&self) -> R {
        let gone = [self.heat, self.lost, self.mounts, self.stops, self.drag];
        self.stored() + sum(gone) + self.damped - self.driven
    }

    /// Every number widened.
    pub fn to_f64(&self) -> CoupledEnergy<f64> {
        CoupledEnergy {
            motion: self.motion.to_f64(),
            spin: self.spin.to_f64(),
            height: self.height.to_f64(),
            magnets: self.magnets.to_f64(),
            bending: self.bending.to_f64(),
            contacts: self.contacts.to_f64(),
            rings: self.rings.to_f64(),
            springs: self.springs.to_f64(),
            races: self.races.to_f64(),
            heat: self.heat.to_f64(),
            lost: self.lost.to_f64(),
            mounts: self.mounts.to_f64(),
            stops: self.stops.to_f64(),
            drag: self.drag.to_f64(),
            damped: self.damped.to_f64(),
            driven: self.driven.to_f64(),
        }
    }
}

fn sum<R: Real, const K: usize>(parts: [R; K]) -> R {
    let mut sum = Sum::default();
    for part in parts {
        sum.add(part);
    }
    sum.value()
}

impl<R: Precision, const N: usize, const Q: usize> Coupled<R, N, Q> {
    /// The energy now, and what became of the rest.
    pub fn energy(&self, state: &CoupledState<R, N, Q>) -> CoupledEnergy<R> {
        let (places, velocities) = (state.places(), state.velocities());
        let spin = state.spin.value();
        let books = &state.books;
        let mut energy = CoupledEnergy {
            spin: R::HALF * self.inertia_ratio * spin * spin,
            height: -self.gravity.dot(places[0]),
            heat: books.heat.value(),
            lost: books.lost.value(),
            damped: books.damped.value(),
            driven: books.driven.value(),
            ..CoupledEnergy::default()
        };
        for ((x, v), frequency) in places.iter().zip(&velocities).zip(&self.frequency) {
            energy.motion += R::HALF * v.square();
            energy.bending += R::HALF * *frequency * *frequency * x.square();
        }
        energy.magnets = self.in_magnets(state, &state.on);
        for (ring, seat) in self.rings.iter().zip(&state.seats) {
            let soft = seat.held.as_ref().and_then(|it| it.soft.as_ref());
            energy.contacts += soft.map_or(R::ZERO, |it| it.stored);
            if let Some(mount) = &ring.mount {
                let [motion, spring, taken, stop] = mount.energy(&seat.mount);
                energy.rings += motion;
                energy.springs += spring;
                energy.mounts += taken;
                energy.stops += stop;
            }
            if let Some(race) = &ring.race {
                let [motion, drag] = race.energy(&seat.race);
                energy.races += motion;
                energy.drag += drag;
            }
        }
        energy
    }
}
