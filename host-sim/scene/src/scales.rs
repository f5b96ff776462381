//! What follows from a scene alone: its units, its fastest impact, how stiff its contact is.

use touchdown_base::machine::Start;
use touchdown_models::{Compliance, CompliantConfig, HertzConfig};
use touchdown_rotor::RigidConfig;
use touchdown_rotor::error::ConfigError;

use crate::elastic::Validity;
use crate::{CompliantWall, Ring, Scene, TwoPlane};

/// Part of the fastest impact's speed below which a contact's damping is no longer scaled by its own: it has 1e-6 of that
/// impact's energy.
const SLOWEST: f64 = 1e-3;

/// How stiff the scene's contact is.
pub fn compliance(scene: &Scene) -> Result<Compliance, ConfigError> {
    compliant(scene).compliance()
}

/// How far the rotor is rigid in its contacts, in the ring where it is least; none where the scene does not
/// give its first elastic mode.
pub fn validity(scene: &Scene) -> Option<Validity> {
    let machine = scene.two_plane.as_ref()?;
    if !machine.modes.is_empty() {
        return None;
    }
    let mode = machine.elastic_mode?;
    let gyration = (machine.transverse_inertia / scene.rotor.mass).sqrt();
    let rings = machine.rings.iter().map(|ring| ring.place / gyration);
    let all = rings.filter_map(|zeta| Validity::try_new(&compliant(scene), zeta, mode).ok());
    all.max_by(|a, b| a.ratio.total_cmp(&b.ratio))
}

/// The wall of a ring that is to give way. An impact there meets 1/(1 + zeta^2) of the mass, zeta its place in radii of
/// gyration; bending is not counted.
pub(super) fn wall(
    scene: &Scene,
    machine: &TwoPlane,
    ring: &Ring,
) -> Result<CompliantWall, ConfigError> {
    let mut there = compliant(scene);
    let turned = ring.place * ring.place * scene.rotor.mass / machine.transverse_inertia;
    there.rigid.mass /= 1.0 + turned;
    there.rigid.radius = ring.radius;
    there.rigid.clearance = ring.retainer.clearance;
    let compliance = there.compliance()?;
    // A fall through the static compression: slower, the weight and not the impact decides.
    let weight = scene.rotor.mass * scene.run.gravity;
    let shape = there.contact.shape();
    let settled = shape.depth(weight / compliance.stiffness, ring.retainer.clearance);
    let slowest = (2.0 * scene.run.gravity * settled).sqrt();
    Ok(CompliantWall {
        law: CompliantConfig {
            shape,
            stiffness: compliance.stiffness,
            balls: ring.ball_bearing.and_then(|it| it.stiffness),
            slowest: slowest.max(SLOWEST * there.fastest),
        },
        contact_time: compliance.contact_time,
    })
}

/// The longest step that follows all contacts of walls that give way, s; infinite without such.
pub(super) fn accurate_step(scene: &Scene) -> f64 {
    let walls = scene.rings().iter().filter_map(|it| it.wall);
    walls.fold(f64::INFINITY, |least, it| least.min(it.contact_time / 25.0))
}

/// Contact of the scene.
pub fn compliant(scene: &Scene) -> HertzConfig {
    HertzConfig {
        rigid: config(scene),
        materials: scene.materials.elastic,
        contact: scene.materials.contact,
        fastest: fastest_impact(scene),
    }
}

/// A fall to the bottom from the start's height, or through the gap if that is more, and the start's
/// speed.
pub fn fastest_impact(scene: &Scene) -> f64 {
    let height = match scene.start {
        Start::Free { position, .. } => position[1],
        Start::Wall { angle, .. } => -scene.retainer.clearance * angle.cos(),
    };
    let fall = scene.retainer.clearance + height.max(0.0);
    let speed = speed_of(&scene.start).hypot((2.0 * scene.run.gravity * fall).sqrt());
    if speed > 0.0 {
        speed
    } else {
        start_speed(scene)
    }
}

fn speed_of(start: &Start) -> f64 {
    match *start {
        Start::Free { velocity, .. } => velocity[0].hypot(velocity[1]),
        Start::Wall { tangential, .. } => tangential.abs(),
    }
}

/// The scene's rigid rotor.
pub fn config(scene: &Scene) -> RigidConfig<f64> {
    RigidConfig {
        mass: scene.rotor.mass,
        radius: scene.rotor.radius,
        polar_inertia: scene.rotor.polar_inertia,
        clearance: scene.retainer.clearance,
        friction: scene.retainer.friction,
        restitution: scene.retainer.restitution,
        gravity: scene.run.gravity,
        speed: start_speed(scene),
        step: scene.model.step,
    }
}

/// Sets the scale where there is no gravity.
pub fn start_speed(scene: &Scene) -> f64 {
    let speed = speed_of(&scene.start);
    if speed > 0.0 { speed } else { 1.0 }
}
