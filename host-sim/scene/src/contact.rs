//! Checks of what only a contact with a duration asks for: its materials and its step.

use touchdown_models::Materials as Elastic;

use super::diagnostic::Diagnostic;
use super::file::MaterialsTable;
use super::rule::{MICRO, MILLI, above_zero, between, named, translate};
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
    const TABLE: &str = "materials";
    let steel = MaterialsTable::default();
    let table = given.unwrap_or(&steel);
    let modulus = |key, value| {
        let value = above_zero(TABLE, key, value)?;
        between(TABLE, key, value, limits::MODULUS_GPA).map(|value| GIGA * value)
    };
    let poisson = |key, value| between(TABLE, key, value, limits::POISSON);
    let names = ["point", "line", "line-power"];
    let contact = match table.contact.as_deref() {
        None => names[0],
        Some(name) => named(TABLE, "contact", name, &names, |name| name)?,
    };
    let contact = match (contact, table.length_mm) {
        ("point", None) => Contact::Point,
        ("point", Some(_)) => {
            let rule = "length_mm is that of contact = \"line\"";
            return Err(Diagnostic::new(TABLE, "length_mm", rule));
        }
        (name, Some(length)) => {
            let length = above_zero(TABLE, "length_mm", length)?;
            let length = MILLI * between(TABLE, "length_mm", length, limits::LENGTH_MM)?;
            match name {
                "line" => Contact::Line { length },
                _ => Contact::LinePower { length },
            }
        }
        (name, None) => {
            let rule = format!("contact = \"{name}\" needs length_mm");
            return Err(Diagnostic::new(TABLE, "contact", rule));
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
