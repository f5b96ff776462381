//! Pulses of a ball bearing's rings: at which samples a channel's counter had gone on.

use core::ops::Range;

use super::block::{Block, Kind, PAYLOAD_BYTES};
use crate::layout::Offset;
use touchdown_core::sample::{Edges, TACHOMETERS};

/// Version of the blocks.
pub const VERSION: u8 = 1;
/// Pulses of a block.
pub const PULSES_PER_BLOCK: usize = (PAYLOAD_BYTES - HEAD_BYTES) / PULSE_BYTES;

/// Bytes before the pulses: version, which channels have a value, range of samples, values.
const HEAD_BYTES: usize = 2 + 2 * 2 + 2 * TACHOMETERS;
/// Bytes of a pulse.
pub const PULSE_BYTES: usize = 6;
/// Age of an edge of an earlier sample.
const OLD: u8 = u8::MAX;
/// In a pulse: the channel has a value.
const VALUE: u8 = 0x80;

/// What each channel's counter shows; `None` where there is no value.
pub type Shown = [Option<u16>; TACHOMETERS];

/// A channel's counter differs from what it showed at the sample before.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Pulse {
    /// Number of the sample among the recorded ones.
    pub sample: u16,
    /// Which of the pulse channels.
    pub channel: u8,
    /// What it shows from now on.
    pub edges: Option<Edges>,
}

impl Pulse {
    /// As bytes.
    pub fn encode(&self) -> [u8; PULSE_BYTES] {
        let there = if self.edges.is_some() { VALUE } else { 0 };
        let Edges { count, age } = self.edges.unwrap_or(Edges { count: 0, age: 0 });
        let ([s0, s1], [c0, c1]) = (self.sample.to_le_bytes(), count.to_le_bytes());
        [s0, s1, c0, c1, age, self.channel | there]
    }

    /// From bytes.
    pub fn decode([s0, s1, c0, c1, age, what]: &[u8; PULSE_BYTES]) -> Self {
        let edges = Edges {
            count: u16::from_le_bytes([*c0, *c1]),
            age: *age,
        };
        Self {
            sample: u16::from_le_bytes([*s0, *s1]),
            channel: what & !VALUE,
            edges: (what & VALUE != 0).then_some(edges),
        }
    }
}

/// The pulses of samples that follow one another. A block says by itself what the channels showed at each of them.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Pulses<'a> {
    /// Number of the first one among the recorded samples.
    pub from: u16,
    /// Behind the last one.
    pub to: u16,
    before: Shown,
    records: &'a [[u8; PULSE_BYTES]],
}

impl<'a> Pulses<'a> {
    /// A block of `samples` before which the channels showed `before`; of the pulses, [`PULSES_PER_BLOCK`] at most.
    pub fn block(
        samples: Range<u16>,
        before: &Shown,
        pulses: impl Iterator<Item = Pulse>,
    ) -> Block {
        let mut there = 0;
        for (channel, count) in before.iter().enumerate() {
            there |= u8::from(count.is_some()) << channel;
        }
        let mut block = Block::of(Kind::Pulses, &[VERSION, there]);
        let [first, second] = before.map(|count| count.unwrap_or(0));
        for word in [samples.start, samples.end, first, second] {
            block.push(&word.to_le_bytes());
        }
        for pulse in pulses {
            block.push(&pulse.encode());
        }
        block
    }

    /// From a block's bytes; `None` if they are of another version, or no whole number of pulses in their order.
    pub fn decode(bytes: &'a [u8]) -> Option<Self> {
        let (head, rest) = bytes.split_first_chunk::<HEAD_BYTES>()?;
        let [version, there]: [u8; 2] = Offset::get(0, head)?;
        let [from, to]: [u16; 2] = Offset::get(2, head)?;
        let counts: [u16; TACHOMETERS] = Offset::get(6, head)?;
        let (records, []) = rest.as_chunks() else {
            return None;
        };
        let pulses = || records.iter().map(Pulse::decode);
        let is_right = version == VERSION
            && there < 1 << TACHOMETERS
            && pulses().all(|it| usize::from(it.channel) < TACHOMETERS)
            && pulses().all(|it| (from..to).contains(&it.sample))
            && pulses().is_sorted_by_key(|it| it.sample);
        is_right.then_some(Self {
            from,
            to,
            before: core::array::from_fn(|channel| {
                let count = counts.get(channel).copied();
                count.filter(|_| there & (1 << channel) != 0)
            }),
            records,
        })
    }

    /// What the channels showed at each sample.
    pub fn samples(&self) -> impl Iterator<Item = [Option<Edges>; TACHOMETERS]> + use<'a> {
        let mut pulses = self.records.iter().map(Pulse::decode).peekable();
        let mut shown = self.before;
        (self.from..self.to).map(move |sample| {
            let mut now = shown.map(|count| count.map(|count| Edges { count, age: OLD }));
            while let Some(pulse) = pulses.next_if(|it| it.sample == sample) {
                if let Some(place) = now.get_mut(usize::from(pulse.channel)) {
                    *place = pulse.edges;
                }
            }
            shown = now.map(|edges| edges.map(|it| it.count));
            now
        })
    }
}
