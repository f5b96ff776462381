//! A straight impact on rung `hertz`: force and duration by the model's steps, for the rows that have a
//! closed form and for Fig. 7.

use super::hertz::Contact;
use super::rig::{refused, run, started};
use touchdown_base::failure::Failure;
use touchdown_base::history::Pulse;
use touchdown_run::model::follow;
use touchdown_scene::scales::compliance;
use touchdown_scene::{Fidelity, Scene, Scheme, Start};

/// Steps of a contact. Both schemes are of second order, and a peak that falls between two steps is
/// missed by (omega_c h)^2/8: 2e-6.
const STEPS: f64 = 1000.0;
/// What ours may be off in force and in time, relative; the model's error at this step is below it.
pub const TOLERANCE: f64 = 2e-5;
/// Contact times of flight before the contact, and of the whole run.
const BEFORE: f64 = 0.5;
const LONGEST: f64 = 2.0;
/// Steps between two points of a curve.
const SPACING: u64 = 10;

/// Largest force and duration of `contact` without loss, gravity, friction and spin, as formulas
/// (8) and (9) have it.
pub fn pulse(base: &Scene, contact: &Contact) -> Result<Pulse, Failure> {
    let scene = scene(base, contact)?;
    let history = run(&scene)?;
    let pulse = history.impacts.first().and_then(|impact| impact.pulse);
    pulse
        .ok_or_else(|| Failure::Usage(format!("{}: the rotor does not leave the wall", scene.name)))
}

/// Time since the wall was reached (s) and mean force over a few steps (N): what the model takes off
/// the rotor's speed.
pub fn curve(base: &Scene, contact: &Contact) -> Result<Vec<(f64, f64)>, Failure> {
    let scene = scene(base, contact)?;
    let mut drop = follow(&scene).map_err(refused(&scene))?;
    let mut upwards = |step: u64| {
        let now = drop.advance(step as f64 * scene.model.step);
        now.map_or(f64::NAN, |it| it.rotor.velocity[1])
    };
    let spacing = SPACING as f64 * scene.model.step;
    let points = (scene.run.duration / spacing) as u64;
    let before = BEFORE / LONGEST * scene.run.duration;
    let mut speed = upwards(0);
    let point = |point: u64| {
        let next = upwards((point + 1) * SPACING);
        let force = scene.rotor.mass * (next - speed) / spacing;
        speed = next;
        ((point as f64 + 0.5) * spacing - before, force)
    };
    Ok((0..points).map(point).collect())
}

/// Straight down at the contact's speed, from a little above the wall.
fn scene(base: &Scene, contact: &Contact) -> Result<Scene, Failure> {
    let mut scene = base.clone();
    scene.rotor.mass = contact.mass;
    scene.rotor.spin = 0.0;
    scene.retainer.clearance = contact.clearance;
    scene.retainer.friction = 0.0;
    scene.retainer.restitution = 1.0;
    scene.run.gravity = 0.0;
    scene.model.rung = Fidelity::Hertz;
    scene.model.scheme = Scheme::Verlet;
    let start = |height: f64| Start::Free {
        position: [0.0, height - contact.clearance],
        velocity: [0.0, -contact.speed],
    };
    scene.start = start(contact.clearance);
    let time = (compliance(&scene).map_err(refused(&scene))?).contact_time;
    scene.model.step = time / STEPS;
    Ok(started(
        &scene,
        start(BEFORE * time * contact.speed),
        LONGEST * time,
    ))
}
