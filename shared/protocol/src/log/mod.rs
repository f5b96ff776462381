//! The bytes of the drop log, as firmware writes and desktop reads them: `docs/formats/log.md`.
//!
//! An episode is a sequence of [`block::Block`]s of one flash page each: header, waveform, pulses, events,
//! severity, ending. Each block carries its episode, its place and a checksum, so any part of an
//! episode is known for what it is. The ending comes last: without it the episode is incomplete.

pub mod block;
pub mod counters;
pub mod ending;
pub mod header;
pub mod learnt;
pub mod marks;
pub mod pulses;
pub mod reader;
pub mod severity;
pub mod waveform;

/// Version of the format, in the header of an episode whose planes have an angle or a commissioning check. All earlier
/// ones are read as well.
pub const FORMAT: u16 = 4;
/// Version in the header of an episode with pulses, from which on they are there.
pub const FORMAT_WITH_PULSES: u16 = 3;
/// Version in the header of an episode without pulses. Version 1 has no [`block::Kind::Learnt`].
pub const FORMAT_WITHOUT_PULSES: u16 = 2;
