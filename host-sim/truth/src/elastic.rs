//! How a scene's materials press, by the textbooks' formulas and not by the model's code.

use std::f64::consts::PI;

use touchdown_scene::{Contact, Scene};

use crate::reference::press::{Press, PressShape};

/// A rotor of this radius in a ring of this clearance, m. A point is that of two spheres by Hertz, a line that of a cylinder
/// by Johnson's logarithm. `line-power` has the stiffness `linear` (N/m) that the model goes by, so that its own error is not
/// seen.
pub fn press(scene: &Scene, [radius, clearance]: [f64; 2], linear: f64) -> Press {
    let (shape, stiffness) = match scene.materials.contact {
        Contact::Point => {
            let curvature = 1.0 / radius - 1.0 / (radius + clearance);
            let point = 4.0 / 3.0 * modulus(scene) * (1.0 / curvature).sqrt();
            (PressShape::Power { exponent: 1.5 }, point)
        }
        Contact::LinePower { .. } => (PressShape::Power { exponent: 1.0 }, linear),
        Contact::Line { length } => {
            let line = PI * modulus(scene) * length;
            (PressShape::Line { clearance }, line)
        }
    };
    Press {
        shape,
        stiffness,
        balls: None,
        slowest: 0.0,
    }
}

fn modulus(scene: &Scene) -> f64 {
    let steel = &scene.materials.elastic;
    let soft = |modulus: f64, ratio: f64| (1.0 - ratio * ratio) / modulus;
    1.0 / (soft(steel.rotor_modulus, steel.rotor_poisson)
        + soft(steel.retainer_modulus, steel.retainer_poisson))
}
