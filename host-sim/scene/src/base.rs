//! `[base]`: motion of what the machine stands on.

use serde::Deserialize;
use touchdown_models::BaseConfig;

use super::rule::{MILLI, exactly};

/// A base that goes to and fro: by its amplitude times the cosine of an angle.
pub type Base = BaseConfig;

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct BaseTable {
    #[serde(deserialize_with = "exactly")]
    amplitude_mm: [f64; 2],
    frequency_hz: f64,
    #[serde(default)]
    phase_deg: f64,
}

impl From<&BaseTable> for Base {
    fn from(table: &BaseTable) -> Self {
        Self {
            amplitude: table.amplitude_mm.map(|it| MILLI * it),
            rate: std::f64::consts::TAU * table.frequency_hz,
            phase: table.phase_deg.to_radians(),
        }
    }
}
