//! What is counted over the monitor's life, apart from the episodes.

use super::ending::Ending;
use super::fields::{Fields, Row};
use crate::controller::Cause;
use touchdown_core::checksum::CRC;

/// Bytes of a record of the counters.
pub const COUNTERS_BYTES: usize = 64;

/// Faster than any rotor hits: a wrong index must not fill up the sum.
const GREATEST_INDEX: f32 = 1e4;

const MAGIC: [u8; 4] = *b"TDC\x01";

/// Lifetime counters. Each only grows, and stays at its greatest value.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, serde::Serialize, serde::Deserialize)]
pub struct Counters {
    /// Records written: the newest is the one that holds.
    pub generation: u32,
    /// Times switched on.
    pub boots: u32,
    /// Greatest sequence number of an episode that is counted in.
    pub episodes: u32,
    /// Landings on the retainer.
    pub landings: u32,
    /// Those of them whose index is unknown, as the episode was cut off.
    pub unweighed: u32,
    /// Drops of which nothing was recorded.
    pub lost: u32,
    /// Sum of the landings' velocity indices, in thousandths.
    pub weight: u64,
    /// Times that the rotor came to the wall, whatever held it. 0 in records from before there was such a count.
    pub touches: u32,
    /// Why the outputs went off in a drop that nobody has cleared. Outlives the power.
    pub uncleared: Option<Cause>,
}

impl Counters {
    /// Counts episode `sequence`, with its ending if it has one. Cut off, it is taken for a landing. A landing while a
    /// trip is `latched` is a drop.
    pub fn count(&mut self, sequence: u32, ending: Option<&Ending>, latched: Option<Cause>) {
        self.episodes = self.episodes.max(sequence);
        if ending.is_some_and(|it| !it.landing) {
            return;
        }
        self.uncleared = self.uncleared.or(latched);
        self.landings = self.landings.saturating_add(1);
        match ending {
            Some(ending) => {
                let index = ending.index.min(GREATEST_INDEX);
                self.weight = self.weight.saturating_add((index * 1e3) as u64);
            }
            None => self.unweighed = self.unweighed.saturating_add(1),
        }
    }

    /// As bytes.
    pub fn encode(&self) -> [u8; COUNTERS_BYTES] {
        let mut bytes: [u8; COUNTERS_BYTES] = Row::new()
            .put(&MAGIC)
            .put(&self.generation.to_le_bytes())
            .put(&self.boots.to_le_bytes())
            .put(&self.episodes.to_le_bytes())
            .put(&self.landings.to_le_bytes())
            .put(&self.unweighed.to_le_bytes())
            .put(&self.lost.to_le_bytes())
            .put(&self.weight.to_le_bytes())
            .put(&self.touches.to_le_bytes())
            .put(&[Cause::byte_of(self.uncleared)])
            .bytes();
        let checksum = CRC.checksum(&bytes[..COUNTERS_BYTES - 4]);
        bytes[COUNTERS_BYTES - 4..].copy_from_slice(&checksum.to_le_bytes());
        bytes
    }

    /// From bytes; `None` if they are no whole record.
    pub fn decode(bytes: &[u8; COUNTERS_BYTES]) -> Option<Self> {
        let (body, end) = bytes.split_at(COUNTERS_BYTES - 4);
        let mut fields = Fields(body);
        if end != CRC.checksum(body).to_le_bytes() || fields.bytes()? != MAGIC {
            return None;
        }
        Some(Self {
            generation: fields.u32()?,
            boots: fields.u32()?,
            episodes: fields.u32()?,
            landings: fields.u32()?,
            unweighed: fields.u32()?,
            lost: fields.u32()?,
            weight: fields.u64()?,
            touches: fields.u32()?,
            uncleared: Cause::of_byte(fields.u8()?),
        })
    }
}
