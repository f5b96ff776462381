//! One sample of all sensors, as the converter delivers it.

/// Position channels: plane a x, plane a y, plane b x, plane b y.
pub const CHANNELS: usize = 4;
/// Optical pulse channels of a ball bearing: inner ring, cage.
pub const TACHOMETERS: usize = 2;

/// What a pulse channel's counter and capture timer show at a sample.
#[derive(Clone, Copy, Debug, PartialEq, Eq, serde::Serialize, serde::Deserialize)]
pub struct Edges {
    /// Edges so far, modulo 2^16, whichever way it turns.
    pub count: u16,
    /// Time since the last one in 1/256 of a sample period, rounded down; 255 where it is longer.
    pub age: u8,
}

/// What one tick gets.
#[derive(Clone, Copy, Debug, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct Sample {
    /// Converter codes, in the order of [`CHANNELS`]; meaningless where `valid` has no bit.
    pub counts: [u16; CHANNELS],
    /// Bit i is set if channel i delivered a value. A channel that is not fitted is never valid.
    pub valid: u8,
    /// Spin, rad/s, counter-clockwise positive, where it is measured.
    pub spin: Option<f32>,
    /// Whether the magnetic bearings are commanded on, where that is wired.
    pub levitated: Option<bool>,
    /// Pulses, in the order of [`TACHOMETERS`], where such a sensor is fitted.
    pub edges: [Option<Edges>; TACHOMETERS],
}

impl Sample {
    /// The one before it, that was never taken: no values, the same signals.
    #[must_use]
    pub const fn missed(&self) -> Self {
        Self {
            counts: [0; CHANNELS],
            valid: 0,
            spin: None,
            levitated: self.levitated,
            edges: [None; TACHOMETERS],
        }
    }

    /// Whether channel `channel` delivered a value.
    pub const fn is_valid(&self, channel: usize) -> bool {
        channel < CHANNELS && self.valid & (1 << channel) != 0
    }
}

/// Counts the samples in a row of which something holds.
#[inline]
pub const fn count_in_a_row(count: &mut u32, holds: bool) {
    *count = if holds { count.saturating_add(1) } else { 0 };
}
