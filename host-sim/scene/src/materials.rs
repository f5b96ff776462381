//! What rotor and retainer are made of, and how they touch.

use std::f64::consts::PI;

use serde::Deserialize;
pub use touchdown_models::Contact;
use touchdown_models::{CompliantConfig, Materials as Elastic};

use super::diagnostic::Diagnostic;
use super::rule::{Keys, MILLI};

/// A wall that gives way, in place of restitution. The balls give way with it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CompliantWall {
    /// Its force over depth: K d^1.5 of a point, K d as a spring, K d/(ln(4 K c/F) - 1) of a line.
    pub law: CompliantConfig,
    /// Duration of the fastest impact, s.
    pub contact_time: f64,
}

/// What rotor and retainer are made of, and how they touch. Rung `hertz`, and walls that give way.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Materials {
    /// Moduli and Poisson's ratios.
    pub elastic: Elastic,
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

/// By default steel, 210 GPa and 0.3: pi times the contact modulus is 3.625e11 Pa.
#[derive(Default, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub(super) struct MaterialsTable {
    pub rotor_modulus_gpa: Option<f64>,
    pub rotor_poisson: Option<f64>,
    pub retainer_modulus_gpa: Option<f64>,
    pub retainer_poisson: Option<f64>,
    pub contact: Option<String>,
    pub length_mm: Option<f64>,
}

const GIGA: f64 = 1e9;

/// The materials, and how they touch.
pub(super) fn materials(given: Option<&MaterialsTable>) -> Result<Materials, Diagnostic> {
    const KEYS: Keys = Keys("materials");
    let (steel, none) = (Elastic::steel(), MaterialsTable::default());
    let table = given.unwrap_or(&none);
    let modulus = |it: Option<f64>| it.map_or(steel.rotor_modulus, |it| GIGA * it);
    let poisson = |it: Option<f64>| it.unwrap_or(steel.rotor_poisson);
    let names = ["point", "line", "line-power"];
    let contact = KEYS.named_or("contact", &table.contact, names[0], &names)?;
    let contact = match (contact, table.length_mm) {
        ("point", None) => Contact::Point,
        ("point", Some(_)) => {
            let rule = "length_mm is that of contact = \"line\"";
            return Err(KEYS.broken("length_mm", rule));
        }
        (name, Some(length)) => {
            let length = MILLI * length;
            match name {
                "line" => Contact::Line { length },
                _ => Contact::LinePower { length },
            }
        }
        (name, None) => {
            let rule = format!("contact = \"{name}\" needs length_mm");
            return Err(KEYS.broken("contact", rule));
        }
    };
    Ok(Materials {
        elastic: Elastic {
            rotor_modulus: modulus(table.rotor_modulus_gpa),
            rotor_poisson: poisson(table.rotor_poisson),
            retainer_modulus: modulus(table.retainer_modulus_gpa),
            retainer_poisson: poisson(table.retainer_poisson),
        },
        contact,
        given: given.is_some(),
    })
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
