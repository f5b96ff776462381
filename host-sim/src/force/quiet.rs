//! The part of a record before anything happens: what its zero and its noise are.

/// What comes before the first sample this part of the greatest is quiet.
const LOUD: f64 = 0.1;
/// Left out before that sample, s.
const MARGIN: f64 = 1e-3;
/// Least quiet part, s.
const LEAST: f64 = 5e-3;
/// Noise is not taken below this part of the greatest: the last digits of a converter of 16 bit.
const FLOOR: f64 = 1e-5;

/// The quiet part of a signal, in its unit.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Quiet {
    /// So many from the beginning.
    pub samples: usize,
    /// The signal's zero.
    pub mean: f64,
    /// Standard deviation of a sample.
    pub noise: f64,
}

impl Quiet {
    /// The quiet part of `signal`, sampled at `rate` (Hz); else the rule that is broken.
    pub fn find(signal: &[f64], rate: f64) -> Result<Self, String> {
        let samples = ((LEAST * rate).ceil() as usize).max(2);
        let begin = &signal[..samples.min(signal.len())];
        let zero = begin.iter().sum::<f64>() / begin.len().max(1) as f64;
        let most = greatest(signal, zero);
        let loud = signal
            .iter()
            .position(|it| (it - zero).abs() >= LOUD * most);
        let quiet = loud.map_or(signal.len(), |loud| {
            loud.saturating_sub((MARGIN * rate).ceil() as usize)
        });
        if quiet < samples {
            return Err(format!(
                "the record must begin with {} ms or more of quiet for its zero and its noise, \
                 {} ms before the first {} % of the greatest; here are {:.3} ms",
                1e3 * LEAST,
                1e3 * MARGIN,
                100.0 * LOUD,
                1e3 * quiet as f64 / rate
            ));
        }
        Ok(Self::of(signal, quiet))
    }

    /// Of the first `samples`, 2 or more, of `signal`.
    pub fn of(signal: &[f64], samples: usize) -> Self {
        let part = &signal[..samples.min(signal.len())];
        let count = part.len() as f64;
        let mean = part.iter().sum::<f64>() / count;
        let squares: f64 = part.iter().map(|it| (it - mean) * (it - mean)).sum();
        let noise = (squares / (count - 1.0)).sqrt();
        Self {
            samples,
            mean,
            noise: noise.max(FLOOR * greatest(signal, mean)),
        }
    }
}

/// Greatest distance from `zero`.
pub fn greatest(signal: &[f64], zero: f64) -> f64 {
    signal
        .iter()
        .map(|it| (it - zero).abs())
        .fold(0.0, f64::max)
}
