//! `[base]`: motion of what the machine stands on.

use serde::Deserialize;
use touchdown_models::BaseConfig;

use super::diagnostic::Diagnostic;
use super::limits;
use super::rule::{Keys, MILLI, exactly};

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

impl BaseTable {
    pub fn check(&self) -> Result<Base, Diagnostic> {
        const KEYS: Keys = Keys("base");
        let amplitude = KEYS.each("amplitude_mm", self.amplitude_mm, limits::BASE_MM)?;
        let frequency = KEYS.between("frequency_hz", self.frequency_hz, limits::BASE_HZ)?;
        let phase = KEYS.between("phase_deg", self.phase_deg, limits::ANGLE_DEG)?;
        Ok(Base {
            amplitude: amplitude.map(|it| MILLI * it),
            rate: std::f64::consts::TAU * frequency,
            phase: phase.to_radians(),
        })
    }
}
