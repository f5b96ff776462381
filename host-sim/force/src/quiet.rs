//! The part of a record before anything happens: what its zero and its noise are.

/// What comes before the first sample of this part of the greatest is quiet.
const LOUD: f64 = 0.1;
/// It is above the noise by this factor.
const CLEAR: f64 = 6.0;
/// Left out before that sample, s.
const MARGIN: f64 = 1e-3;
/// Least quiet part, s.
const LEAST: f64 = 5e-3;
/// Parts of it whose noises are compared...
const BLOCKS: usize = 5;
/// ...and may differ by this factor...
const UNEVEN: f64 = 3.0;
/// ...unless all are below this part of the greatest.
const FAINT: f64 = 0.02;
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
        if signal.len() <= samples {
            return Err(too_loud("it ends before that"));
        }
        let begin = Self::of(signal, samples);
        let most = greatest(signal, begin.mean);
        let blocks = signal[..samples].chunks(samples.div_ceil(BLOCKS));
        let noises = blocks.map(|it| Self::of(it, it.len()).noise);
        let low = noises.clone().fold(f64::INFINITY, f64::min);
        let high = noises.fold(0.0, f64::max);
        if high > (UNEVEN * low).max(FAINT * most) {
            return Err(too_loud("here something happens in it"));
        }
        let level = (LOUD * most).max(CLEAR * begin.noise);
        let loud = (signal.iter()).position(|it| (it - begin.mean).abs() > level);
        let margin = (MARGIN * rate).ceil() as usize;
        match loud {
            None => Ok(Self::of(signal, signal.len())),
            Some(loud) if loud >= samples + margin => Ok(Self::of(signal, loud - margin)),
            Some(loud) => {
                let after = 1e3 * loud as f64 / rate;
                Err(too_loud(&format!("here it rises after {after:.3} ms")))
            }
        }
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

fn too_loud(what: &str) -> String {
    format!(
        "the record must begin with {} ms of quiet and {} ms more before the first contact, for its \
         zero and its noise; {what}",
        1e3 * LEAST,
        1e3 * MARGIN
    )
}

/// Greatest distance from `zero`.
pub fn greatest(signal: &[f64], zero: f64) -> f64 {
    let distances = signal.iter().map(|it| (it - zero).abs());
    distances.fold(0.0, f64::max)
}
