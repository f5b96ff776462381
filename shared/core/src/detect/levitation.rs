//! What is learnt while the rotor floats: where, and how quietly.

use crate::config::Tuning;
use crate::vector::sum;

/// Seconds that the learnt position follows after arming.
const FOLLOW_TIME: f32 = 0.5;

/// Coefficients.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Learning {
    arming_samples: u32,
    memory: f32,
}

/// What has been learnt.
#[derive(Clone, Copy, Debug, Default)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub(crate) struct Levitation {
    count: u32,
    armed: bool,
    /// m.
    pub(crate) mean: [f32; 2],
    /// Of one axis, m^2.
    pub(crate) variance: f32,
    halfway: [f32; 2],
}

impl Learning {
    pub(crate) fn new(tuning: &Tuning, sample_rate: f32) -> Self {
        Self {
            arming_samples: (tuning.arming_time * sample_rate).max(64.0) as u32,
            memory: (FOLLOW_TIME * sample_rate).max(64.0),
        }
    }

    /// Whether the position has been learnt well enough for residuals from it.
    pub(crate) fn has_position(&self, state: &Levitation) -> bool {
        state.armed || 2 * state.count > self.arming_samples
    }

    /// Takes a position, m; true on the sample that arms. Where the rotor still moves, learning starts
    /// again.
    pub(crate) fn take(&self, state: &mut Levitation, [x, y]: [f32; 2]) -> bool {
        state.count = state.count.saturating_add(1);
        let gain = 1.0 / (state.count as f32).min(self.memory);
        let (dx, dy) = (x - state.mean[0], y - state.mean[1]);
        state.mean[0] += gain * dx;
        state.mean[1] += gain * dy;
        if state.count > 1 {
            let square = 0.5 * (dx * dx + dy * dy);
            state.variance += gain * (square - state.variance);
        }
        if state.armed {
            return false;
        }
        if state.count == self.arming_samples / 2 {
            state.halfway = state.mean;
        }
        if state.count < self.arming_samples {
            return false;
        }
        let drift = [
            state.mean[0] - state.halfway[0],
            state.mean[1] - state.halfway[1],
        ];
        if drift[0] * drift[0] + drift[1] * drift[1] > state.variance {
            *state = Levitation::default();
            return false;
        }
        state.armed = true;
        true
    }
}

impl Levitation {
    /// What is measured has moved by `way`, m.
    pub(crate) fn shift(&mut self, way: [f32; 2]) {
        self.mean = sum(self.mean, way);
        self.halfway = sum(self.halfway, way);
    }

    /// Whether learning has just begun, or begun again.
    pub(crate) fn is_fresh(&self) -> bool {
        self.count == 0
    }

    /// Variance of one axis while floating, m^2; 0 before it has been learnt.
    pub(crate) fn learnt_variance(&self) -> f32 {
        if self.armed { self.variance } else { 0.0 }
    }

    /// Whether enough has been learnt.
    pub(crate) fn is_armed(&self) -> bool {
        self.armed
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn learning() -> Learning {
        Learning::new(&Tuning::default(), 20_000.0)
    }

    #[test]
    fn arms_after_the_arming_time_and_not_before() {
        let (learning, mut state) = (learning(), Levitation::default());
        for k in 1..2_800 {
            assert!(
                !learning.take(&mut state, [1e-6 * (k % 2) as f32, 0.0]),
                "{k}"
            );
        }
        assert!(learning.take(&mut state, [0.0, 0.0]));
        assert!((state.mean[0] - 0.5e-6).abs() < 1e-9);
    }

    #[test]
    fn does_not_arm_on_the_move() {
        let (learning, mut state) = (learning(), Levitation::default());
        for k in 0..20_000 {
            assert!(!learning.take(&mut state, [1e-8 * k as f32, 0.0]));
        }
    }
}
