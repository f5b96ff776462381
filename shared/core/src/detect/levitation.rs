//! What is learnt while the rotor floats: where, and how quietly.

use crate::config::Tuning;
use crate::vector::sum;

/// Seconds that the learnt position follows.
const FOLLOW_TIME: f32 = 0.5;

/// Coefficients.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Learning {
    arming_samples: u32,
    memory: u32,
}

/// What has been learnt.
#[derive(Clone, Copy, Debug, Default, serde::Serialize, serde::Deserialize)]
pub(crate) struct Levitation {
    count: u32,
    gain: f32,
    /// Whether enough has been learnt.
    pub(crate) is_armed: bool,
    /// m.
    pub(crate) mean: [f32; 2],
    /// Of one axis, m^2.
    pub(crate) variance: f32,
}

impl Learning {
    pub(crate) fn new(tuning: &Tuning, sample_rate: f32) -> Self {
        Self {
            arming_samples: (tuning.arming_time * sample_rate).max(64.0) as u32,
            memory: (FOLLOW_TIME * sample_rate).max(64.0) as u32,
        }
    }

    /// Whether the position has been learnt well enough for residuals from it.
    pub(crate) fn has_position(&self, state: &Levitation) -> bool {
        2 * state.count > self.arming_samples
    }

    /// Takes a position, m.
    pub(crate) fn take(&self, state: &mut Levitation, [x, y]: [f32; 2]) {
        state.count = state.count.saturating_add(1);
        if state.count <= self.memory {
            state.gain = 1.0 / state.count as f32;
        }
        let gain = state.gain;
        let (dx, dy) = (x - state.mean[0], y - state.mean[1]);
        state.mean[0] += gain * dx;
        state.mean[1] += gain * dy;
        if state.count > 1 {
            let square = 0.5 * (dx * dx + dy * dy);
            state.variance += gain * (square - state.variance);
        }
        state.is_armed = state.count >= self.arming_samples;
    }
}

impl Levitation {
    /// What is measured has moved by `way`, m.
    pub(crate) fn shift(&mut self, way: [f32; 2]) {
        self.mean = sum(self.mean, way);
    }

    /// Variance of one axis while floating, m^2; 0 before it has been learnt.
    pub(crate) fn learnt_variance(&self) -> f32 {
        if self.is_armed { self.variance } else { 0.0 }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn arms_after_the_arming_time_and_not_before() {
        let learning = Learning::new(&Tuning::default(), 20_000.0);
        let mut state = Levitation::default();
        for k in 1..=2_800 {
            assert!(!state.is_armed, "{k}");
            learning.take(&mut state, [1e-6 * (k % 2) as f32, 0.0]);
        }
        assert!(state.is_armed);
        assert!((state.mean[0] - 0.5e-6).abs() < 1e-9);
    }
}
