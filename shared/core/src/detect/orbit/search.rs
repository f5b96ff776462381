//! The frequency of an orbit that nothing is known of.
//!
//! Of a motion at one frequency, the sum of the positions a time D before and after is 2 cos(omega D) times
//! the position between, but for a constant: a straight line fitted through these pairs gives omega. A
//! short D is unambiguous, a long one exact; four are used, each to choose among the next one's answers.
//! Positions are means of short blocks, so that the memory does not depend on the sample rate.

use touchdown_rotor::real::{atan2, sqrt};

/// Length of a block, s: half a turn at 2 kHz.
const BLOCK: f32 = 0.25e-3;
/// D, in blocks.
const DELAYS: [usize; 4] = [1, 4, 12, 36];
/// Blocks that the longest D needs.
const LINE: usize = 73;
/// Angle omega D, rad, up to which a delay is unambiguous, with a margin to pi.
const UNAMBIGUOUS: f32 = 2.2;
/// Pairs that a fit needs.
const LEAST_PAIRS: f32 = 16.0;
/// Variance of the blocks, over that of white noise, above which there is an orbit. White noise alone
/// stays below 1.5 with 200 blocks.
const SEEN: f32 = 4.0;

/// Coefficients.
#[derive(Clone, Copy, Debug)]
pub(super) struct Search {
    /// Samples in a block.
    block: u16,
}

/// Sums of a delay's fit.
#[derive(Clone, Copy, Debug, Default)]
struct Pairs {
    count: f32,
    middle: [f32; 2],
    around: [f32; 2],
    middle_square: f32,
    product: f32,
}

/// A search under way.
#[derive(Clone, Copy, Debug)]
pub(super) struct Searching {
    origin: Option<[f32; 2]>,
    sum: [f32; 2],
    samples: u16,
    line: [[f32; 2]; LINE],
    blocks: usize,
    pairs: [Pairs; DELAYS.len()],
}

impl Default for Searching {
    fn default() -> Self {
        Self {
            origin: None,
            sum: [0.0; 2],
            samples: 0,
            line: [[0.0; 2]; LINE],
            blocks: 0,
            pairs: [Pairs::default(); DELAYS.len()],
        }
    }
}

impl Search {
    pub(super) fn new(sample_rate: f32) -> Self {
        Self {
            block: (BLOCK * sample_rate).max(1.0) as u16,
        }
    }

    /// Takes a position, m.
    pub(super) fn take(&self, state: &mut Searching, position: [f32; 2]) {
        let origin = *state.origin.get_or_insert(position);
        for ((sum, x), first) in state.sum.iter_mut().zip(position).zip(origin) {
            *sum += x - first;
        }
        state.samples += 1;
        if state.samples == self.block {
            let scale = 1.0 / f32::from(self.block);
            let mean = state.sum.map(|sum| sum * scale);
            state.sum = [0.0; 2];
            state.samples = 0;
            state.push(mean);
        }
    }

    /// Angle of a sample, rad, where white noise of this variance (m^2) has an orbit in it.
    pub(super) fn rate(&self, state: &Searching, variance: f32) -> Option<f32> {
        let block = f32::from(self.block);
        let noise = 2.0 * variance / block;
        let mut found = None;
        for (pairs, delay) in state.pairs.iter().zip(DELAYS) {
            let length = delay as f32 * block;
            if found.is_some_and(|rate| rate * length > UNAMBIGUOUS) {
                break;
            }
            if let Some(cosine) = pairs.cosine(noise) {
                let sine = sqrt((1.0 - cosine) * (1.0 + cosine));
                found = Some(atan2(sine, cosine) / length);
            }
        }
        found.filter(|rate| *rate > 0.0)
    }
}

impl Searching {
    /// Begins again.
    pub(super) fn forget(&mut self) {
        self.origin = None;
        self.sum = [0.0; 2];
        self.samples = 0;
        self.blocks = 0;
        self.pairs = Default::default();
    }

    fn push(&mut self, mean: [f32; 2]) {
        if let Some(slot) = self.line.get_mut(self.blocks % LINE) {
            *slot = mean;
        }
        let newest = self.blocks;
        self.blocks += 1;
        let at = |back: usize| {
            let index = newest.checked_sub(back)? % LINE;
            self.line.get(index).copied()
        };
        for (pairs, delay) in self.pairs.iter_mut().zip(DELAYS) {
            if let (Some(middle), Some(oldest)) = (at(delay), at(2 * delay)) {
                pairs.take(middle, [mean[0] + oldest[0], mean[1] + oldest[1]]);
            }
        }
    }
}

impl Pairs {
    fn take(&mut self, middle: [f32; 2], around: [f32; 2]) {
        self.count += 1.0;
        for axis in 0..2 {
            self.middle[axis] += middle[axis];
            self.around[axis] += around[axis];
            self.middle_square += middle[axis] * middle[axis];
            self.product += middle[axis] * around[axis];
        }
    }

    /// Cosine of omega D, where the middles vary by clearly more than `noise` (both axes, m^2).
    fn cosine(&self, noise: f32) -> Option<f32> {
        if self.count < LEAST_PAIRS {
            return None;
        }
        let scale = 1.0 / self.count;
        let [mx, my] = self.middle.map(|sum| sum * scale);
        let [ax, ay] = self.around.map(|sum| sum * scale);
        let spread = self.middle_square * scale - mx * mx - my * my;
        let product = self.product * scale - mx * ax - my * ay;
        (spread > SEEN * noise).then(|| (0.5 * product / (spread - noise)).clamp(-1.0, 1.0))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::detect::noise::white;

    fn found(hz: f32, orbit: f32, sample_rate: f32) -> Option<f32> {
        let search = Search::new(sample_rate);
        let (mut state, mut seed) = (Searching::default(), 1);
        for k in 0..(0.05 * sample_rate) as u32 {
            let angle =
                core::f64::consts::TAU * f64::from(hz) * f64::from(k) / f64::from(sample_rate);
            let (sin, cos) = libm::sincosf((angle % core::f64::consts::TAU) as f32 + 1.0);
            let noise = [white(&mut seed), white(&mut seed)].map(|it| 1e-6 * it);
            search.take(
                &mut state,
                [orbit * cos + noise[0] + 5e-5, orbit * sin + noise[1]],
            );
        }
        let rate = search.rate(&state, 1e-12)?;
        Some(rate * sample_rate / core::f32::consts::TAU)
    }

    #[test]
    fn finds_what_turns_and_nothing_in_noise() {
        for sample_rate in [10_000.0, 20_000.0, 50_000.0] {
            for hz in [10.0, 20.0, 50.0, 100.0, 200.0, 500.0, 800.0] {
                let seen = found(hz, 30e-6, sample_rate).expect("an orbit");
                assert!(
                    (seen / hz - 1.0).abs() < 0.03,
                    "{hz} at {sample_rate}: {seen}"
                );
            }
            assert_eq!(found(100.0, 0.0, sample_rate), None);
        }
    }
}
