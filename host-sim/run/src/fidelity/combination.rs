//! What is compared.

use touchdown_scene::{Fidelity, LeftOut, Model, Precision, Scene};

/// Steps that are compared, us.
pub const STEPS_US: [u32; 10] = [1, 2, 5, 10, 20, 50, 100, 200, 500, 1000];

/// Every combination of rung, scheme, precision, math and step.
pub fn all() -> Vec<Model> {
    let mut all = Vec::new();
    for rung in Fidelity::ALL {
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
