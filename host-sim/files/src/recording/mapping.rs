//! Which column of a recording is what: the file of `--columns`.

use std::ops::Range;
use std::path::Path;

use serde::Deserialize;
use toml::Spanned;

use super::unit::{Displacement, Sensitivity, Speed, Time};
use crate::stream::is_rate;
use touchdown_base::input_error::{InputError, LARGEST_TOML};
use touchdown_scene::file::tables;

/// Names of the displacements in the mapping.
pub const POSITIONS: [&str; 4] = ["ax", "ay", "bx", "by"];

/// The file as it is written.
#[derive(Clone, Debug, Default, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Mapping {
    /// Directions of the displacements.
    #[serde(default)]
    pub axes: Axes,
    /// How the text is written; found in the file where it is not said.
    #[serde(default)]
    pub text: TextHints,
    /// When the rows were sampled.
    pub time: Option<Spanned<TimeColumn>>,
    /// Displacement of plane a.
    pub ax: Option<Spanned<PositionColumn>>,
    /// Displacement of plane a.
    pub ay: Option<Spanned<PositionColumn>>,
    /// Displacement of plane b.
    pub bx: Option<Spanned<PositionColumn>>,
    /// Displacement of plane b.
    pub by: Option<Spanned<PositionColumn>>,
    /// Of the rotor.
    pub speed: Option<SpeedColumn>,
    /// Whether the magnetic bearings are on.
    pub levitated: Option<LevitatedColumn>,
}

/// Directions of the displacements.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Axes {
    /// x right, y up.
    #[default]
    Scene,
    /// Those of the sensors, which the scene mounts at `mounting_deg`.
    Sensors,
}

/// How the text is written.
#[derive(Clone, Debug, Default, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct TextHints {
    pub delimiter: Option<Delimiter>,
    pub decimal: Option<Decimal>,
    /// What a line that is none of the table begins with.
    pub comment: Option<Comment>,
    /// Line of the column names, counted from 1.
    pub header_line: Option<u64>,
}

/// Between fields.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize, strum::Display)]
#[repr(u8)]
pub enum Delimiter {
    #[serde(rename = ",", alias = "comma")]
    #[strum(serialize = "commas")]
    Comma = b',',
    #[serde(rename = ";", alias = "semicolon")]
    #[strum(serialize = "semicolons")]
    Semicolon = b';',
    #[serde(rename = "\t", alias = "tab")]
    #[strum(serialize = "tabs")]
    Tab = b'\t',
}

/// Between whole and fraction.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize)]
pub enum Decimal {
    #[serde(rename = ".", alias = "point")]
    Point,
    #[serde(rename = ",", alias = "comma")]
    Comma,
}

/// What a comment begins with.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize)]
#[repr(u8)]
pub enum Comment {
    #[serde(rename = "#")]
    Hash = b'#',
    #[serde(rename = "%")]
    Percent = b'%',
}

/// A column by its name, with or without the unit in it, or by its number, counted from 1.
#[derive(Clone, Debug, PartialEq, Eq, Deserialize)]
#[serde(untagged, expecting = "a column is its name, or its number from 1")]
pub enum Column {
    /// Counted from 1.
    Number(usize),
    /// As in the header.
    Name(String),
}

/// When the rows were sampled: a column, or a rate.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct TimeColumn {
    /// Time of a row.
    pub column: Option<Column>,
    pub unit: Option<Time>,
    /// Samples per second, where there is no column.
    pub rate_hz: Option<f64>,
}

/// A displacement.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct PositionColumn {
    pub column: Column,
    pub unit: Option<Displacement>,
    /// For volts.
    pub sensitivity: Option<Sensitivity>,
    /// What it shows with the rotor in the bearing's centre, in its unit.
    #[serde(default)]
    pub offset: f64,
    /// Whether it counts the other way.
    #[serde(default)]
    pub reversed: bool,
}

/// The rotor's speed.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct SpeedColumn {
    pub column: Column,
    pub unit: Option<Speed>,
    /// Whether it counts clockwise.
    #[serde(default)]
    pub reversed: bool,
}

/// Whether the magnetic bearings are on.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct LevitatedColumn {
    pub column: Column,
    /// They are on where the value is above this.
    #[serde(default = "half")]
    pub above: f64,
    /// Or off there.
    #[serde(default)]
    pub reversed: bool,
}

fn half() -> f64 {
    0.5
}

impl Mapping {
    /// Reads the mapping at `path`.
    pub fn load(path: &Path) -> Result<Self, InputError> {
        let text = InputError::read(path, LARGEST_TOML)?;
        Self::parse(&path.display().to_string(), &text)
    }

    /// Reads the mapping `text`; errors name it `name`.
    pub fn parse(name: &str, text: &str) -> Result<Self, InputError> {
        let mapping: Self = tables(name, text)?;
        match mapping.check() {
            Ok(()) => Ok(mapping),
            Err((span, rule)) => Err(InputError::at_span(name, text, span, rule)),
        }
    }

    /// The displacements, in the order of the channels.
    pub fn positions(&self) -> [Option<&PositionColumn>; 4] {
        [&self.ax, &self.ay, &self.bx, &self.by].map(|it| it.as_ref().map(Spanned::get_ref))
    }

    fn check(&self) -> Result<(), (Range<usize>, &'static str)> {
        if self.ax.is_none() || self.ay.is_none() {
            let rule = "[ax] and [ay] say which columns are the displacements of plane a";
            return Err((0..0, rule));
        }
        if let (Some(one), None) | (None, Some(one)) = (&self.bx, &self.by) {
            return Err((one.span(), "plane b needs both [bx] and [by]"));
        }
        let columns = [&self.ax, &self.ay, &self.bx, &self.by];
        for column in columns.into_iter().flatten() {
            let it = column.get_ref();
            let rule = match (it.unit, it.sensitivity) {
                _ if !it.offset.is_finite() => "offset must be a finite number",
                (Some(Displacement::Volts(_)), None) => {
                    "volts need a sensitivity, as \"200 mV/mil\" or \"-7.87 V/mm\""
                }
                (Some(Displacement::Length(_)), Some(_)) => {
                    "a sensitivity is for volts, but the unit is a length"
                }
                _ => continue,
            };
            return Err((column.span(), rule));
        }
        if let Some(time) = &self.time {
            let it = time.get_ref();
            let rule = match (&it.column, it.rate_hz) {
                (Some(_), Some(_)) => "a column or a rate_hz, not both",
                (None, Some(rate)) if !is_rate(rate) => "rate_hz must be 100 to 200000",
                (None, Some(_)) if it.unit.is_some() => "a unit is for a column",
                _ => return Ok(()),
            };
            return Err((time.span(), rule));
        }
        Ok(())
    }
}
