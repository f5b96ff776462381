//! The shapes that touch, and the stiffness that they give.

use touchdown_rotor::error::ConfigError;
use touchdown_rotor::real::Real;
use touchdown_rotor::scales::positive;

/// Iterations of the search for a line contact's peak; each gains a digit or more.
const ITERATIONS: usize = 60;
/// Of Newton's method for its force: the third is exact to rounding.
const POLISHINGS: usize = 3;

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
pub(super) struct Pairing<R> {
    /// E*, Pa.
    pub(super) modulus: R,
    /// Of the rotor, m.
    pub(super) radius: R,
    /// Radial clearance, m.
    pub(super) clearance: R,
    /// kg.
    pub(super) mass: R,
    /// Of the fastest impact expected, m/s.
    pub(super) speed: R,
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

    /// K, N/m^n. 4/3 E* sqrt(R_eff) of a point, with R_eff = r R/(R - r) and R - r the clearance.
    pub(super) fn stiffness<R: Real>(self, pairing: &Pairing<R>) -> Result<R, ConfigError> {
        let plane = |length| plane(R::lit(length), pairing);
        match self {
            Self::Point => {
                let outer = pairing.radius + pairing.clearance;
                let curvature = pairing.radius / pairing.clearance * outer;
                Ok(R::lit(4.0 / 3.0) * pairing.modulus * curvature.sqrt())
            }
            Self::Line { length } => {
                let plane = plane(length)?;
                logarithm(peak(pairing, plane)?, pairing.clearance)?;
                Ok(plane)
            }
            Self::LinePower { length } => {
                let plane = plane(length)?;
                let mut secant = R::ONE;
                for _ in 0..ITERATIONS {
                    let peak = pairing.speed * (pairing.mass / (plane * secant)).sqrt();
                    secant = logarithm(peak, pairing.clearance)? - R::ONE;
                }
                Ok(plane / secant)
            }
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
    const fn twice_exponent(self) -> i32 {
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

    /// The depth at which the pairing's impact has come to rest; not for the step.
    pub(super) fn deepest<R: Real>(self, pairing: &Pairing<R>, stiffness: R) -> R {
        if self == Self::Line {
            // `stiffness` has refused what has no peak.
            let peak = peak(pairing, stiffness).unwrap_or(R::ZERO);
            return self.depth(peak, pairing.clearance);
        }
        let &Pairing { mass, speed, .. } = pairing;
        let parts = self.parts(R::ZERO, R::ZERO);
        let energy = R::HALF * parts * mass / stiffness * speed * speed;
        let root = root(energy, self.twice_exponent() + 2);
        root * root
    }

    /// Duration of a contact without damping that comes to rest there, in units of deepest compression over entry speed.
    pub(super) fn duration<R: Real>(self, deepest: R, power: R) -> R {
        match self {
            // 2 times the integral of dx/sqrt(1 - x^2.5) from 0 to 1.
            Self::Point => R::lit(2.943_275_278_886_26),
            Self::Line => duration_of_line(deepest / power),
            Self::Spring => R::lit(core::f64::consts::PI),
        }
    }
}

/// 2 times the integral of dd/v over the deepest, with F = F0 sin t and t = pi/2 s^2: smooth at both ends; `most` is l - 1 there.
fn duration_of_line<R: Real>(most: R) -> R {
    const POINTS: i32 = 256;
    let mut sum = R::ZERO;
    for k in 0..POINTS {
        let s = (R::from_i32(k) + R::HALF) / R::from_i32(POINTS);
        let quarter = R::lit(core::f64::consts::FRAC_PI_2);
        let (sine, cosine) = (quarter * s * s).sin_cos();
        let x = most - sine.ln();
        let left = R::ONE - sine * sine * (x - R::HALF) / (most - R::HALF);
        sum += s * (x - R::ONE) * cosine / left.sqrt();
    }
    R::lit(2.0 * core::f64::consts::PI) * sum / (R::from_i32(POINTS) * most)
}

/// pi E* L, N/m.
fn plane<R: Real>(length: R, pairing: &Pairing<R>) -> Result<R, ConfigError> {
    positive("length", length)?;
    Ok(R::lit(core::f64::consts::PI) * pairing.modulus * length)
}

/// l at this force over pi E* L.
fn logarithm<R: Real>(power: R, gap: R) -> Result<R, ConfigError> {
    let logarithm = (R::lit(4.0) * gap / power).ln();
    if logarithm <= R::TWO || !logarithm.is_finite() {
        let rule = "long enough for the force of the fastest impact in this clearance";
        return Err(ConfigError::OutOfRange("length", rule));
    }
    Ok(logarithm)
}

/// Peak force over pi E* L, m: the energy F^2/(2 K) (l - 3/2) is m V^2/2.
fn peak<R: Real>(pairing: &Pairing<R>, plane: R) -> Result<R, ConfigError> {
    let spring = pairing.speed * (pairing.mass / plane).sqrt();
    let mut peak = spring;
    for _ in 0..ITERATIONS {
        let parts = logarithm(peak, pairing.clearance)? - R::lit(1.5);
        peak = spring / parts.sqrt();
    }
    Ok(peak)
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
