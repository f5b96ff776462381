//! What was recorded: accelerations alone, or together with the force of known hits.

use super::quiet::Quiet;
use touchdown_base::input_error::InputError;

/// An axis of the device; x right, y up.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Axis {
    /// Right.
    X,
    /// Up.
    Y,
}

/// The columns of acceleration in files, by axis.
pub const COLUMNS: [&str; 2] = ["ax_m_s2", "ay_m_s2"];

/// A recording to find forces in.
#[derive(Clone, Debug)]
pub struct Recording {
    /// Name of the file.
    pub file: String,
    /// Samples per second, Hz.
    pub rate: f64,
    /// Time of the first sample, s.
    pub start: f64,
    /// Of x, or of x and y, m/s^2.
    pub acceleration: Vec<Vec<f64>>,
}

/// Known hits along an axis.
#[derive(Clone, Debug)]
pub struct Hits {
    /// Name of the file.
    pub file: String,
    /// Of the hammer and the accelerometer.
    pub axis: Axis,
    /// Samples per second, Hz.
    pub rate: f64,
    /// One or more.
    pub hits: Vec<Hit>,
}

/// A hit and what it did.
#[derive(Clone, Debug)]
pub struct Hit {
    /// Its first line in the file.
    pub line: u64,
    /// N.
    pub force: Vec<f64>,
    /// m/s^2, as long.
    pub acceleration: Vec<f64>,
}

/// Where all axes are still quiet at the beginning: the shortest of their quiet parts.
pub fn quiet(recording: &Recording) -> Result<Vec<Quiet>, InputError> {
    let of = |signal: &Vec<f64>| Quiet::find(signal, recording.rate);
    let found: Result<Vec<Quiet>, String> = recording.acceleration.iter().map(of).collect();
    let found = found.map_err(|rule| InputError::at_line(&recording.file, 2, rule))?;
    let common = found.iter().map(|it| it.samples).min().unwrap_or(0);
    let parts = recording.acceleration.iter();
    Ok(parts.map(|it| Quiet::of(it, common)).collect())
}
