//! What a model costs on the target, over how much of a scene.

use touchdown_scene::Scene;

use crate::instructions::{Instructions, Steps};

/// Longest part of a scene that is measured, from the release, s.
const LONGEST: f64 = 1.0;

/// The scene, as long as it is measured.
pub fn first_second(scene: &Scene) -> Scene {
    let mut scene = scene.clone();
    scene.run.duration = scene.run.duration.min(LONGEST);
    scene
}

/// Mean of the instructions of a step of the scene's run on the target; none where the model was not counted there, or
/// refuses the scene.
pub fn per_step(scene: &Scene) -> Option<f64> {
    let each = Instructions::of(&scene.model)?;
    Some(each.per_step(&Steps::of(scene).ok()?))
}

/// Instructions a simulated second on the target; none likewise.
pub fn per_second(scene: &Scene) -> Option<f64> {
    Some(per_step(scene)? / scene.model.step)
}
