//! Raw counts: 16 bits each, for 12-bit and 16-bit converters alike.

use super::block::{Block, Kind, PAYLOAD_BYTES};
use crate::layout::Offset;
use touchdown_core::sample::{CHANNELS, Sample};

/// The counts of one sample.
pub type Counts = [u16; CHANNELS];

/// Recorded for a channel that delivered no value. At a 16-bit converter it is also full scale,
/// where a value is unusable too.
pub const NO_VALUE: u16 = u16::MAX;

/// Samples of a block.
pub const SAMPLES_PER_BLOCK: usize = (PAYLOAD_BYTES - 4) / COUNTS_BYTES;

/// Bytes of a sample.
pub const COUNTS_BYTES: usize = 2 * CHANNELS;

/// What is recorded of `sample`.
pub fn counts(sample: &Sample) -> Counts {
    core::array::from_fn(|channel| match sample.counts.get(channel) {
        Some(&count) if sample.is_valid(channel) => count,
        _ => NO_VALUE,
    })
}

/// Samples of an episode that follow one another.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Waveform<'a> {
    /// Number of the first one among the recorded samples, from 0.
    pub start: u32,
    bytes: &'a [u8],
}

impl<'a> Waveform<'a> {
    /// A block of at most [`SAMPLES_PER_BLOCK`] samples, and how many it took.
    pub fn block(start: u32, samples: impl Iterator<Item = Counts>) -> (Block, usize) {
        let mut block = Block::of(Kind::Waveform, &start.to_le_bytes());
        let mut taken = 0;
        for counts in samples.take(SAMPLES_PER_BLOCK) {
            for count in counts {
                block.push(&count.to_le_bytes());
            }
            taken += 1;
        }
        (block, taken)
    }

    /// From a block's bytes; `None` if they are no whole number of samples.
    pub fn decode(bytes: &'a [u8]) -> Option<Self> {
        let (start, bytes) = bytes.split_first_chunk()?;
        bytes.len().is_multiple_of(COUNTS_BYTES).then_some(Self {
            start: u32::from_le_bytes(*start),
            bytes,
        })
    }

    /// The samples.
    pub fn samples(&self) -> impl ExactSizeIterator<Item = Counts> + use<'a> {
        counts_of(self.bytes)
    }
}

/// The samples in `bytes`, [`COUNTS_BYTES`] each; what is left over at the end is none.
pub fn counts_of(bytes: &[u8]) -> impl ExactSizeIterator<Item = Counts> + use<'_> {
    let samples = bytes.chunks_exact(COUNTS_BYTES);
    samples.map(|it| Offset::get(0, it).unwrap_or_default())
}
