//! A rotor, its retainer and what they are made of.

use super::shape::{Contact, Materials, Pairing};
use touchdown_rotor::RigidConfig;
use touchdown_rotor::error::ConfigError;
use touchdown_rotor::real::Real;
use touchdown_rotor::scales::positive;

/// A rotor and its compliant retainer, SI.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct HertzConfig<R> {
    /// What it shares with the rigid rung.
    pub rigid: RigidConfig<R>,
    /// What rotor and retainer are made of.
    pub materials: Materials<R>,
    /// How they touch.
    pub contact: Contact,
    /// Speed of the fastest impact expected, m/s: it sets the longest step.
    pub fastest: R,
}

/// How stiff the contact is, SI; without damping and without gravity.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Compliance<R> {
    /// K in force = K d^n, N/m^n; in force = K d/(ln(4 K c/force) - 1), N/m, of a line.
    pub stiffness: R,
    /// Compression of the fastest impact, m.
    pub deepest: R,
    /// Force of the fastest impact, N.
    pub peak_force: R,
    /// omega_c, the rate of small oscillations there, rad/s.
    pub rate: R,
    /// T_c, the duration of the fastest impact, s.
    pub contact_time: R,
}

impl<R: Real> Compliance<R> {
    /// 2/omega_c, s: beyond it a step is unstable.
    pub fn longest_step(&self) -> R {
        R::TWO / self.rate
    }

    /// T_c/25, s: up to it a step is accurate to a few percent of the force.
    pub fn accurate_step(&self) -> R {
        self.contact_time / R::from_i32(25)
    }
}

impl<R: Real> HertzConfig<R> {
    /// Checks what the contact's stiffness depends on, and works it out.
    pub fn compliance(&self) -> Result<Compliance<R>, ConfigError> {
        let (mass, speed) = (self.rigid.mass, self.fastest);
        positive("mass", mass)?;
        positive("fastest", speed)?;
        positive("radius", self.rigid.radius)?;
        positive("clearance", self.rigid.clearance)?;
        let pairing = Pairing {
            modulus: self.materials.contact_modulus()?,
            radius: self.rigid.radius,
            clearance: self.rigid.clearance,
            mass,
            speed,
        };
        let stiffness = self.contact.stiffness(&pairing)?;
        let shape = self.contact.shape();
        let deepest = shape.deepest(&pairing, stiffness);
        let power = shape.power(deepest, pairing.clearance);
        let force = stiffness * power;
        let compliance = Compliance {
            stiffness,
            deepest,
            peak_force: force,
            rate: (shape.slope(deepest, power) * force / (deepest * mass)).sqrt(),
            contact_time: shape.duration(deepest, power) * deepest / speed,
        };
        positive("fastest", compliance.contact_time)?;
        positive("fastest", compliance.rate)?;
        Ok(compliance)
    }
}
