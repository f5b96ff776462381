//! Loss of levitation: a generalised likelihood ratio test of "since t0 the rotor accelerates,
//! wherever to" against "it floats", for a bank of instants t0.
//!
//! Residuals r of the trend, which an acceleration a since t0 makes a w: with A = sum r w and E = sum w^2 the statistic
//! is |A|^2/(2 E), which needs neither direction nor size of the acceleration. In white noise its mean is the variance.
//!
//! What a healthy machine does is no white noise: runout, hum, wander raise the statistic, and more so for old instants.
//! Its mean while levitated is learnt at each age.

use crate::config::{MOST_INSTANTS, Tuning};
use touchdown_rotor::real::sqrt;

/// Most that one sample can say, in standard deviations of what the residuals have been: a fall is found long
/// before it is that far in a sample.
const MAX_RESIDUAL_SIGMA: f32 = 6.0;
/// Parts of the threshold that an instant needs which is no samples old, and for each that it is: below them, what a
/// reading that jumps by a count in each plane at once adds to noise may be. With a shift of s standard deviations (of
/// the mean of two planes of 1 um and 12 bits over 2 mm: 0.69) and z = 4.3, (0.745 s sqrt(n) + z)^2/2 over 25.3, between
/// n = 30 and 80.
const SHIFTED: [f32; 2] = [0.66, 0.011];
/// Seconds over which the mean is learnt: a fall of 3 ms is 1 % of it.
const LEVEL_TIME: f32 = 0.3;
/// Most of the mean that one value counts for.
const CLIP: f32 = 9.0;
/// Values that a mean begins with.
const FIRST: f32 = 8.0;
/// Acceleration, m/s^2, that a rotor which floats may have: 50 um in 20 ms are 5.77 d/T^2 at the most, 0.074 g.
const FLOATING: f32 = 0.981;

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

#[derive(Clone, Copy, Debug, Default, serde::Serialize, serde::Deserialize)]
pub(crate) struct Candidate {
    sum: [f32; 2],
    energy: f32,
}

/// The bank.
#[derive(Clone, Copy, Debug, Default, serde::Serialize, serde::Deserialize)]
pub(crate) struct ReleaseBank {
    /// The newest first; used or not.
    #[serde(skip)]
    pub(crate) candidates: [Candidate; MOST_INSTANTS],
    /// Mean of the statistic by age, in steps from one instant to the next, m^2.
    #[serde(skip)]
    pub(crate) levels: [f32; MOST_INSTANTS],
    /// How many of them there are so far.
    live: usize,
    wait: u16,
    /// exp(-t/tau) of the trend's memory tau, for the newest instant and from one to the next.
    left: f32,
    fading: f32,
    count: f32,
    /// Largest of the levels, m^2.
    pub(crate) highest: f32,
}

/// A release that was found.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Released {
    /// Samples since the most likely instant.
    pub(crate) age: f32,
    /// Since then, m/s^2.
    pub(crate) acceleration: [f32; 2],
    /// What the trend has taken of a unit of it: place, s^2, and speed, s.
    pub(crate) taken: [f32; 2],
}

impl ReleaseBank {
    /// Forgets what was under way, not what was learnt.
    pub(crate) fn restart(&mut self) {
        self.live = 0;
        self.wait = 0;
    }

    /// Forgets what was learnt as well.
    pub(crate) fn forget(&mut self) {
        self.restart();
        self.levels = [0.0; MOST_INSTANTS];
        self.count = 0.0;
        self.highest = 0.0;
    }

    /// Learns the levels, where the instants are whole steps old.
    fn learn(&mut self, memory: f32, variance: f32) {
        self.count = (self.count + 1.0).min(memory);
        let gain = 1.0 / (self.count + FIRST);
        self.highest = variance;
        for (level, it) in (self.levels.iter_mut().zip(&self.candidates)).take(self.live) {
            let known = level.max(variance);
            *level = (known + gain * (it.statistic().min(CLIP * known) - known)).max(variance);
            self.highest = self.highest.max(*level);
        }
    }

    /// The instants, the newest first.
    fn instants(&self) -> impl Iterator<Item = &Candidate> {
        self.candidates.iter().take(self.live)
    }
}

/// The instant with the most of something above `least`.
fn top(bank: &ReleaseBank, least: f32, what: impl Fn(&Candidate) -> f32) -> Option<usize> {
    let mut best = (least, None);
    for (number, it) in bank.instants().enumerate() {
        if what(it) > best.0 {
            best = (what(it), Some(number));
        }
    }
    best.1
}

impl Candidate {
    /// m^2.
    fn statistic(&self) -> f32 {
        let [a, b] = self.sum;
        0.5 * (a * a + b * b) / self.energy
    }
}

impl Release {
    pub(crate) fn new(tuning: &Tuning, sample_rate: f32, gravity: f32, threshold: f32) -> Self {
        let horizon = tuning.release_horizon * sample_rate;
        let stride = (horizon / f32::from(tuning.release_instants)).max(1.0) as u16;
        Self {
            period: 1.0 / sample_rate,
            instants: usize::from(tuning.release_instants),
            stride,
            threshold,
            gravity,
            memory: (LEVEL_TIME * sample_rate / f32::from(stride)).max(1.0),
        }
    }

    /// Takes a residual (m) of a trend with this memory (s), whose axes have this variance (m^2). Where the test fires,
    /// what it found.
    pub(crate) fn take(
        &self,
        bank: &mut ReleaseBank,
        [x, y]: [f32; 2],
        memory: f32,
        variance: f32,
    ) -> Option<Released> {
        if bank.wait == 0 {
            bank.wait = self.stride;
            if bank.live > 0 {
                bank.learn(self.memory, variance);
            }
            bank.live = (bank.live + 1).min(self.instants);
            let mut newer = Candidate::default();
            for it in bank.candidates.iter_mut().take(bank.live) {
                newer = core::mem::replace(it, newer);
            }
            bank.fading = bank.left;
            bank.left = 1.0;
        }
        bank.wait -= 1;
        let most = MAX_RESIDUAL_SIGMA * MAX_RESIDUAL_SIGMA * variance.max(bank.highest);
        let size = x * x + y * y;
        let (x, y) = if size > most {
            let part = sqrt(most / size);
            (part * x, part * y)
        } else {
            (x, y)
        };
        let step = self.period / memory;
        bank.left /= 1.0 + step + 0.5 * step * step;
        let (square, threshold) = (memory * memory, 2.0 * self.threshold);
        let every = f32::from(self.stride) * step;
        // Since the instant over the memory, and exp of its negative.
        let (mut time, mut left) = (self.age(bank, 0) * step, bank.left);
        let mut most = 0.0;
        let candidates = bank.candidates.get_mut(..bank.live).unwrap_or_default();
        for (it, level) in candidates.iter_mut().zip(&bank.levels) {
            let w = square * (1.0 - (1.0 + time) * left);
            it.sum[0] += x * w;
            it.sum[1] += y * w;
            it.energy += w * w;
            let [a, b] = it.sum;
            let above = a * a + b * b - it.energy * level * threshold;
            most = if above > most { above } else { most };
            time += every;
            left *= bank.fading;
        }
        if most <= 0.0 || !self.is_found(bank, variance) {
            return None;
        }
        // A fall is known by its shape, with gravity, which dates it far better.
        let g = self.gravity;
        let fall = |it: &Candidate| -it.sum[1] * g - 0.5 * g * g * it.energy;
        let falls = top(bank, 0.5 * self.threshold * variance, fall);
        let number = falls.or_else(|| top(bank, 0.0, Candidate::statistic))?;
        let it = bank.candidates.get(number)?;
        let acceleration = it.sum.map(|sum| sum / it.energy);
        let age = self.age(bank, number);
        let time = age * self.period;
        // To 1 % up to where a fall is found.
        let x = time / memory;
        let left = 1.0 / (1.0 + x * (1.0 + x * (0.5 + x * (1.0 / 6.0))));
        let w = memory * memory * (1.0 - (1.0 + x) * left);
        Some(Released {
            age: falls.map_or(age, |_| self.date(age, -acceleration[1] / g)),
            acceleration,
            taken: [0.5 * time * time - w, time * (1.0 - left)],
        })
    }

    /// Samples since an instant, the newest first.
    fn age(&self, bank: &ReleaseBank, number: usize) -> f32 {
        f32::from(self.stride) * (number as f32 + 1.0) - f32::from(bank.wait)
    }

    /// Whether an instant is above its threshold: a multiple of the level of its age, beyond what a floating rotor's
    /// acceleration makes, and above what readings that jump by a count may do.
    fn is_found(&self, bank: &ReleaseBank, variance: f32) -> bool {
        let mut instants = bank.instants().zip(&bank.levels).enumerate();
        instants.any(|(number, (it, level))| {
            let shifted = (SHIFTED[0] + SHIFTED[1] * self.age(bank, number)) * variance;
            let statistic = it.statistic();
            let threshold = self.threshold * level.max(variance).max(shifted);
            statistic > threshold && {
                let least = sqrt(threshold) + FLOATING * sqrt(0.5 * it.energy);
                statistic > least * least
            }
        })
    }

    /// Samples since the onset of a fall that seems to be of so many times gravity since an instant of this age. Of a fall
    /// since T an instant of age a shows 1 + 5/2 d + 5/3 d^2, with d = T/a - 1: the sum of t^2 (t + T - a)^2 over that of t^4.
    fn date(&self, age: f32, times: f32) -> f32 {
        let root = sqrt((20.0 / 3.0 * times - 5.0 / 12.0).max(0.0));
        let later = age * 0.3 * (root - 2.5);
        let stride = f32::from(self.stride);
        age + later.min(stride).max(-stride)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::detect::noise::white;
    use crate::detect::trend::MEMORY;

    #[test]
    fn the_levels_of_white_noise_are_its_variance() {
        for sample_rate in [10_000.0, 20_000.0, 50_000.0] {
            let release = Release::new(&Tuning::default(), sample_rate, 9.81, 25.3);
            let (mut bank, mut seed) = (ReleaseBank::default(), 1);
            for _ in 0..200_000 {
                let residual = [1e-6 * white(&mut seed), 1e-6 * white(&mut seed)];
                assert!(release.take(&mut bank, residual, MEMORY, 1e-12).is_none());
            }
            for level in bank.levels.iter().take(bank.live) {
                assert!((level / 1e-12 - 1.0).abs() < 0.2, "{sample_rate}: {level}");
            }
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
            let found = release.take(&mut bank, residual, MEMORY, variance);
            assert!(k < 1_000 || found.is_none(), "{k}");
        }
        let found = (1..160).find(|&k| {
            let [x, y] = orbit(k);
            let time = k as f32 / 20_000.0;
            let residual = [x, y - 0.5 * 9.81 * time * time];
            release
                .take(&mut bank, residual, MEMORY, variance)
                .is_some()
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
                let found = release.take(&mut bank, [noise(), noise()], MEMORY, 0.56e-12);
                assert!(found.is_none());
            }
            let (fallen, age) = (1..100)
                .find_map(|k| {
                    let time = k as f32 / 20_000.0;
                    let residual = [noise(), noise() - 0.5 * 9.81 * time * time];
                    let found = release.take(&mut bank, residual, MEMORY, 0.56e-12);
                    found.map(|it| (k as f32, it.age))
                })
                .expect("a fall of 0.12 mm");
            off += (age - fallen).abs() / 400.0;
        }
        assert!(off < 1.0, "{off} samples");
    }
}
