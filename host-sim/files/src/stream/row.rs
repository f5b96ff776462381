//! One row of a stream.

use super::clock::Stamp;
use touchdown_core::sample::{CHANNELS, Edges, TACHOMETERS};

/// Sample rates that the detector takes, Hz.
pub const RATES: std::ops::RangeInclusive<f64> = 100.0..=200_000.0;

/// What a pulse channel's timer showed.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Pulses {
    /// Edges so far; may wrap at 65536.
    pub count: u64,
    /// Time since the last one, s.
    pub age: f64,
}

impl Pulses {
    /// Of what a sample says at `rate` (Hz).
    pub fn of(Edges { count, age }: Edges, rate: f64) -> Self {
        Self {
            count: count.into(),
            age: f64::from(age) / (256.0 * rate),
        }
    }
}

/// One row; SI.
#[derive(Clone, Copy, Debug)]
pub struct Row {
    /// s.
    pub time: f64,
    /// Displacement by channel, in the scene's axes, m; NaN where there is none.
    pub positions: [f64; CHANNELS],
    /// rad/s; `None` without the column or where it is NaN.
    pub spin: Option<f64>,
    /// `None` without the column or where it is empty or NaN.
    pub levitated: Option<bool>,
    /// Of inner ring and cage; `None` without the columns or where one of them is NaN.
    pub edges: [Option<Pulses>; TACHOMETERS],
}

/// A row with the time that its file gives it.
#[derive(Clone, Copy, Debug)]
pub struct Stamped {
    /// As printed.
    pub stamp: Stamp,
    /// All else.
    pub row: Row,
    /// In the file, counted from 1; of a binary file the record.
    pub line: u64,
}
