//! The force of the first impact, as the reference has it.

use touchdown_base::history::{History, Impact, Pulse};
use touchdown_scene::scales::compliance;
use touchdown_scene::{Contact, Scene};
use touchdown_truth::reference::pulse::{Meeting, Pulse as True};

/// How rotor and wall press on each other: F = K d^n before damping.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Press {
    /// K, N/m^n.
    pub stiffness: f64,
    /// n.
    pub exponent: f64,
}

/// Pulse of the model's first impact, and the true one.
pub(super) fn pulses(history: &History, truth: &History, scene: &Scene) -> Option<(Pulse, True)> {
    let ours = history.impacts.first()?.pulse?;
    let meeting = meeting(truth.impacts.first()?, scene)?;
    Some((ours, meeting.pulse()))
}

/// The rotor at the wall, with the stiffness of its contact: of two spheres by Hertz; of a cylinder in a ring
/// the linear one that the model goes by, so that its own error is not seen.
pub fn meeting(impact: &Impact, scene: &Scene) -> Option<Meeting> {
    let Press {
        stiffness,
        exponent,
    } = press(scene)?;
    let [x, y] = impact.state.position;
    Some(Meeting {
        mass: scene.rotor.mass,
        speed: impact.normal_speed,
        restitution: scene.retainer.restitution,
        stiffness,
        exponent,
        gravity: -scene.run.gravity * y / x.hypot(y),
    })
}

/// How the scene's contact presses; none where the materials are refused.
pub fn press(scene: &Scene) -> Option<Press> {
    let (stiffness, exponent) = match scene.materials.contact {
        Contact::Point => (point(scene), 1.5),
        Contact::Line { .. } => (compliance(scene).ok()?.stiffness, 1.0),
    };
    Some(Press {
        stiffness,
        exponent,
    })
}

fn point(scene: &Scene) -> f64 {
    let steel = &scene.materials.elastic;
    let soft = |modulus: f64, ratio: f64| (1.0 - ratio * ratio) / modulus;
    let modulus = 1.0
        / (soft(steel.rotor_modulus, steel.rotor_poisson)
            + soft(steel.retainer_modulus, steel.retainer_poisson));
    let (inner, outer) = (
        scene.rotor.radius,
        scene.rotor.radius + scene.retainer.clearance,
    );
    4.0 / 3.0 * modulus * (1.0 / (1.0 / inner - 1.0 / outer)).sqrt()
}
