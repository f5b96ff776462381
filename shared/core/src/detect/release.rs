//! Loss of levitation: a generalised likelihood ratio test of "since t0 the rotor accelerates,
//! wherever to" against "it floats", for a bank of instants t0.
//!
//! Residuals r from the learnt position, a signature w = t^2: with A = sum r w and E = sum w^2 the
//! statistic is |A|^2/(2 sigma^2 E), which needs neither direction nor size of the acceleration.
//!
//! What a healthy machine does is no white noise: an unbalance orbit, runout or hum raise the statistic
//! as a whole. Its mean while levitated is learnt, and the threshold raised in proportion.

use crate::config::{MOST_INSTANTS, Tuning};
use touchdown_rotor::real::sqrt;

/// Mean of the largest statistic of the bank in white noise, as the test below measures it.
const WHITE_LEVEL: f32 = 1.8;
/// Most that one sample can say, in standard deviations of what the residuals have been: a fall is found long
/// before it is that far in a sample.
const MAX_RESIDUAL_SIGMA: f32 = 6.0;
/// Parts of the threshold that an instant needs which is no samples old, and for each that it is: below them, what a
/// reading that jumps by a count in each plane at once adds to noise may be. With a shift of s standard deviations (of
/// the mean of two planes of 1 um and 12 bits over 2 mm: 0.69) and z = 4.3, (0.745 s sqrt(n) + z)^2/2 over 25.3, between
/// n = 30 and 80.
const SHIFTED: [f32; 2] = [0.66, 0.011];
/// Seconds over which the mean is learnt.
const LEVEL_TIME: f32 = 0.2;

/// Coefficients.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Release {
    period: f32,
    instants: usize,
    /// Samples from one to the next.
    stride: u16,
    threshold: f32,
    gravity: f32,
    memory: f32,
}

#[derive(Clone, Copy, Debug, Default)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub(crate) struct Candidate {
    /// Samples since its instant.
    age: f32,
    sum: [f32; 2],
    energy: f32,
}

/// The bank.
#[derive(Clone, Copy, Debug, Default)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub(crate) struct ReleaseBank {
    #[cfg_attr(feature = "serde", serde(skip))]
    candidates: [Candidate; MOST_INSTANTS],
    /// How many of them there are so far.
    live: usize,
    next: usize,
    wait: u16,
    /// Largest statistic of the last sample.
    pub(crate) statistic: f32,
    level: f32,
    count: f32,
}

impl ReleaseBank {
    /// Forgets what was under way, not what was learnt.
    pub(crate) fn restart(&mut self) {
        self.live = 0;
        self.next = 0;
        self.wait = 0;
        self.statistic = 0.0;
    }

    /// Whether an instant is above the threshold, and above what readings that jump by a count may do.
    fn is_more_than_a_shift(&self, threshold: f32, threshold_scale: f32, scale: f32) -> bool {
        let mut candidates = self.candidates.iter().take(self.live);
        candidates.any(|it| {
            let part = threshold_scale.max(SHIFTED[0] + SHIFTED[1] * it.age);
            it.statistic(scale) > threshold * part
        })
    }

    /// The instants, used or not.
    #[cfg(feature = "serde")]
    pub(crate) fn candidates(&self) -> &[Candidate] {
        &self.candidates
    }

    /// The instants, used or not.
    #[cfg(feature = "serde")]
    pub(crate) fn candidates_mut(&mut self) -> &mut [Candidate] {
        &mut self.candidates
    }

    /// Forgets what was learnt as well.
    pub(crate) fn forget(&mut self) {
        self.restart();
        self.level = 0.0;
        self.count = 0.0;
    }
}

impl Candidate {
    /// `scale`: half over the variance, 1/m^2.
    fn statistic(&self, scale: f32) -> f32 {
        let [a, b] = self.sum;
        (a * a + b * b) * scale / self.energy
    }
}

impl Release {
    pub(crate) fn new(tuning: &Tuning, sample_rate: f32, gravity: f32, threshold: f32) -> Self {
        let horizon = tuning.release_horizon * sample_rate;
        Self {
            period: 1.0 / sample_rate,
            instants: usize::from(tuning.release_instants),
            stride: (horizon / f32::from(tuning.release_instants)).max(1.0) as u16,
            threshold,
            gravity,
            memory: LEVEL_TIME * sample_rate,
        }
    }

    /// Takes a residual (m) whose axes have this variance (m^2). Where the test fires: samples since
    /// the most likely release.
    pub(crate) fn take(
        &self,
        bank: &mut ReleaseBank,
        [x, y]: [f32; 2],
        variance: f32,
    ) -> Option<f32> {
        if bank.wait == 0 {
            bank.wait = self.stride;
            if let Some(slot) = bank.candidates.get_mut(bank.next) {
                *slot = Candidate::default();
            }
            bank.live = bank.live.max(bank.next + 1);
            bank.next = if bank.next + 1 < self.instants {
                bank.next + 1
            } else {
                0
            };
        }
        bank.wait -= 1;
        let threshold_scale = (bank.level / WHITE_LEVEL).max(1.0);
        let most = MAX_RESIDUAL_SIGMA * sqrt(variance * threshold_scale);
        let (x, y) = (x.min(most).max(-most), y.min(most).max(-most));
        let scale = 0.5 / variance;
        let mut best = (0.0, 0.0);
        for candidate in bank.candidates.iter_mut().take(bank.live) {
            candidate.age += 1.0;
            let time = candidate.age * self.period;
            let w = time * time;
            candidate.sum[0] += x * w;
            candidate.sum[1] += y * w;
            candidate.energy += w * w;
            let any = candidate.statistic(scale);
            if any > best.0 {
                best = (any, candidate.age);
            }
        }
        bank.statistic = best.0;
        let threshold = self.threshold * threshold_scale;
        bank.count = (bank.count + 1.0).min(self.memory);
        bank.level += (best.0 - bank.level) / bank.count;
        if best.0 <= threshold || !bank.is_more_than_a_shift(self.threshold, threshold_scale, scale)
        {
            return None;
        }
        // With gravity known, the instant follows from the fall's shape far better.
        let (likelihood, age) = self.fall(bank);
        let is_a_fall = likelihood > 0.5 * self.threshold * variance;
        Some(if is_a_fall { age } else { best.1 })
    }

    /// Log likelihood of the likeliest fall, times the variance, and its age in samples.
    fn fall(&self, bank: &ReleaseBank) -> (f32, f32) {
        let half_gravity = 0.5 * self.gravity;
        let mut best = (0.0, 0.0);
        for Candidate { age, sum, energy } in bank.candidates.iter().take(bank.live) {
            let fall = -sum[1] * half_gravity - 0.5 * half_gravity * half_gravity * energy;
            if fall > best.0 {
                best = (fall, *age);
            }
        }
        best
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::detect::noise::white;

    fn level(sample_rate: f32) -> f32 {
        let release = Release::new(&Tuning::default(), sample_rate, 9.81, 25.3);
        let (mut bank, mut seed) = (ReleaseBank::default(), 1);
        let mut sum = 0.0;
        for _ in 0..200_000 {
            let residual = [1e-6 * white(&mut seed), 1e-6 * white(&mut seed)];
            assert_eq!(release.take(&mut bank, residual, 1e-12), None);
            sum += f64::from(bank.statistic);
        }
        (sum / 200_000.0) as f32
    }

    #[test]
    fn the_level_of_white_noise() {
        for sample_rate in [10_000.0, 20_000.0, 50_000.0] {
            let level = level(sample_rate);
            assert!(
                (level / WHITE_LEVEL - 1.0).abs() < 0.1,
                "{sample_rate} {level}"
            );
        }
    }

    #[test]
    fn an_orbit_raises_the_threshold_and_a_fall_passes_it() {
        let release = Release::new(&Tuning::default(), 20_000.0, 9.81, 25.3);
        let (mut bank, mut seed) = (ReleaseBank::default(), 1);
        let orbit = |k: u32| {
            let (sin, cos) = libm::sincosf(core::f32::consts::TAU * 50.0 * k as f32 / 20_000.0);
            [30e-6 * cos, 30e-6 * sin]
        };
        let variance = 450e-12;
        for k in 0..40_000 {
            let [x, y] = orbit(k);
            let residual = [x + 1e-6 * white(&mut seed), y + 1e-6 * white(&mut seed)];
            // The first samples teach the level.
            let found = release.take(&mut bank, residual, variance);
            assert!(k < 1_000 || found.is_none(), "{k}");
        }
        let found = (1..160).find(|&k| {
            let [x, y] = orbit(k);
            let time = k as f32 / 20_000.0;
            let residual = [x, y - 0.5 * 9.81 * time * time];
            release.take(&mut bank, residual, variance).is_some()
        });
        assert!(found.is_some(), "a fall of 0.3 mm in 7.8 ms");
    }

    /// Where the statistic alone, which knows no gravity, is off by 2.8 samples.
    #[test]
    fn a_fall_is_dated_by_its_shape() {
        let release = Release::new(&Tuning::default(), 20_000.0, 9.81, 25.3);
        let mut seed = 1;
        let mut noise = || 0.75e-6 * white(&mut seed);
        let mut off = 0.0;
        for drop in 0..400 {
            let mut bank = ReleaseBank::default();
            for _ in 0..400 + drop {
                let found = release.take(&mut bank, [noise(), noise()], 0.56e-12);
                assert_eq!(found, None);
            }
            let (fallen, age) = (1..100)
                .find_map(|k| {
                    let time = k as f32 / 20_000.0;
                    let residual = [noise(), noise() - 0.5 * 9.81 * time * time];
                    let found = release.take(&mut bank, residual, 0.56e-12);
                    found.map(|age| (k as f32, age))
                })
                .expect("a fall of 0.12 mm");
            off += (age - fallen).abs() / 400.0;
        }
        assert!(off < 1.6, "{off} samples");
    }
}
