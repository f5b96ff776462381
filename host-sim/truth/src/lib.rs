//! The reference over a scene: what a model is judged by.

mod follow;
pub mod reference;

pub use follow::{Moving, TrueState, Truth, held};
pub use reference::press::press;

use touchdown_base::history::History;
use touchdown_scene::Scene;
use touchdown_scene::scales::start_speed;

/// Runs the reference from the release to the end.
pub fn simulate(scene: &Scene) -> History {
    Truth::new(scene).finish().whole
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
        Self::new(length, speed)
    }

    pub(crate) fn new(length: f64, speed: f64) -> Self {
        Self {
            length,
            time: length / speed,
            speed,
        }
    }
}
