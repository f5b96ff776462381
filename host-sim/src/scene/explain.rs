//! What a scene models, what it leaves out, and the numbers that decide how it goes.

use super::Scene;

/// The explanation, for people.
pub fn explain(scene: &Scene) -> String {
    scene.name.clone()
}
