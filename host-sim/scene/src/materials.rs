//! What rotor and retainer are made of, and how they touch.

use std::f64::consts::PI;

pub use touchdown_models::Contact;
use touchdown_models::Materials as Elastic;

/// A wall that gives way: its force over depth, in place of restitution. The balls give way with it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CompliantWall {
    /// The shape.
    pub contact: Contact,
    /// K: force is K d^1.5 of a point, K d as a spring, K d/(ln(4 K c/F) - 1) of a line; N/m^1.5 or N/m.
    pub stiffness: f64,
    /// N/m.
    pub balls: Option<f64>,
    /// Speed of entry below which it does not scale the damping, m/s.
    pub slowest: f64,
    /// Duration of the fastest impact, s.
    pub contact_time: f64,
}

/// What rotor and retainer are made of, and how they touch. Rung `hertz`, and walls that give way.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Materials {
    /// Moduli and Poisson's ratios.
    pub elastic: Elastic<f64>,
    /// The shape of the contact.
    pub contact: Contact,
    /// By the scene; else steel on steel is taken.
    pub given: bool,
}

impl Materials {
    /// Greatest pressure of a contact under this force (N), Pa; radii of rotor and gap, m (K. L. Johnson, Contact Mechanics,
    /// 1985: 4.24 of a point, 4.45 of a line).
    pub fn pressure(&self, force: f64, radius: f64, clearance: f64) -> Option<f64> {
        let modulus = self.elastic.contact_modulus().ok()?;
        let curved = radius * (radius + clearance) / clearance;
        Some(match self.contact {
            Contact::Point => {
                let cube = 6.0 * force * modulus * modulus / (PI * PI * PI * curved * curved);
                cube.cbrt()
            }
            Contact::Line { length } | Contact::LinePower { length } => {
                (force / length * modulus / (PI * curved)).sqrt()
            }
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Hertz' pressure is p0 sqrt(1 - (r/a)^2): its sum over the patch is the force. a^3 = 3 F R/(4 E*) of a point,
    /// a^2 = 4 F' R/(pi E*) of a line.
    #[test]
    fn the_pressure_carries_the_force() {
        let elastic = Elastic::steel();
        let modulus = elastic.contact_modulus().expect("steel");
        let (radius, clearance, force, length) = (0.02, 3e-4, 5e3, 0.015);
        let curved = radius * (radius + clearance) / clearance;
        let of = |contact| Materials {
            elastic,
            contact,
            given: true,
        };
        let point = of(Contact::Point).pressure(force, radius, clearance);
        let patch = (0.75 * force * curved / modulus).cbrt();
        let carried = 2.0 / 3.0 * PI * patch * patch * point.expect("steel");
        assert!((carried / force - 1.0).abs() < 1e-12, "{carried}");
        let line = of(Contact::Line { length }).pressure(force, radius, clearance);
        let half = (4.0 * force / length * curved / (PI * modulus)).sqrt();
        let carried = 0.5 * PI * half * length * line.expect("steel");
        assert!((carried / force - 1.0).abs() < 1e-12, "{carried}");
    }
}
