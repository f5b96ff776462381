//! The reference over a scene: what a model is judged by.

use crate::history::{History, Recorder};
use crate::model_run::start_speed;
use crate::reference::Reference;
use crate::scene::Scene;

/// Runs the reference from the release to the end.
pub fn simulate(scene: &Scene) -> History {
    let mut reference = Reference::new(&scene.machine(), &scene.start, scene.rotor.spin);
    let mut recorder = Recorder::new(-scene.first_sample_time());
    let end = reference.advance(scene.run.duration, &mut |h| recorder.take(h));
    recorder.finish(end, reference.still_speed())
}

/// What errors are measured in.
#[derive(Clone, Copy, Debug)]
pub struct Units {
    /// The clearance rho0, m.
    pub length: f64,
    /// T, s.
    pub time: f64,
    /// V = sqrt(g rho0), m/s; without gravity the start's speed, or 1.
    pub speed: f64,
}

impl Units {
    /// Of `scene`.
    pub fn of(scene: &Scene) -> Self {
        let length = scene.retainer.clearance;
        let speed = if scene.run.gravity > 0.0 {
            (scene.run.gravity * length).sqrt()
        } else {
            start_speed(scene)
        };
        Self {
            length,
            time: length / speed,
            speed,
        }
    }
}
