//! What a model costs on the target, over how much of a scene.

use touchdown_rotor::error::ConfigError;
use touchdown_scene::Scene;

use crate::instructions::{Instructions, Steps};

/// Longest part of a scene that is measured, from the release, s.
pub const LONGEST: f64 = 1.0;

/// Mean of the instructions of a step of the scene's run on the target; none where the model was not counted
/// there.
pub fn per_step(scene: &Scene) -> Result<Option<f64>, ConfigError> {
    let steps = Steps::of(scene)?;
    let each = Instructions::of(&scene.model);
    Ok(each.map(|each| each.per_step(&steps)))
}

/// Instructions a simulated second on the target; none where the model was not counted there, or refuses the
/// scene.
pub fn target_cost(scene: &Scene) -> Option<f64> {
    let each = per_step(scene).ok()??;
    Some(each / scene.model.step)
}
