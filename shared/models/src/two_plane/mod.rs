//! Rung `two-plane`: a rigid rotor that moves across its axis and tilts, in rings of their own axial
//! places.
//!
//! Displacement at the axial place z is p + z a, with p of the centre of mass and a = (theta_y,
//! -theta_x). In units of the model psi = a k/rho0 and zeta = z/k with k = sqrt(J_t/m): the
//! displacement is p + zeta psi, the energy (|p'|^2 + |psi'|^2)/2 per mass, and an impulse at zeta_i
//! moves zeta_j by 1 + zeta_i zeta_j. Vectors are complex numbers x + i y; free tilt obeys psi'' = i
//! (J_p/J_t) w psi'.
//!
//! Solved by time-stepping: the midpoint rule for all that is smooth (`passage`), with the rings that
//! are in permanent contact held on their walls in it (`press`); impacts at the moments that a step
//! shows (`follow`), all rings that touch at once together (`strike`). Without friction and with
//! restitution 1 the energy and the angular momentum about the axis are kept to rounding.

mod calm;
mod config;
mod ends;
mod energy;
mod follow;
mod free;
mod jam;
mod passage;
mod press;
mod settle;
mod state;
mod strike;

pub use config::{MagnetConfig, RingConfig, TwoPlaneConfig, UnbalanceConfig};
pub use ends::Ends;
pub use energy::Energy;
pub use state::{Placement, TwoPlaneState};

use crate::vector::Vector;
use touchdown_rotor::precision::Precision;
use touchdown_rotor::real::Real;
use touchdown_rotor::scales::Scales;

#[derive(Clone, Copy, Debug, PartialEq)]
struct Ring<R> {
    /// Axial place, k.
    zeta: R,
    /// Clearance, of the first ring's.
    limit: R,
    /// Rotor radius, of the first ring's.
    surface: R,
    friction: R,
    restitution: R,
}

#[derive(Clone, Copy, Debug, PartialEq)]
struct Magnet<R> {
    zeta: R,
    stiffness: R,
    force: Vector<R>,
}

#[derive(Clone, Copy, Debug, PartialEq)]
struct Unbalance<R> {
    /// Eccentricity, rho0, on the rotor.
    weight: Vector<R>,
    /// (1 - J_p/J_t) times the skew in units of psi, on the rotor.
    couple: Vector<R>,
}

/// Coefficients of the model; `N` rings.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TwoPlane<R, const N: usize> {
    rings: [Ring<R>; N],
    /// J_p/(m r^2) at the first ring.
    inertia_ratio: R,
    /// Rate of nutation for a spin of 1.
    gyration: R,
    /// Angular speed of a spin of 1.
    turn: R,
    gravity: Vector<R>,
    magnets: [Magnet<R>; 2],
    unbalance: Unbalance<R>,
    /// Length of a step, T.
    step: R,
    /// Tilt of psi = 1, rad.
    tilt: R,
    scales: Scales<R>,
}

impl<R: Precision, const N: usize> TwoPlane<R, N> {
    /// The model's units, those of the first ring.
    pub fn scales(&self) -> &Scales<R> {
        &self.scales
    }

    /// Unit of the tilt, rad: the tilt that displaces the rotor by a clearance at zeta = 1.
    pub fn tilt_scale(&self) -> R {
        self.tilt
    }

    /// An axial place (m from the centre of mass) in units of the radius of gyration.
    pub fn zeta(&self, place: R) -> R {
        place * self.tilt / self.scales.length
    }

    /// Angular speed (rad/T) of a spin given as surface speed at the first ring.
    pub fn angular_speed(&self, spin: R) -> R {
        self.turn * spin
    }

    /// Of the magnets: force over p, force over psi (and moment over p), moment over psi.
    fn stiffness(&self) -> [R; 3] {
        let mut sum = [R::ZERO; 3];
        for magnet in &self.magnets {
            sum[0] += magnet.stiffness;
            sum[1] += magnet.stiffness * magnet.zeta;
            sum[2] += magnet.stiffness * magnet.zeta * magnet.zeta;
        }
        sum
    }

    /// Constant force, and constant moment.
    fn load(&self) -> [Vector<R>; 2] {
        let mut load = [self.gravity, Vector::default()];
        for magnet in &self.magnets {
            load[0] = load[0] + magnet.force;
            load[1] = load[1] + magnet.force.times(magnet.zeta);
        }
        load
    }

    /// Velocity gained at ring `to` by a unit of impulse at ring `from`.
    fn mobility(to: &Ring<R>, from: &Ring<R>) -> R {
        R::ONE + to.zeta * from.zeta
    }

    /// Surface speed gained at ring `to` by a unit of tangential impulse at ring `from`.
    fn spin_mobility(&self, to: &Ring<R>, from: &Ring<R>) -> R {
        to.surface * from.surface / self.inertia_ratio
    }
}

impl<const N: usize> TwoPlane<f64, N> {
    /// The same model with every coefficient rounded once.
    pub fn rounded<R: Real>(&self) -> TwoPlane<R, N> {
        let vector = |v: Vector<f64>| Vector::new(v.parts().map(R::lit));
        TwoPlane {
            rings: self.rings.map(|ring| Ring {
                zeta: R::lit(ring.zeta),
                limit: R::lit(ring.limit),
                surface: R::lit(ring.surface),
                friction: R::lit(ring.friction),
                restitution: R::lit(ring.restitution),
            }),
            inertia_ratio: R::lit(self.inertia_ratio),
            gyration: R::lit(self.gyration),
            turn: R::lit(self.turn),
            gravity: vector(self.gravity),
            magnets: self.magnets.map(|magnet| Magnet {
                zeta: R::lit(magnet.zeta),
                stiffness: R::lit(magnet.stiffness),
                force: vector(magnet.force),
            }),
            unbalance: Unbalance {
                weight: vector(self.unbalance.weight),
                couple: vector(self.unbalance.couple),
            },
            step: R::lit(self.step),
            tilt: R::lit(self.tilt),
            scales: self.scales.rounded(),
        }
    }
}
