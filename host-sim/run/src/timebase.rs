//! When a sample was taken.

use touchdown_scene::Scene;

/// Places samples in time.
#[derive(Clone, Copy, Debug)]
pub struct Timebase {
    /// Time of sample 0, in samples.
    first: f64,
    rate: f64,
}

impl Timebase {
    /// Sample 0 at `start` (s), then `rate` samples a second. A start that is a whole number of
    /// samples but for rounding is taken as one, so that stamps are exactly k/rate.
    pub fn new(start: f64, rate: f64) -> Self {
        let first = start * rate;
        let whole = first.round();
        let near = (first - whole).abs() <= 1e-6;
        Self {
            first: if near { whole } else { first },
            rate,
        }
    }

    /// Of the samples of a drop.
    pub fn of(scene: &Scene) -> Self {
        Self::new(scene.first_sample_time(), scene.run.sample_rate)
    }

    /// Time of sample `sample` (may have a fraction), s.
    pub fn time(&self, sample: f64) -> f64 {
        (self.first + sample) / self.rate
    }
}
