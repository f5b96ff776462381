//! What is counted over the monitor's life, apart from the episodes.

use super::ending::Ending;
use crate::controller::Cause;
use crate::layout::{Offset, layout};
use touchdown_core::checksum::CRC;

/// Bytes of a record of the counters.
pub const COUNTERS_BYTES: usize = 64;
/// Before the checksum.
const BODY_BYTES: usize = COUNTERS_BYTES - 4;

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

layout!(Counters {
    generation = 4, boots = 8, episodes = 12, landings = 16, unweighed = 20, lost = 24, weight = 28, touches = 36,
    uncleared = 40,
});

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
        let mut bytes = [0; COUNTERS_BYTES];
        Offset::put(0, &MAGIC, &mut bytes);
        Offset::put(0, self, &mut bytes);
        let checksum = CRC.checksum(&bytes[..BODY_BYTES]);
        Offset::put(BODY_BYTES, &checksum, &mut bytes);
        bytes
    }

    /// From bytes; `None` if they are no whole record.
    pub fn decode(bytes: &[u8; COUNTERS_BYTES]) -> Option<Self> {
        let (body, end) = bytes.split_at(BODY_BYTES);
        if end != CRC.checksum(body).to_le_bytes() || !body.starts_with(&MAGIC) {
            return None;
        }
        Offset::get(0, body)
    }
}
