//! The last block of an episode: it is complete.

use crate::controller::Cause;
use crate::layout::{Offset, codes, layout};

/// Bytes of an ending.
pub const ENDING_BYTES: usize = 29;

/// Why an episode ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq, strum::FromRepr)]
#[repr(u8)]
#[derive(serde::Serialize, serde::Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Closing {
    /// The rotor floats again.
    Levitated = 0,
    /// The fall was withdrawn before anything was touched.
    Withdrawn = 1,
    /// Nothing was reported for as long as an episode waits.
    Quiet = 2,
    /// As long as an episode may be; the drop goes on.
    Longest = 3,
}

/// What an episode added up to.
#[derive(Clone, Copy, Debug, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct Ending {
    /// Why it ended.
    pub closing: Closing,
    /// Whether it counts as a landing: the retainer was touched by what had floated, and no earlier episode tells of
    /// the same drop.
    pub landing: bool,
    /// Blocks of the episode, this one and the copies of header and ending included.
    pub blocks: u16,
    /// Samples recorded.
    pub samples: u32,
    /// Notices recorded.
    pub notices: u32,
    /// Notices for which there was no room.
    pub notices_lost: u32,
    /// Velocity index: speed of the fastest impact, as a multiple of the speed of a fall through
    /// the clearance under standard gravity; 0 if none was measured.
    pub index: f32,
    /// Tick at which it ended.
    pub last: u64,
    /// What waited for an order to clear then. None in episodes from before it was recorded.
    pub latched: Option<Cause>,
}

codes!(Closing);

layout!(Ending {
    closing = 0, landing = 1, blocks = 2, samples = 4, notices = 8, notices_lost = 12, index = 16, last = 20,
    latched = 28,
});

impl Ending {
    /// As bytes.
    pub fn encode(&self) -> [u8; ENDING_BYTES] {
        let mut bytes = [0; ENDING_BYTES];
        Offset::put(0, self, &mut bytes);
        bytes
    }

    /// From bytes; `None` if they are too few or the reason is unknown.
    pub fn decode(bytes: &[u8]) -> Option<Self> {
        Offset::get(0, bytes)
    }
}
