//! Checks of what only a contact with a duration asks for: its materials and its step.

use touchdown_models::Materials as Elastic;

use super::diagnostic::Diagnostic;
use super::file::MaterialsTable;
use super::rule::{Keys, MICRO, MILLI, translate};
use super::{Contact, Materials, Scene, limits};
use crate::scales::compliance;
use touchdown_base::plain::Number;

const GIGA: f64 = 1e9;

/// The step of a contact that takes time: as asked for if that is stable, else a whole part of a sample
/// that is accurate.
pub(super) fn step_in_contact(scene: &Scene, given: bool) -> Result<f64, Diagnostic> {
    let compliance = compliance(scene).map_err(|error| translate(&error))?;
    let step = scene.model.step;
    if !given {
        return Ok(step / (step / compliance.accurate_step()).ceil());
    }
    let longest = compliance.longest_step();
    if step > longest {
        let rule = format!(
            "step_us must be no more than {:.4}, the limit of stability 2/omega_c of this contact, is {}",
            Number(longest / MICRO),
            Number(step / MICRO)
        );
        return Err(Diagnostic::new("model", "step_us", rule));
    }
    Ok(step)
}

/// The materials, and how they touch.
pub(super) fn materials(given: Option<&MaterialsTable>) -> Result<Materials, Diagnostic> {
    const KEYS: Keys = Keys("materials");
    let steel = MaterialsTable::default();
    let table = given.unwrap_or(&steel);
    let modulus = |key, value| {
        let value = KEYS.within(key, value, limits::MODULUS_GPA);
        value.map(|value| GIGA * value)
    };
    let poisson = |key, value| KEYS.between(key, value, limits::POISSON);
    let names = ["point", "line", "line-power"];
    let contact = KEYS.named_or("contact", &table.contact, names[0], &names)?;
    let contact = match (contact, table.length_mm) {
        ("point", None) => Contact::Point,
        ("point", Some(_)) => {
            let rule = "length_mm is that of contact = \"line\"";
            return Err(KEYS.broken("length_mm", rule));
        }
        (name, Some(length)) => {
            let length = MILLI * KEYS.within("length_mm", length, limits::LENGTH_MM)?;
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
            rotor_modulus: modulus("rotor_modulus_gpa", table.rotor_modulus_gpa)?,
            rotor_poisson: poisson("rotor_poisson", table.rotor_poisson)?,
            retainer_modulus: modulus("retainer_modulus_gpa", table.retainer_modulus_gpa)?,
            retainer_poisson: poisson("retainer_poisson", table.retainer_poisson)?,
        },
        contact,
        given: given.is_some(),
    })
}
