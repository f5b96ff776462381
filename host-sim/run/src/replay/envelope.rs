//! The waveform of a recording of any length: the least and the greatest value of each stretch.

use touchdown_core::sample::CHANNELS;

/// Stretches that are kept.
const MOST: usize = 2048;

/// Least and greatest displacement of each channel over a stretch, m; NaN where there is none.
pub type Bucket = [[f64; 2]; CHANNELS];

const EMPTY: Bucket = [[f64::NAN; 2]; CHANNELS];

/// Stretches of so many samples; when there are too many, each two become one.
#[derive(Clone, Debug)]
pub struct Envelope {
    /// Planes of the recording.
    pub planes: u8,
    /// Samples of a stretch.
    pub stride: u64,
    buckets: Vec<Bucket>,
    current: Bucket,
    taken: u64,
}

impl Envelope {
    /// Before the first sample.
    pub fn new(planes: u8) -> Self {
        Self {
            planes,
            stride: 1,
            buckets: Vec::new(),
            current: EMPTY,
            taken: 0,
        }
    }

    /// Takes the next displacements, m.
    pub fn take(&mut self, positions: &[f64; CHANNELS]) {
        widen(&mut self.current, &positions.map(|it| [it; 2]));
        self.taken += 1;
        if self.taken < self.stride {
            return;
        }
        self.buckets
            .push(std::mem::replace(&mut self.current, EMPTY));
        self.taken = 0;
        if self.buckets.len() == MOST {
            for index in 0..MOST / 2 {
                let mut pair = self.buckets[2 * index];
                widen(&mut pair, &self.buckets[2 * index + 1]);
                self.buckets[index] = pair;
            }
            self.buckets.truncate(MOST / 2);
            self.stride *= 2;
        }
    }

    /// The stretches, the last one perhaps shorter.
    pub fn buckets(&self) -> impl Iterator<Item = &Bucket> {
        let last = (self.taken > 0).then_some(&self.current);
        self.buckets.iter().chain(last)
    }
}

/// `f64::min` and `max` take the number where one is NaN.
fn widen(bucket: &mut Bucket, other: &Bucket) {
    for (mine, theirs) in bucket.iter_mut().zip(other) {
        mine[0] = mine[0].min(theirs[0]);
        mine[1] = mine[1].max(theirs[1]);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_spike_stays_and_memory_does_not_grow() {
        let mut envelope = Envelope::new(1);
        for k in 0..1_000_000 {
            let x = if k == 123_456 { 5.0 } else { 0.0 };
            envelope.take(&[x, f64::NAN, 0.0, 0.0]);
        }
        let buckets: Vec<_> = envelope.buckets().collect();
        assert!((MOST / 2..=MOST).contains(&buckets.len()));
        let spikes: Vec<_> = (0..buckets.len())
            .filter(|k| buckets[*k][0][1] == 5.0)
            .collect();
        assert_eq!(spikes, [123_456 / envelope.stride as usize]);
        assert!(buckets.iter().all(|it| it[1][0].is_nan()));
    }
}
