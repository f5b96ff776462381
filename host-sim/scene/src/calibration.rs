//! The record of a commissioning check, as it is written.

use serde::{Deserialize, Serialize};
use touchdown_core::sensing::{Calibration, PlaneCalibration};

use super::diagnostic::Diagnostic;
use super::list;
use super::rule::{Keys, MICRO};

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
    #[serde(deserialize_with = "list::exactly")]
    pub zero_um: [f64; 2],
    /// Reading over displacement, by channel.
    #[serde(deserialize_with = "list::exactly")]
    pub gain: [f64; 2],
    /// Angle between the axes, less 90 degrees.
    pub skew_deg: f64,
}

impl CalibrationTable {
    /// For the monitor.
    pub fn check(&self) -> Result<Calibration, Diagnostic> {
        let plane = |name, table: &Option<PlaneTable>| match table {
            Some(table) => table.check(name),
            None => Ok(PlaneCalibration::default()),
        };
        Ok(Calibration {
            date: day(&self.date).ok_or_else(|| {
                let rule = format!("date must be a day as \"2026-12-31\", is \"{}\"", self.date);
                KEYS.broken("date", rule)
            })?,
            planes: [plane("a", &self.a)?, plane("b", &self.b)?],
        })
    }
}

impl PlaneTable {
    fn check(&self, plane: &'static str) -> Result<PlaneCalibration, Diagnostic> {
        let held = |name, value, range| {
            let value = KEYS.between(plane, value, range);
            value.map_err(|it| KEYS.broken(plane, format!("{name} of plane {}", it.rule)))
        };
        for gain in self.gain {
            held("gain", gain, 0.2..=5.0)?;
        }
        held("skew_deg", self.skew_deg, -28.0..=28.0)?;
        for zero in self.zero_um {
            held("zero_um", zero, -1e6..=1e6)?;
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
    let [year, month, day] = text.split('-').collect::<Vec<_>>().try_into().ok()?;
    let number = |text: &str, digits: usize| {
        let is_number = text.len() == digits && text.bytes().all(|it| it.is_ascii_digit());
        text.parse::<u32>().ok().filter(|_| is_number)
    };
    let (year, month, day) = (number(year, 4)?, number(month, 2)?, number(day, 2)?);
    let can_be = (1..=12).contains(&month) && (1..=31).contains(&day);
    can_be.then_some(10_000 * year + 100 * month + day)
}

/// The text of such a number.
pub fn text_of_day(day: u32) -> String {
    let (year, month, day) = (day / 10_000, day / 100 % 100, day % 100);
    format!("{year:04}-{month:02}-{day:02}")
}
