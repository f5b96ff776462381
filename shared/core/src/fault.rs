//! What can be wrong with a sensor, and what that leaves of its channel.

use crate::sample::CHANNELS;

/// What is wrong with a channel.
#[derive(Clone, Copy, Debug, PartialEq, Eq, strum::FromRepr, strum::Display)]
#[repr(u8)]
#[derive(serde::Serialize, serde::Deserialize)]
#[serde(rename_all = "snake_case")]
#[strum(serialize_all = "snake_case")]
pub enum FaultKind {
    /// A few samples without a value.
    Dropped = 0,
    /// No value any more.
    Missing = 1,
    /// At count 0, where no motion brought it.
    Short = 2,
    /// At full scale, where no motion brought it.
    Open = 3,
    /// Ran into an end of its range.
    Saturated = 4,
    /// The same count for longer than noise allows.
    Stuck = 5,
    /// A few samples far off, then back.
    Spike = 6,
    /// Jumped to another place and floats there.
    Shift = 7,
    /// Wandered off while the other plane stayed.
    Drift = 8,
    /// The rotor lies where the retainer is not.
    Gain = 9,
    /// The rotor lies at the top.
    Reversed = 10,
    /// The rotor lies at a side.
    Swapped = 11,
    /// An axis of the plane is reversed, or both are swapped: the rotor orbits against its spin.
    Mirrored = 12,
    /// The planes show orbits against each other; which is wrong cannot be told.
    Disagree = 13,
    /// The wall, or the zero of the plane, is not where the commissioning check found it.
    Moved = 14,
}

/// The channel of the speed, behind those of the positions.
pub const SPEED: u8 = CHANNELS as u8;

/// A fault and where it is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Fault {
    /// Channel, in the order of [`CHANNELS`]; the first of a plane stands for a plane. Or [`SPEED`].
    pub channel: u8,
    /// What.
    pub kind: FaultKind,
}

/// What can be had of a channel.
#[derive(
    Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord, strum::FromRepr, strum::Display,
)]
#[repr(u8)]
#[derive(serde::Serialize, serde::Deserialize)]
#[serde(rename_all = "snake_case")]
#[strum(serialize_all = "snake_case")]
pub enum Condition {
    /// Nothing is known against it.
    #[default]
    Ok = 0,
    /// Used, since nothing else is there or the fault is a small one: verdicts may be wrong.
    Suspect = 1,
    /// Not used.
    Lost = 2,
}

/// A fault that a tick found.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Found {
    /// What.
    pub kind: FaultKind,
    /// Samples since it began.
    pub age: u32,
}
