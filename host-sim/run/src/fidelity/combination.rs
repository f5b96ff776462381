//! What is compared, and what it costs on the target.

use crate::instructions::{Instructions, Steps};
use touchdown_scene::{Fidelity, LeftOut, Model, Precision, Scene};

/// Steps that are compared, us.
pub const STEPS_US: [u32; 10] = [1, 2, 5, 10, 20, 50, 100, 200, 500, 1000];
/// Longest part of a scene that is measured, from the release, s.
const LONGEST: f64 = 1.0;

/// Every combination of rung, scheme, precision, math and step.
pub fn all() -> Vec<Model> {
    let mut all = Vec::new();
    for &rung in Fidelity::ALL {
        for &scheme in rung.schemes() {
            for precision in Precision::ALL {
                for &math in rung.maths(precision) {
                    all.extend(STEPS_US.map(|step| Model {
                        rung,
                        scheme,
                        precision,
                        math,
                        step: f64::from(step) / 1e6,
                        cutoff: 0.0,
                        left_out: LeftOut::default(),
                    }));
                }
            }
        }
    }
    all
}

/// The scene by another combination.
pub fn with(scene: &Scene, model: Model) -> Scene {
    Scene {
        model,
        ..scene.clone()
    }
}

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
