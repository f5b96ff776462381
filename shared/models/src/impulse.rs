//! The impact law between bodies of any mobility.
//!
//! [`Law`](super::law::Law) is the same law for one rotor in a ring that does not move.

use touchdown_rotor::real::Real;

/// Velocity gained by a unit of impulse: along the wall's normal, and along the wall with what the
/// impulse does to the spins.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Mobility<R> {
    pub(crate) normal: R,
    pub(crate) tangential: R,
}

/// What the wall gives to the rotor.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct Impulse<R> {
    /// Away from the wall, 0 or more.
    pub(crate) normal: R,
    /// Along the wall, counter-clockwise.
    pub(crate) tangential: R,
    /// Whether friction stopped the slip.
    pub(crate) stuck: bool,
}

impl<R: Real> Mobility<R> {
    /// Impact at `speed` into the wall (> 0) with this slip. Friction stops the slip, limited to
    /// Coulomb's part of the normal impulse.
    pub(crate) fn strike(&self, restitution: R, friction: R, speed: R, slip: R) -> Impulse<R> {
        let normal = (R::ONE + restitution) * speed / self.normal;
        let stick = -slip / self.tangential;
        let limit = friction * normal;
        Impulse {
            normal,
            tangential: stick.within(limit),
            stuck: stick.abs() <= limit,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use touchdown_rotor::law::Law;
    use touchdown_rotor::sum::Sum;

    #[test]
    fn a_rotor_in_a_fixed_ring_follows_the_planar_law() {
        for (friction, stuck) in [(0.05, false), (5.0, true)] {
            let law: Law<f64> = Law {
                friction,
                restitution: 0.8,
                inertia_ratio: 0.5,
                gravity: 1.0,
            };
            let (speed, tangential, surface) = (1.3, -0.4, 7.0);
            let mut spin = Sum::new(surface);
            let planar = law.collide(speed, tangential, &mut spin);
            let mobility = Mobility {
                normal: 1.0,
                tangential: 1.0 + 1.0 / law.inertia_ratio,
            };
            let impulse = mobility.strike(0.8, friction, speed, tangential + surface);
            assert_eq!(impulse.stuck, stuck);
            assert_eq!(planar.stuck, stuck);
            assert!((speed - impulse.normal + planar.launch_speed).abs() < 1e-15);
            assert!((tangential + impulse.tangential - planar.tangential).abs() < 1e-15);
            let turned = surface + impulse.tangential / law.inertia_ratio;
            assert!((turned - spin.value()).abs() < 1e-14);
        }
    }
}
