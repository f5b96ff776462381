//! The force of the first impact, as the reference has it.

use touchdown_base::history::{History, Impact, Pulse};
use touchdown_scene::Scene;
use touchdown_scene::scales::compliance;
use touchdown_truth::reference::press::Press;
use touchdown_truth::reference::pulse::{Meeting, Pulse as True};

/// Pulse of the model's first impact, and the true one.
pub(super) fn pulses(history: &History, truth: &History, scene: &Scene) -> Option<(Pulse, True)> {
    let ours = history.impacts.first()?.pulse?;
    let meeting = meeting(truth.impacts.first()?, scene)?;
    Some((ours, meeting.pulse()))
}

/// The rotor at the wall.
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
    let linear = compliance(scene).ok()?.stiffness;
    let ring = [scene.rotor.radius, scene.retainer.clearance];
    Some(touchdown_truth::press(scene, ring, linear))
}
