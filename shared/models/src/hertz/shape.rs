//! The shapes that touch, and the stiffness that they give.

use touchdown_rotor::error::ConfigError;
use touchdown_rotor::real::Real;
use touchdown_rotor::scales::positive;

/// Iterations of the search for a line contact's secant; each gains a digit or more.
const ITERATIONS: usize = 60;

/// Elastic constants of rotor and retainer.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Materials<R> {
    /// Young's modulus of the rotor, Pa.
    pub rotor_modulus: R,
    /// Poisson's ratio of the rotor, 0 to 0.5.
    pub rotor_poisson: R,
    /// Young's modulus of the retainer, Pa.
    pub retainer_modulus: R,
    /// Poisson's ratio of the retainer, 0 to 0.5.
    pub retainer_poisson: R,
}

impl<R: Real> Materials<R> {
    /// Steel on steel, 210 GPa and 0.3: the contact modulus times pi is 3.625e11 Pa.
    pub fn steel() -> Self {
        let (modulus, poisson) = (R::lit(210e9), R::lit(0.3));
        Self {
            rotor_modulus: modulus,
            rotor_poisson: poisson,
            retainer_modulus: modulus,
            retainer_poisson: poisson,
        }
    }

    /// E*, Pa: 1/E* = (1 - nu1^2)/E1 + (1 - nu2^2)/E2.
    pub fn contact_modulus(&self) -> Result<R, ConfigError> {
        positive("rotor_modulus", self.rotor_modulus)?;
        positive("retainer_modulus", self.retainer_modulus)?;
        let ratios = [
            ("rotor_poisson", self.rotor_poisson),
            ("retainer_poisson", self.retainer_poisson),
        ];
        for (name, ratio) in ratios {
            if !(ratio >= R::ZERO && ratio <= R::HALF) {
                return Err(ConfigError::OutOfRange(name, "0 to 0.5"));
            }
        }
        let softness = |modulus: R, poisson: R| (R::ONE - poisson * poisson) / modulus;
        Ok(R::ONE
            / (softness(self.rotor_modulus, self.rotor_poisson)
                + softness(self.retainer_modulus, self.retainer_poisson)))
    }
}

/// What the stiffness follows from, SI.
#[derive(Clone, Copy, Debug)]
pub struct Pairing<R> {
    /// E*, Pa.
    pub modulus: R,
    /// Of the rotor, m.
    pub radius: R,
    /// Radial clearance, m.
    pub clearance: R,
    /// kg.
    pub mass: R,
    /// Of the fastest impact expected, m/s.
    pub speed: R,
}

mod sealed {
    pub trait Sealed {}
    impl Sealed for super::Point {}
    impl<R> Sealed for super::Line<R> {}
}

/// A shape of contact: force over depth is K d^n.
pub trait Shape<R: Real>: sealed::Sealed + Copy {
    /// 2 n: twice the exponent of the force.
    const TWICE_EXPONENT: i32;
    /// Duration of a contact without damping, in units of deepest compression over entry speed.
    const DURATION: f64;

    /// K, N/m^n.
    fn stiffness(&self, pairing: &Pairing<R>) -> Result<R, ConfigError>;

    /// d^n.
    fn power(depth: R) -> R;

    /// n.
    fn exponent() -> R {
        R::HALF * R::from_i32(Self::TWICE_EXPONENT)
    }

    /// The depth whose d^n is `power`; not for the step.
    fn depth(power: R) -> R {
        let root = root(power, Self::TWICE_EXPONENT);
        root * root
    }

    /// The depth whose d^(n+1) is `power`; not for the step.
    fn deepest(power: R) -> R {
        let root = root(power, Self::TWICE_EXPONENT + 2);
        root * root
    }
}

/// A crowned rotor in a crowned ring, as sphere in sphere: Hertz' point contact.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Point;

/// A cylinder in a cylindrical ring.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Line<R> {
    /// Axial length of the contact, m.
    pub length: R,
}

impl<R: Real> Shape<R> for Point {
    const TWICE_EXPONENT: i32 = 3;
    /// 2 times the integral of dx/sqrt(1 - x^2.5) from 0 to 1.
    const DURATION: f64 = 2.943_275_278_886_26;

    /// 4/3 E* sqrt(R_eff), with R_eff = r R/(R - r) and R - r the clearance.
    fn stiffness(&self, pairing: &Pairing<R>) -> Result<R, ConfigError> {
        let outer = pairing.radius + pairing.clearance;
        let curvature = pairing.radius / pairing.clearance * outer;
        Ok(R::lit(4.0 / 3.0) * pairing.modulus * curvature.sqrt())
    }

    fn power(depth: R) -> R {
        depth * depth.sqrt()
    }
}

impl<R: Real> Shape<R> for Line<R> {
    const TWICE_EXPONENT: i32 = 2;
    const DURATION: f64 = core::f64::consts::PI;

    /// The secant, at the peak force F of the fastest impact, of Johnson's approach of a cylinder in a
    /// cylindrical hole, d = F/(pi E* L) (ln(4 pi E* L c/F) - 1), with c the clearance (Contact
    /// Mechanics, 1985, chapter 5; as quoted by Pereira, Ramalho, Ambrosio, Nonlinear Dynamics 63,
    /// 2011). It holds as long as the approach grows with the force: up to a logarithm of 2.
    fn stiffness(&self, pairing: &Pairing<R>) -> Result<R, ConfigError> {
        positive("length", self.length)?;
        let plane = R::lit(core::f64::consts::PI) * pairing.modulus * self.length;
        let largest = R::lit(4.0) * plane * pairing.clearance;
        let peak = |stiffness: R| pairing.speed * (stiffness * pairing.mass).sqrt();
        let mut stiffness = plane;
        for _ in 0..ITERATIONS {
            let logarithm = (largest / peak(stiffness)).ln();
            if logarithm <= R::TWO || !logarithm.is_finite() {
                let rule = "long enough for the force of the fastest impact in this clearance";
                return Err(ConfigError::OutOfRange("length", rule));
            }
            stiffness = plane / (logarithm - R::ONE);
        }
        Ok(stiffness)
    }

    fn power(depth: R) -> R {
        depth
    }
}

/// The positive root of s^`degree` = `value`, for `value` of 0 or more: Newton's method, which falls
/// onto the root once it is above it.
fn root<R: Real>(value: R, degree: i32) -> R {
    const ITERATIONS: usize = 200;
    if value <= R::ZERO {
        return R::ZERO;
    }
    let order = R::from_i32(degree);
    let mut root = value.sqrt().sqrt();
    for _ in 0..ITERATIONS {
        let power = (2..degree).fold(root, |product, _| product * root);
        let next = root - (root - value / power) / order;
        if next <= R::ZERO || next == root {
            break;
        }
        root = next;
    }
    root
}
