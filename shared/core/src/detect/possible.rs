//! Whether a rotor that floats, or falls for the first time, can be where a sample shows it: what jumps farther than it
//! moves is interference. Once it has met the wall, friction may drive it at any speed.

use crate::config::DetectorConfig;
use crate::sensing::PlanePositions;
use crate::vector::square;
use touchdown_rotor::real::sqrt;

/// Standard deviations of noise that a position does not jump by.
const NOISE: f32 = 10.0;
/// Least gravity, m/s^2, that a rotor's highest speed is taken from.
const GRAVITY: f32 = 9.81;
/// Samples, and seconds, in a row that may be impossible: more are a motion.
const LEFT_OUT: (u32, f32) = (8, 0.5e-3);

/// Coefficients.
#[derive(Clone, Copy, Debug)]
pub(crate) struct PossibleTest {
    /// Way of a rotor in a sample, m: three times as far as after a fall through the clearance at one and a half times
    /// gravity.
    farthest: f32,
    left_out: u32,
}

/// Where each plane was last.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Possible {
    last: PlanePositions,
    left_out: u32,
}

impl PossibleTest {
    pub(crate) fn new(config: &DetectorConfig) -> Self {
        let rate = config.sample_rate;
        let gravity = config.machine.gravity.max(GRAVITY);
        let (samples, time) = LEFT_OUT;
        Self {
            farthest: 3.0 * sqrt(3.0 * gravity * config.machine.clearance) / rate,
            left_out: samples.max((time * rate) as u32),
        }
    }

    /// Takes the planes' positions (m), whose axes have this variance (m^2), of a rotor that `floats` or falls; whether
    /// they are possible.
    pub(crate) fn take(
        &self,
        state: &mut Possible,
        now: &PlanePositions,
        variance: f32,
        floats: bool,
    ) -> bool {
        let is_possible = || {
            let farthest = NOISE * sqrt(variance) + self.farthest * (1.0 + state.left_out as f32);
            let mut planes = now.iter().zip(&state.last);
            planes.all(|pair| match pair {
                (Some(now), Some(last)) => square(*now, *last) <= farthest * farthest,
                _ => true,
            })
        };
        if floats && !is_possible() && state.left_out < self.left_out {
            state.left_out += 1;
            return false;
        }
        state.last = *now;
        state.left_out = 0;
        true
    }
}
