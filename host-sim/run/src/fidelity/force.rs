//! The force of the first impact, as the reference has it.

use touchdown_base::history::{History, Impact, Pulse};
use touchdown_scene::scales::compliance;
use touchdown_scene::{Contact, Scene};
use touchdown_truth::reference::pulse::{Meeting, Press, Pulse as True};

/// Pulse of the model's first impact, and the true one.
pub(super) fn pulses(history: &History, truth: &History, scene: &Scene) -> Option<(Pulse, True)> {
    let ours = history.impacts.first()?.pulse?;
    let meeting = meeting(truth.impacts.first()?, scene)?;
    Some((ours, meeting.pulse()))
}

/// The rotor at the wall, with the stiffness of its contact: of two spheres by Hertz, of a cylinder in a ring by Johnson's
/// logarithm; for `line-power` the linear one that the model goes by, so that its own error is not seen.
pub fn meeting(impact: &Impact, scene: &Scene) -> Option<Meeting> {
    let press = press(scene)?;
    let [x, y] = impact.state.position;
    Some(Meeting {
        mass: scene.rotor.mass,
        speed: impact.normal_speed,
        restitution: scene.retainer.restitution,
        press,
        gravity: -scene.run.gravity * y / x.hypot(y),
    })
}

/// How the scene's contact presses; none where the materials are refused.
pub fn press(scene: &Scene) -> Option<Press> {
    let stiffness = compliance(scene).ok()?.stiffness;
    Some(match scene.materials.contact {
        Contact::Point => Press::Power {
            stiffness: point(scene),
            exponent: 1.5,
        },
        Contact::LinePower { .. } => Press::Power {
            stiffness,
            exponent: 1.0,
        },
        Contact::Line { length } => Press::Logarithm {
            stiffness: std::f64::consts::PI * modulus(scene) * length,
            clearance: scene.retainer.clearance,
        },
    })
}

fn modulus(scene: &Scene) -> f64 {
    let steel = &scene.materials.elastic;
    let soft = |modulus: f64, ratio: f64| (1.0 - ratio * ratio) / modulus;
    1.0 / (soft(steel.rotor_modulus, steel.rotor_poisson)
        + soft(steel.retainer_modulus, steel.retainer_poisson))
}

fn point(scene: &Scene) -> f64 {
    let (inner, outer) = (
        scene.rotor.radius,
        scene.rotor.radius + scene.retainer.clearance,
    );
    4.0 / 3.0 * modulus(scene) * (1.0 / (1.0 / inner - 1.0 / outer)).sqrt()
}
