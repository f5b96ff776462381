//! The record of a commissioning check, as it is written.

use serde::{Deserialize, Serialize};
use touchdown_core::sensing::{Calibration, PlaneCalibration};

use super::diagnostic::Diagnostic;
use super::rule::{Keys, MICRO, exactly};

const KEYS: Keys = Keys("calibration");

/// Table `[calibration]`.
#[derive(Clone, Debug, Deserialize, PartialEq, Serialize)]
#[serde(deny_unknown_fields)]
pub struct CalibrationTable {
    /// Day of the check, as 2026-12-31.
    pub date: String,
    /// For people; a controller does not keep it.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub machine: Option<String>,
    /// Plane a; without it as it is told.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub a: Option<PlaneTable>,
    /// Plane b.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub b: Option<PlaneTable>,
}

/// A plane's table.
#[derive(Clone, Debug, Deserialize, PartialEq, Serialize)]
#[serde(deny_unknown_fields)]
pub struct PlaneTable {
    /// What each channel reads at the retainer's centre, um.
    #[serde(deserialize_with = "exactly")]
    pub zero_um: [f64; 2],
    /// Reading over displacement, by channel.
    #[serde(deserialize_with = "exactly")]
    pub gain: [f64; 2],
    /// Angle between the axes, less 90 degrees.
    pub skew_deg: f64,
}

impl CalibrationTable {
    /// For the monitor.
    pub fn check(&self) -> Result<Calibration, Diagnostic> {
        let date = day(&self.date).ok_or_else(|| {
            let rule = format!("date must be a day as \"2026-12-31\", is \"{}\"", self.date);
            KEYS.broken("date", rule)
        })?;
        let plane = |name, table: &Option<PlaneTable>| {
            let checked = table.as_ref().map(|it| it.check(name));
            checked.unwrap_or(Ok(PlaneCalibration::default()))
        };
        let planes = [plane("a", &self.a)?, plane("b", &self.b)?];
        Ok(Calibration { date, planes })
    }
}

impl PlaneTable {
    fn check(&self, plane: &'static str) -> Result<PlaneCalibration, Diagnostic> {
        for (name, values, range) in [
            ("gain", &self.gain[..], 0.2..=5.0),
            ("skew_deg", &[self.skew_deg], -28.0..=28.0),
            ("zero_um", &self.zero_um, -1e6..=1e6),
        ] {
            for value in values {
                let held = KEYS.between(plane, *value, range.clone());
                held.map_err(|it| KEYS.broken(plane, format!("{name} of plane {}", it.rule)))?;
            }
        }
        Ok(PlaneCalibration {
            zero: self.zero_um.map(|zero| (MICRO * zero) as f32),
            gain: self.gain.map(|gain| gain as f32),
            skew: (self.skew_deg * DEGREE) as f32,
        })
    }
}

/// rad.
pub const DEGREE: f64 = std::f64::consts::PI / 180.0;

/// The number 20261231 of the text 2026-12-31, if it can be a day.
pub fn day(text: &str) -> Option<u32> {
    let day = text.replace('-', "").parse().ok()?;
    let can_be = (1..=12).contains(&(day / 100 % 100)) && (1..=31).contains(&(day % 100));
    (can_be && text.len() == 10 && text_of_day(day) == text).then_some(day)
}

/// The text of such a number.
pub fn text_of_day(day: u32) -> String {
    let (year, month, day) = (day / 10_000, day / 100 % 100, day % 100);
    format!("{year:04}-{month:02}-{day:02}")
}
