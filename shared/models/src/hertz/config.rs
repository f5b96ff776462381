//! A rotor, its retainer and what they are made of.

use super::shape::{Contact, Materials};
use touchdown_rotor::RigidConfig;
use touchdown_rotor::error::ConfigError;
use touchdown_rotor::real::Real;
use touchdown_rotor::scales::positive;

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
        let stiffness = self.contact.stiffness(self)?;
        let shape = self.contact.shape();
        let deepest = shape.deepest(self, stiffness);
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
}
