//! How stiff a contact is that takes time.

use super::Row;
use touchdown_scene::scales::compliance;
use touchdown_scene::{Contact, Scene};

pub(super) fn contact(scene: &Scene) -> Vec<Row> {
    let (law, exponent) = match scene.materials.contact {
        Contact::Point => ("K, force is K d^n", "1.5"),
        Contact::LinePower { .. } => ("K, force is K d^n", "1"),
        Contact::Line { .. } => ("K, force F is K d/(ln(4 K c/F) - 1)", "1"),
    };
    let Ok(compliance) = compliance(scene) else {
        return Vec::new();
    };
    let micros = |seconds: f64| format!("{:.4} us", seconds * 1e6);
    vec![
        ("shape", scene.materials.contact.to_string()),
        (law, format!("{:.6e} N/m^{exponent}", compliance.stiffness)),
        (
            "fastest impact: force, depth",
            format!(
                "{:.1} N, {:.4} um",
                compliance.peak_force,
                compliance.deepest * 1e6
            ),
        ),
        ("omega_c, there", format!("{:.1} rad/s", compliance.rate)),
        ("T_c, its duration", micros(compliance.contact_time)),
        (
            "steps: accurate, longest",
            format!(
                "{}, {}",
                micros(compliance.accurate_step()),
                micros(compliance.longest_step())
            ),
        ),
    ]
}
