//! A rotor, its retainer and what they are made of.

use core::f64::consts::PI;

use super::shape::{Contact, Materials, Shape, root};
use touchdown_rotor::RigidConfig;
use touchdown_rotor::error::ConfigError;
use touchdown_rotor::real::Real;
use touchdown_rotor::scales::positive;

/// Iterations of the search for a line contact's peak; each gains a digit or more.
const ITERATIONS: usize = 60;

/// A rotor and its compliant retainer, SI.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct HertzConfig {
    /// What it shares with the rigid rung.
    pub rigid: RigidConfig<f64>,
    /// What rotor and retainer are made of.
    pub materials: Materials,
    /// How they touch.
    pub contact: Contact,
    /// Speed of the fastest impact expected, m/s: it sets the longest step.
    pub fastest: f64,
}

/// How stiff the contact is, SI; without damping and without gravity.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Compliance {
    /// K in force = K d^n, N/m^n; in force = K d/(ln(4 K c/force) - 1), N/m, of a line.
    pub stiffness: f64,
    /// Compression of the fastest impact, m.
    pub deepest: f64,
    /// Force of the fastest impact, N.
    pub peak_force: f64,
    /// omega_c, the rate of small oscillations there, rad/s.
    pub rate: f64,
    /// T_c, the duration of the fastest impact, s.
    pub contact_time: f64,
}

impl Compliance {
    /// 2/omega_c, s: beyond it a step is unstable.
    pub fn longest_step(&self) -> f64 {
        2.0 / self.rate
    }

    /// T_c/25, s: up to it a step is accurate to a few percent of the force.
    pub fn accurate_step(&self) -> f64 {
        self.contact_time / 25.0
    }
}

impl HertzConfig {
    /// Checks what the contact's stiffness depends on, and works it out.
    pub fn compliance(&self) -> Result<Compliance, ConfigError> {
        let (rigid, speed) = (&self.rigid, self.fastest);
        positive("mass", rigid.mass)?;
        positive("fastest", speed)?;
        positive("radius", rigid.radius)?;
        positive("clearance", rigid.clearance)?;
        let stiffness = self.stiffness()?;
        let shape = self.contact.shape();
        let deepest = self.deepest(stiffness);
        let power = shape.power(deepest, rigid.clearance);
        let force = stiffness * power;
        let compliance = Compliance {
            stiffness,
            deepest,
            peak_force: force,
            rate: Real::sqrt(shape.slope(deepest, power) * force / (deepest * rigid.mass)),
            contact_time: shape.duration(deepest, power) * deepest / speed,
        };
        positive("fastest", compliance.contact_time)?;
        positive("fastest", compliance.rate)?;
        Ok(compliance)
    }

    /// K, N/m^n. 4/3 E* sqrt(R_eff) of a point, with R_eff = r R/(R - r) and R - r the clearance; pi E* L of a line.
    fn stiffness(&self) -> Result<f64, ConfigError> {
        let modulus = self.materials.contact_modulus()?;
        let &RigidConfig {
            mass,
            radius,
            clearance,
            ..
        } = &self.rigid;
        let plane = |length| {
            positive("length", length)?;
            Ok(PI * modulus * length)
        };
        match self.contact {
            Contact::Point => {
                let curvature = radius / clearance * (radius + clearance);
                Ok(4.0 / 3.0 * modulus * curvature.sqrt())
            }
            Contact::Line { length } => {
                let plane = plane(length)?;
                logarithm(self.peak(plane)?, clearance)?;
                Ok(plane)
            }
            Contact::LinePower { length } => {
                let plane = plane(length)?;
                let mut secant = 1.0;
                for _ in 0..ITERATIONS {
                    let peak = self.fastest * (mass / (plane * secant)).sqrt();
                    secant = logarithm(peak, clearance)? - 1.0;
                }
                Ok(plane / secant)
            }
        }
    }

    /// The depth at which the fastest impact has come to rest; not for the step.
    fn deepest(&self, stiffness: f64) -> f64 {
        let (rigid, speed) = (&self.rigid, self.fastest);
        let shape = self.contact.shape();
        if shape == Shape::Line {
            // `stiffness` has refused what has no peak.
            let peak = self.peak(stiffness).unwrap_or(0.0);
            return shape.depth(peak, rigid.clearance);
        }
        let parts = shape.parts(0.0, 0.0);
        let energy = 0.5 * parts * rigid.mass / stiffness * speed * speed;
        let root = root(energy, shape.twice_exponent() + 2);
        root * root
    }

    /// Peak force over pi E* L, m: the energy F^2/(2 K) (l - 3/2) is m V^2/2.
    fn peak(&self, plane: f64) -> Result<f64, ConfigError> {
        let spring = self.fastest * (self.rigid.mass / plane).sqrt();
        let mut peak = spring;
        for _ in 0..ITERATIONS {
            let parts = logarithm(peak, self.rigid.clearance)? - 1.5;
            peak = spring / parts.sqrt();
        }
        Ok(peak)
    }
}

/// l at this force over pi E* L.
fn logarithm(power: f64, gap: f64) -> Result<f64, ConfigError> {
    let logarithm = Real::ln(4.0 * gap / power);
    if logarithm <= 2.0 || !logarithm.is_finite() {
        let rule = "long enough for the force of the fastest impact in this clearance";
        return Err(ConfigError::OutOfRange("length", rule));
    }
    Ok(logarithm)
}
