//! Extremes that a scene can express: what is changed on the rig of the paper, and for how long it runs.

use std::f64::consts::PI;

use touchdown_base::input_error::InputError;
use touchdown_base::machine::Start;
use touchdown_scene::{Precision, Scene};

const RPM: f64 = 2.0 * PI / 60.0;
/// Steps at which each extreme is run, s.
pub const STEPS: [f64; 4] = [1e-6, 1e-5, 1e-4, 1e-3];

/// A scene at the edge.
#[derive(Clone, Debug)]
pub struct Extreme {
    /// In words.
    pub name: &'static str,
    /// Whatever its precision and step.
    pub scene: Scene,
    /// Steps at which it is run, s; the worst counts.
    pub steps: &'static [f64],
}

/// `scene` in numbers of this precision, with this step (s).
pub fn at_step(scene: &Scene, precision: Precision, step: f64) -> Scene {
    let mut scene = scene.clone();
    scene.model.precision = precision;
    scene.model.step = step;
    scene
}

type Change = fn(&mut Scene);

/// Name, steps, and what differs from the rig: 0.3 mm, friction 0.1, restitution 0.8, 30 000 rpm
/// clockwise, dropped beside the centre.
const EXTREMES: [(&str, &[f64], Change); 24] = [
    ("step of 1 us", &[1e-6], |_| ()),
    ("step of 1 ms", &[1e-3], |_| ()),
    ("restitution 0", &STEPS, |s| s.retainer.restitution = 0.0),
    ("restitution 0.99", &STEPS, |s| {
        s.retainer.restitution = 0.99
    }),
    ("restitution 1", &STEPS, |s| s.retainer.restitution = 1.0),
    ("restitution 1 without friction", &STEPS, |s| {
        s.retainer.restitution = 1.0;
        s.retainer.friction = 0.0;
    }),
    ("friction 0", &STEPS, |s| s.retainer.friction = 0.0),
    ("friction 1", &STEPS, |s| s.retainer.friction = 1.0),
    ("friction 2", &STEPS, |s| s.retainer.friction = 2.0),
    ("gap of 10 um", &STEPS, |s| set_gap(s, 10e-6)),
    ("gap of 20 um", &STEPS, |s| set_gap(s, 20e-6)),
    ("gap of 2 mm", &STEPS, |s| set_gap(s, 2e-3)),
    ("no spin", &STEPS, |s| s.rotor.spin = 0.0),
    ("spin reversed", &STEPS, |s| s.rotor.spin *= -1.0),
    ("spin of 1 000 000 rpm", &STEPS, |s| {
        s.rotor.spin = 1e6 * RPM
    }),
    ("no gravity", &STEPS, |s| {
        s.run.gravity = 0.0;
        s.start = free([0.05e-3, 0.1e-3], [0.02, -0.1]);
    }),
    ("start at the very centre", &STEPS, |s| {
        s.start = free([0.0; 2], [0.0; 2])
    }),
    ("start at rest on the wall", &STEPS, |s| {
        s.start = wall(0.7, 0.0)
    }),
    ("start on the wall, moving outward", &STEPS, |s| {
        s.start = free([0.0, -s.retainer.clearance], [0.01, -0.05]);
    }),
    ("start on the wall, moving inward", &STEPS, |s| {
        s.start = free([0.0, -s.retainer.clearance], [0.01, 0.05]);
    }),
    ("start along the wall where it falls away", &STEPS, |s| {
        s.start = wall(2.5, 0.03)
    }),
    ("whirl against the spin", &STEPS, |s| {
        s.start = wall(0.0, 340.0 * s.retainer.clearance);
        s.run.duration = 0.04;
    }),
    ("slip used up, then rolling", &STEPS, |s| {
        s.rotor.spin *= 0.01;
        s.run.duration = 0.4;
    }),
    ("the worst of all at once", &STEPS, |s| {
        s.rotor.spin = 1e6 * RPM;
        s.retainer.restitution = 0.99;
        s.retainer.friction = 2.0;
        set_gap(s, 10e-6);
        s.run.duration = 0.005;
    }),
];

pub fn extremes() -> Result<Vec<Extreme>, InputError> {
    let rig = Scene::load("rig")?;
    let made = EXTREMES.iter().map(|(name, steps, change)| {
        let mut scene = rig.clone();
        change(&mut scene);
        Extreme { name, scene, steps }
    });
    Ok(made.collect())
}

/// The gap, with the start and the duration in its measure.
fn set_gap(scene: &mut Scene, clearance: f64) {
    let ratio = clearance / scene.retainer.clearance;
    scene.retainer.clearance = clearance;
    scene.run.duration *= ratio.sqrt();
    if let Start::Free { position, .. } = &mut scene.start {
        *position = position.map(|x| x * ratio);
    }
}

pub(super) fn free(position: [f64; 2], velocity: [f64; 2]) -> Start {
    Start::Free { position, velocity }
}

pub(super) fn wall(angle: f64, tangential: f64) -> Start {
    Start::Wall { angle, tangential }
}
