//! What is said over the link. The order of variants and fields is the format: docs/formats/link.md.

use heapless::{String, Vec};
use serde::{Deserialize, Serialize};

use super::right::{Mac, Nonce};
use crate::config_block::{Block, BlockError};
use crate::controller::{Busy, Cause, Faults, Mode, Outputs};
use crate::log::counters::Counters as Lifetime;
use crate::log::waveform::{self, COUNTS_BYTES, Counts};
use crate::wire::NOTICE_BYTES;
use touchdown_core::event::Act;
use touchdown_core::phase::Phase;

/// Most bytes of a log chunk.
pub const CHUNK_BYTES: usize = 256;
/// Most bytes of a text.
pub const TEXT_BYTES: usize = 32;

/// Bytes of the log.
pub type Chunk = Vec<u8, CHUNK_BYTES>;
/// A name.
pub type Text = String<TEXT_BYTES>;

/// To the controller.
#[expect(
    clippy::large_enum_variant,
    reason = "no allocation: a block has room in place"
)]
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub enum Request {
    /// Who is there? Answer: `Hello`.
    Hello,
    /// Answer: `State`.
    State,
    /// Answer: `Config`.
    ReadConfig,
    /// Checks a configuration block and holds it ready for [`Act::Commit`]. Answer: `Config`, the block as it was
    /// taken, or `Refused`.
    Stage(Block),
    /// Asks for a nonce. Answer: `Challenge`.
    Challenge,
    /// Answer: `Episodes`.
    Episodes,
    /// Bytes of an episode from `offset` on. Answer: `Chunk` or `Refused`.
    Fetch {
        /// The episode's number.
        episode: u32,
        /// First byte.
        offset: u32,
    },
    /// An order. Answer: `Done` or `Refused`.
    Order {
        /// The right to it: [`super::right::mac`].
        mac: Mac,
        /// What is ordered.
        act: Act,
    },
    /// Where the rotor has been just now. Answer: `Recent`.
    Recent {
        /// Every so many recorded samples one is wanted; 0 is taken for 1.
        step: u16,
    },
    /// What was counted over the monitor's life. Answer: `Lifetime`.
    Lifetime,
}

/// From the controller. An answer carries its request's sequence number; `Notice` and the `State` that
/// comes by itself count up their own.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub enum Reply {
    /// Who is there.
    Hello(Hello),
    /// What goes on.
    State(State),
    /// A notice, in the bytes of `wire::encode_record`.
    Notice([u8; NOTICE_BYTES]),
    /// The block in force or staged, without its key.
    Config(Block),
    /// What was asked is done.
    Done,
    /// It is not, and why.
    Refused(Refusal),
    /// Episodes in the log: the first and the last, none where there is none.
    Episodes(Option<(u32, u32)>),
    /// Bytes of an episode.
    Chunk {
        /// Bytes of the whole episode.
        total: u32,
        /// Those from the requested offset on; none at its end.
        bytes: Chunk,
    },
    /// The newest samples.
    Recent(Recent),
    /// What was counted over the monitor's life; none where there is no log.
    Lifetime(Option<Lifetime>),
    /// The nonce of the next order, and whether the controller has a key.
    Challenge(Nonce, bool),
}

/// The newest of the recorded samples, at equal distances.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Recent {
    /// Number of the newest, from 0.
    pub sample: u64,
    /// From each to the next, samples.
    pub step: u32,
    counts: Chunk,
}

impl Recent {
    /// Most samples.
    pub const SAMPLES: usize = CHUNK_BYTES / COUNTS_BYTES;

    /// The newest one's number, the step, and the counts, oldest first; of more than
    /// [`Self::SAMPLES`] the last ones are left out.
    pub fn new(sample: u64, step: u32, samples: impl Iterator<Item = Counts>) -> Self {
        let mut counts = Chunk::new();
        for count in samples.take(Self::SAMPLES).flatten() {
            // There is room for SAMPLES.
            let _ = counts.extend_from_slice(&count.to_le_bytes());
        }
        Self {
            sample,
            step,
            counts,
        }
    }

    /// Counts of each, oldest first.
    pub fn counts(&self) -> impl Iterator<Item = Counts> {
        waveform::counts_of(&self.counts)
    }
}

/// Who is there.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Hello {
    /// Version of the firmware.
    pub firmware: Text,
    /// Samples per second, Hz.
    pub sample_rate: f32,
}

/// What goes on.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct State {
    /// Number of the last sample, from 0; `u64::MAX` before the first.
    pub sample: u64,
    /// Time from that sample's tick to this frame, us.
    pub age_us: u32,
    /// The rotor's phase.
    pub phase: Phase,
    /// The controller's mode.
    pub mode: Mode,
    /// Why; none while it watches.
    pub cause: Option<Cause>,
    /// Touches since power-on.
    pub touches: u32,
    /// The outputs.
    pub outputs: Outputs,
    /// The latched faults.
    pub faults: Faults,
    /// What was counted since power-on.
    pub counters: Counters,
}

/// What was counted since power-on.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct Counters {
    /// Samples lost.
    pub lost_samples: u32,
    /// Channel values that were unusable.
    pub unusable_values: u64,
    /// Notices that found no room on their way out.
    pub lost_notices: u32,
    /// Frames that came damaged.
    pub damaged_frames: u32,
}

/// Why the controller does not do what it was asked.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub enum Refusal {
    /// A drop runs, or no sensor sees.
    Busy(Busy),
    /// No block of this version: blank, other version, length, checksum or body.
    Block,
    /// This parameter breaks its rule.
    Parameter(Text),
    /// This board has nowhere to keep it.
    NoStore,
    /// Storing or erasing failed.
    StoreFailed,
    /// There is no such episode, or it is being written.
    NoEpisode,
    /// Too few slots would be left for new episodes.
    NoRoom,
}

impl Refusal {
    /// This parameter breaks its rule.
    pub fn parameter(name: &str) -> Self {
        Self::Parameter(shortened(name))
    }

    /// Code of the reason in a notice, from 1: as over the link, in one byte.
    pub fn code(&self) -> u8 {
        let mut bytes = [0; 2 + TEXT_BYTES];
        let _ = postcard::to_slice(self, &mut bytes);
        match bytes {
            [0, busy, ..] => 1 + busy,
            [other, ..] => 16 + other,
        }
    }

    /// The reason of a code, without a parameter's name.
    pub fn of_code(code: u8) -> Option<Self> {
        let busy = code.checked_sub(1)?;
        postcard::from_bytes(&if busy < 16 { [0, busy] } else { [code - 16, 0] }).ok()
    }
}

impl From<Busy> for Refusal {
    fn from(busy: Busy) -> Self {
        Self::Busy(busy)
    }
}

impl From<BlockError> for Refusal {
    fn from(error: BlockError) -> Self {
        match error {
            BlockError::Refused(rule) => Self::parameter(rule.parameter()),
            _ => Self::Block,
        }
    }
}

/// As much of an ASCII text as has room.
pub(super) fn shortened(text: &str) -> Text {
    let mut short = Text::new();
    let _ = text.chars().try_for_each(|letter| short.push(letter));
    short
}
