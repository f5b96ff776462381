//! White noise of the position, whatever the rotor does meanwhile.
//!
//! A third difference takes off position, velocity and acceleration; of white noise it leaves
//! 1 + 9 + 9 + 1 = 20 times the variance.

use crate::memory::Memory;

/// Samples that the estimate remembers.
const MEMORY: Memory = Memory::of(4096);
/// Samples before the estimate is used.
pub(crate) const WARM_UP: u32 = 32;
/// Squared third differences count at most this many variances: an impact is no noise.
const CLIP: f32 = 25.0;

/// Running estimate of the variance of one axis of one plane.
#[derive(Clone, Copy, Debug, Default, serde::Serialize, serde::Deserialize)]
pub(crate) struct Noise {
    last: [[f32; 2]; 3],
    filled: u8,
    planes: u8,
    count: u32,
    variance: f32,
}

impl Noise {
    /// Takes the mean position over `planes` planes, m.
    pub(crate) fn take(&mut self, [x, y]: [f32; 2], planes: u8) {
        if planes != self.planes {
            self.planes = planes;
            self.filled = 0;
        }
        let [a, b, c] = self.last;
        self.last = [[x, y], a, b];
        if self.filled < 3 {
            self.filled += 1;
            return;
        }
        let dx = x - 3.0 * a[0] + 3.0 * b[0] - c[0];
        let dy = y - 3.0 * a[1] + 3.0 * b[1] - c[1];
        let mut square = (dx * dx + dy * dy) * (f32::from(planes) * (1.0 / 40.0));
        if self.count >= WARM_UP && square > CLIP * self.variance {
            square = CLIP * self.variance;
        }
        self.count = (self.count + 1).min(MEMORY.samples);
        self.variance += MEMORY.gain(self.count) * (square - self.variance);
    }

    /// A gap in the samples.
    pub(crate) fn skip(&mut self) {
        self.filled = 0;
    }

    /// Whether enough has been seen.
    pub(crate) fn is_known(&self) -> bool {
        self.count >= WARM_UP
    }

    /// Variance of one axis of the mean over `planes` planes, m^2; never below that of rounding to
    /// `resolution`.
    pub(crate) fn variance(&self, planes: u8, resolution: f32) -> f32 {
        let least = resolution * resolution * (1.0 / 12.0);
        let of_one = self.variance.max(least);
        if planes < 2 { of_one } else { 0.5 * of_one }
    }
}

/// White noise for tests: sum of twelve even numbers, mean 0, variance 1.
#[cfg(test)]
pub(crate) fn white(state: &mut u64) -> f32 {
    let mut sum = -6.0;
    for _ in 0..12 {
        *state = state
            .wrapping_mul(6_364_136_223_846_793_005)
            .wrapping_add(1_442_695_040_888_963_407);
        sum += (*state >> 40) as f32 / (1u64 << 24) as f32;
    }
    sum
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn smooth_motion_is_no_noise() {
        let mut noise = Noise::default();
        for k in 0..200 {
            let t = k as f32;
            noise.take([1e-6 * t, 1e-8 * t * t], 1);
        }
        assert!(noise.variance < 1e-17, "{}", noise.variance);
    }

    #[test]
    fn unknown_until_warm() {
        let mut noise = Noise::default();
        for k in 0..WARM_UP + 2 {
            assert!(!noise.is_known());
            noise.take([(k % 2) as f32, 0.0], 1);
        }
        noise.take([0.0, 0.0], 1);
        assert!(noise.is_known());
    }
}
