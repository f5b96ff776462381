//! The shapes that touch, and the stiffness that they give.

use core::f64::consts::{FRAC_PI_2, PI};

use touchdown_rotor::error::ConfigError;
use touchdown_rotor::real::Real;
use touchdown_rotor::scales::positive;

/// Of Newton's method for its force: the third is exact to rounding.
const POLISHINGS: usize = 3;

/// Elastic constants of rotor and retainer.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Materials {
    /// Young's modulus of the rotor, Pa.
    pub rotor_modulus: f64,
    /// Poisson's ratio of the rotor, 0 to 0.5.
    pub rotor_poisson: f64,
    /// Young's modulus of the retainer, Pa.
    pub retainer_modulus: f64,
    /// Poisson's ratio of the retainer, 0 to 0.5.
    pub retainer_poisson: f64,
}

impl Materials {
    /// Steel on steel, 210 GPa and 0.3: the contact modulus times pi is 3.625e11 Pa.
    pub const fn steel() -> Self {
        Self {
            rotor_modulus: 210e9,
            rotor_poisson: 0.3,
            retainer_modulus: 210e9,
            retainer_poisson: 0.3,
        }
    }

    /// E*, Pa: 1/E* = (1 - nu1^2)/E1 + (1 - nu2^2)/E2.
    pub fn contact_modulus(&self) -> Result<f64, ConfigError> {
        positive("rotor_modulus", self.rotor_modulus)?;
        positive("retainer_modulus", self.retainer_modulus)?;
        let ratios = [
            ("rotor_poisson", self.rotor_poisson),
            ("retainer_poisson", self.retainer_poisson),
        ];
        for (name, ratio) in ratios {
            if !(0.0..=0.5).contains(&ratio) {
                return Err(ConfigError::OutOfRange(name, "0 to 0.5"));
            }
        }
        let softness = |modulus: f64, poisson: f64| (1.0 - poisson * poisson) / modulus;
        Ok(1.0
            / (softness(self.rotor_modulus, self.rotor_poisson)
                + softness(self.retainer_modulus, self.retainer_poisson)))
    }
}

/// How rotor and retainer touch.
#[derive(Clone, Copy, Debug, PartialEq, strum::Display)]
#[strum(serialize_all = "kebab-case")]
pub enum Contact {
    /// A crowned rotor in a crowned ring, as sphere in sphere: Hertz' point contact.
    Point,
    /// A cylinder in a cylindrical ring.
    Line {
        /// Axial, m.
        length: f64,
    },
    /// The same as a spring: its secant at the peak force of the fastest impact.
    LinePower {
        /// Axial, m.
        length: f64,
    },
}

impl Contact {
    /// How its force grows.
    pub const fn shape(self) -> Shape {
        match self {
            Self::Point => Shape::Point,
            Self::Line { .. } => Shape::Line,
            Self::LinePower { .. } => Shape::Spring,
        }
    }
}

/// How the force grows with the depth: K times a function of it, d^n where nothing else is said. `gap` is the clearance in the
/// unit of the depth.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Shape {
    /// n = 3/2.
    Point,
    /// d = F/K (l(F) - 1) with l = ln(4 K c/F), c the clearance and K = pi E* L (Johnson, Contact Mechanics, 1985, chapter 5;
    /// as quoted by Pereira, Ramalho, Ambrosio, Nonlinear Dynamics 63, 2011). It holds as long as the approach grows with the
    /// force: up to l = 2.
    Line,
    /// In proportion to it.
    Spring,
}

impl Shape {
    /// 2 n: twice the exponent of the force; of a line where l does not change.
    pub(super) const fn twice_exponent(self) -> i32 {
        match self {
            Self::Point => 3,
            Self::Line | Self::Spring => 2,
        }
    }

    /// Force over K.
    ///
    /// Of a line d/(l - 1), where l - 1 = x follows from x - ln x = b, b = ln(4 c/d) - 1, by Newton's method from a lower bound
    /// by Lambert's function, 1 + sqrt(2 u) + 2 u/3 with u = b - 1 (Chatzigeorgiou, IEEE Communications Letters 17, 2013).
    /// Deeper than the law goes it is d.
    pub fn power<R: Real>(self, depth: R, gap: R) -> R {
        match self {
            Self::Point => return depth * depth.sqrt(),
            Self::Spring => return depth,
            Self::Line if depth <= R::ZERO => return R::ZERO,
            Self::Line => {}
        }
        let bound = (R::lit(4.0) * gap / depth).ln() - R::ONE;
        let beyond = bound - R::ONE;
        if beyond <= R::ZERO {
            return depth;
        }
        let least = R::ONE + (R::TWO * beyond).sqrt() + R::lit(2.0 / 3.0) * beyond;
        let mut x = least;
        for _ in 0..POLISHINGS {
            // A coarse logarithm must not lead below.
            x = (x * (beyond + x.ln()) / (x - R::ONE)).most(least);
        }
        depth / x
    }

    /// Slope of the force, in parts of force over depth.
    pub(crate) fn slope<R: Real>(self, depth: R, power: R) -> R {
        match self {
            Self::Point => R::lit(1.5),
            Self::Line => R::ONE / (R::ONE - share(depth, power)),
            Self::Spring => R::ONE,
        }
    }

    /// Force times depth over the energy that is stored.
    pub(crate) fn parts<R: Real>(self, depth: R, power: R) -> R {
        match self {
            Self::Point => R::lit(2.5),
            Self::Line => R::lit(4.0) / (R::TWO - share(depth, power)),
            Self::Spring => R::TWO,
        }
    }

    /// The depth at this force over K; not for the step.
    pub fn depth<R: Real>(self, power: R, gap: R) -> R {
        match self {
            Self::Line if power <= R::ZERO => R::ZERO,
            Self::Line => power * ((R::lit(4.0) * gap / power).ln().most(R::TWO) - R::ONE),
            _ => {
                let root = root(power, self.twice_exponent());
                root * root
            }
        }
    }

    /// Duration of a contact without damping that comes to rest there, in units of deepest compression over entry speed.
    pub(super) fn duration(self, deepest: f64, power: f64) -> f64 {
        match self {
            // 2 times the integral of dx/sqrt(1 - x^2.5) from 0 to 1.
            Self::Point => 2.943_275_278_886_26,
            Self::Line => duration_of_line(deepest / power),
            Self::Spring => PI,
        }
    }
}

/// 2 times the integral of dd/v over the deepest, with F = F0 sin t and t = pi/2 s^2: smooth at both ends; `most` is l - 1 there.
fn duration_of_line(most: f64) -> f64 {
    const POINTS: i32 = 256;
    let mut sum = 0.0;
    for k in 0..POINTS {
        let s = (f64::from(k) + 0.5) / f64::from(POINTS);
        let (sine, cosine) = Real::sin_cos(FRAC_PI_2 * s * s);
        let x = most - Real::ln(sine);
        let left = 1.0 - sine * sine * (x - 0.5) / (most - 0.5);
        sum += s * (x - 1.0) * cosine / left.sqrt();
    }
    2.0 * PI * sum / (f64::from(POINTS) * most)
}

/// 1/(l - 1).
fn share<R: Real>(depth: R, power: R) -> R {
    if depth > R::ZERO {
        power / depth
    } else {
        R::ZERO
    }
}

/// The positive root of s^`degree` = `value`, for `value` of 0 or more: Newton's method, which falls
/// onto the root once it is above it.
pub(super) fn root<R: Real>(value: R, degree: i32) -> R {
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
