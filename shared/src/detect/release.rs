//! Loss of levitation: a generalised likelihood ratio test of "since t0 the rotor accelerates,
//! wherever to" against "it floats", for a bank of instants t0.
//!
//! Residuals r from the learnt position, a signature w = t^2: with A = sum r w and E = sum w^2 the
//! statistic is |A|^2/(2 sigma^2 E), which needs neither direction nor size of the acceleration.

use crate::detect::config::Tuning;

/// Instants in the bank.
const CANDIDATES: usize = 32;

/// Coefficients.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Release {
    period: f32,
    stride: u16,
    threshold: f32,
    gravity: f32,
}

#[derive(Clone, Copy, Debug, Default)]
struct Candidate {
    /// Samples since its instant; 0 while unused.
    age: u16,
    sum: [f32; 2],
    energy: f32,
}

/// The bank.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct ReleaseBank {
    candidates: [Candidate; CANDIDATES],
    next: usize,
    wait: u16,
    /// Largest statistic of the last sample.
    pub(crate) statistic: f32,
}

impl Release {
    pub(crate) fn new(tuning: &Tuning, sample_rate: f32, gravity: f32, threshold: f32) -> Self {
        let horizon = tuning.release_horizon * sample_rate;
        Self {
            period: 1.0 / sample_rate,
            stride: (horizon / CANDIDATES as f32).max(1.0) as u16,
            threshold,
            gravity,
        }
    }

    /// Takes a residual (m) whose axes have this variance (m^2). Where the test fires: samples since
    /// the most likely release.
    pub(crate) fn take(
        &self,
        bank: &mut ReleaseBank,
        [x, y]: [f32; 2],
        variance: f32,
    ) -> Option<u16> {
        if bank.wait == 0 {
            bank.wait = self.stride;
            if let Some(slot) = bank.candidates.get_mut(bank.next) {
                *slot = Candidate {
                    age: 0,
                    ..Candidate::default()
                };
            }
            bank.next = (bank.next + 1) % CANDIDATES;
        }
        bank.wait -= 1;
        let scale = 0.5 / variance;
        let half_gravity = 0.5 * self.gravity;
        let (mut best, mut falls) = ((0.0, 0), (0.0, 0));
        for candidate in &mut bank.candidates {
            candidate.age = candidate.age.saturating_add(1);
            let time = f32::from(candidate.age) * self.period;
            let w = time * time;
            candidate.sum[0] += x * w;
            candidate.sum[1] += y * w;
            candidate.energy += w * w;
            let [a, b] = candidate.sum;
            let any = (a * a + b * b) * scale / candidate.energy;
            if any > best.0 {
                best = (any, candidate.age);
            }
            let fall = -b * half_gravity - 0.5 * half_gravity * half_gravity * candidate.energy;
            if fall > falls.0 {
                falls = (fall, candidate.age);
            }
        }
        bank.statistic = best.0;
        if best.0 <= self.threshold {
            return None;
        }
        // With gravity known, the instant follows from the fall's shape far better.
        let is_a_fall = falls.0 > 0.5 * self.threshold * variance;
        Some(if is_a_fall { falls.1 } else { best.1 })
    }
}
