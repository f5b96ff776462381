//! Velocity jumps in flight: Willsky and Jones' generalised likelihood ratio test on the filter's
//! innovations, for a bank of instants.
//!
//! For each instant the bank follows what a unit jump there would have done to the filter's error,
//! so the test knows that the filter has begun to follow the jump.

use crate::detect::config::Tuning;
use crate::detect::track::Innovation;

/// Instants in the bank.
const CANDIDATES: usize = 32;

/// Coefficients.
#[derive(Clone, Copy, Debug)]
pub(crate) struct JumpTest {
    period: f32,
    stride: u16,
    threshold: f32,
}

#[derive(Clone, Copy, Debug, Default)]
struct Candidate {
    age: u16,
    used: bool,
    /// Error of position (m per m/s) and velocity that a unit jump has left.
    effect: [f32; 2],
    information: f32,
    sum: [f32; 2],
}

/// The bank.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct JumpBank {
    candidates: [Candidate; CANDIDATES],
    next: usize,
    wait: u16,
    /// Largest statistic of the last sample.
    pub(crate) statistic: f32,
}

/// A jump that the test found.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Jump {
    /// Samples since, to a fraction.
    pub(crate) age: f32,
    /// m/s.
    pub(crate) change: [f32; 2],
    /// Variance of each axis of `change`, (m/s)^2.
    pub(crate) variance: f32,
    /// What a unit of it has left in the filter.
    pub(crate) effect: [f32; 2],
}

impl JumpTest {
    pub(crate) fn new(tuning: &Tuning, sample_rate: f32, threshold: f32) -> Self {
        let horizon = tuning.impact_horizon * sample_rate;
        Self {
            period: 1.0 / sample_rate,
            stride: (horizon / CANDIDATES as f32).max(1.0) as u16,
            threshold,
        }
    }

    /// Takes the innovation of a sample; `inward` is the direction (unit vector) that a jump at the
    /// wall has.
    pub(crate) fn take(
        &self,
        bank: &mut JumpBank,
        innovation: &Innovation,
        inward: [f32; 2],
    ) -> Option<Jump> {
        if bank.wait == 0 {
            bank.wait = self.stride;
            if let Some(slot) = bank.candidates.get_mut(bank.next) {
                // On average half a sample before the sample, and half a stride with it.
                *slot = Candidate {
                    used: true,
                    effect: [-0.5 * self.period, 1.0],
                    ..Candidate::default()
                };
            }
            bank.next = (bank.next + 1) % CANDIDATES;
        }
        bank.wait -= 1;
        let [rx, ry] = innovation.residual;
        let weight = 1.0 / innovation.variance;
        let mut best: Option<(f32, usize)> = None;
        for (index, candidate) in bank.candidates.iter_mut().enumerate() {
            if !candidate.used {
                continue;
            }
            candidate.age = candidate.age.saturating_add(1);
            candidate.effect[0] += self.period * candidate.effect[1];
            let seen = candidate.effect[0];
            candidate.information += seen * seen * weight;
            candidate.sum[0] += seen * rx * weight;
            candidate.sum[1] += seen * ry * weight;
            candidate.effect[0] -= innovation.gain[0] * seen;
            candidate.effect[1] -= innovation.gain[1] * seen;
            let statistic = candidate.statistic(inward);
            if best.is_none_or(|(most, _)| statistic > most) {
                best = Some((statistic, index));
            }
        }
        let (statistic, index) = best?;
        bank.statistic = statistic;
        (statistic > self.threshold).then(|| self.jump(bank, index, inward))
    }

    fn jump(&self, bank: &JumpBank, index: usize, inward: [f32; 2]) -> Jump {
        let found = bank.candidates.get(index).copied().unwrap_or_default();
        // The peak between neighbouring instants, by a parabola through the three.
        let neighbour = |step: usize| {
            let at = (index + step) % CANDIDATES;
            let near = bank.candidates.get(at).copied().unwrap_or_default();
            let apart = i32::from(near.age) - i32::from(found.age);
            (near.used && apart.unsigned_abs() == u32::from(self.stride))
                .then(|| near.statistic(inward))
        };
        let shift = match (neighbour(CANDIDATES - 1), neighbour(1)) {
            (Some(older), Some(younger)) => {
                let bend = older - 2.0 * found.statistic(inward) + younger;
                if bend < 0.0 {
                    (0.5 * (younger - older) / bend).clamp(-0.5, 0.5) * f32::from(self.stride)
                } else {
                    0.0
                }
            }
            _ => 0.0,
        };
        let scale = 1.0 / found.information;
        Jump {
            age: (f32::from(found.age) - 0.5 + shift).max(0.0),
            change: found.sum.map(|sum| sum * scale),
            variance: scale,
            effect: found.effect,
        }
    }
}

impl Candidate {
    fn statistic(&self, [nx, ny]: [f32; 2]) -> f32 {
        let along = self.sum[0] * nx + self.sum[1] * ny;
        if along > 0.0 && self.information > 0.0 {
            0.5 * along * along / self.information
        } else {
            0.0
        }
    }
}
