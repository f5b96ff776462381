//! The reference over a scene: what a model is judged by.

use crate::history::{History, Recorder};
use crate::reference::Reference;
use crate::scene::Scene;

/// Runs the reference from the release to the end.
pub fn simulate(scene: &Scene) -> History {
    let mut reference = Reference::new(&scene.machine(), &scene.start, scene.rotor.spin);
    let mut recorder = Recorder::new(-scene.first_sample_time());
    let end = reference.advance(scene.run.duration, &mut |h| recorder.take(h));
    recorder.finish(end, reference.still_speed())
}
