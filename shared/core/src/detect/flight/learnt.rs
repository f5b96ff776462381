//! How loud the impact test is, once that is learnt.

use super::NoiseFloor;

impl NoiseFloor {
    pub(crate) fn level(&self) -> f32 {
        self.level
    }

    /// One that has listened.
    pub(crate) fn of_level(level: f32) -> Self {
        Self {
            level,
            ..Self::default()
        }
    }
}
