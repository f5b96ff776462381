//! Rules that many keys share, and the units they are written in.

use std::ops::RangeInclusive;

use serde::de::{Deserialize, Deserializer, Error};
use touchdown_base::plain::Number;
use touchdown_rotor::error::ConfigError;

use super::diagnostic::Diagnostic;
use super::limits::Limit;

/// A turn a minute, rad/s.
pub const RPM: f64 = std::f64::consts::TAU / 60.0;
/// Of a unit.
pub const MILLI: f64 = 1e-3;
/// Of a unit.
pub const MICRO: f64 = 1e-6;
/// How far outside the gap rounding may put a start on the wall, relative to the clearance.
pub(super) const ON_THE_WALL: f64 = 1e-9;

/// The keys of a table, held against their rules.
#[derive(Clone, Copy)]
pub(crate) struct Keys(pub(crate) &'static str);

impl Keys {
    /// That one breaks a rule.
    pub(crate) fn broken(self, key: &'static str, rule: impl Into<String>) -> Diagnostic {
        Diagnostic::new(self.0, key, rule)
    }

    /// A number must be in a range.
    pub(crate) fn between(
        self,
        key: &'static str,
        value: f64,
        range: RangeInclusive<f64>,
    ) -> Result<f64, Diagnostic> {
        let rule = Limit::Between(range).broken(value);
        let broken = |rule| format!("{key} must be {rule}, is {}", Number(value));
        rule.map_or(Ok(value), |rule| Err(self.broken(key, broken(rule))))
    }

    /// The one of `all` that has this name.
    pub(crate) fn named<T: Copy>(
        self,
        key: &'static str,
        given: &str,
        all: &[T],
        name: impl Fn(T) -> &'static str,
    ) -> Result<T, Diagnostic> {
        let found = all.iter().copied().find(|&item| name(item) == given);
        found.ok_or_else(|| {
            let names = all.iter().map(|&item| format!("\"{}\"", name(item)));
            let names: Vec<_> = names.collect();
            let rule = format!("{key} must be {}, is \"{given}\"", names.join(" or "));
            self.broken(key, rule)
        })
    }

    /// Likewise, `other` where none is given.
    pub(crate) fn named_or<T: Copy + Into<&'static str>>(
        self,
        key: &'static str,
        given: &Option<String>,
        other: T,
        all: &[T],
    ) -> Result<T, Diagnostic> {
        match given {
            Some(given) => self.named(key, given, all, T::into),
            None => Ok(other),
        }
    }

    /// Checks the rows of a table that stands `most` times at most; `key` is one that every row has.
    pub(crate) fn rows<T, U>(
        self,
        key: &'static str,
        rows: &[T],
        most: usize,
        check: impl Fn(usize, &T) -> Result<U, Diagnostic>,
    ) -> Result<Vec<U>, Diagnostic> {
        let (table, count) = (self.0, rows.len());
        if count > most {
            let rule = format!("[[{table}]] must stand {most} times at most, stands {count} times");
            return Err(self.broken(key, rule).in_row(most));
        }
        let rows = rows.iter().enumerate();
        rows.map(|(row, table)| check(row, table).map_err(|flaw| flaw.in_row(row)))
            .collect()
    }
}

/// So many numbers. Of a longer list, an array alone would take the first and say nothing.
pub fn exactly<'de, D: Deserializer<'de>, const N: usize>(list: D) -> Result<[f64; N], D::Error> {
    let all = Vec::deserialize(list)?;
    let there = all.len();
    all.try_into()
        .map_err(|_| D::Error::custom(format!("the list must have {N} numbers, has {there}")))
}

/// Likewise, of a key that may be left out.
pub fn exactly_if_there<'de, D: Deserializer<'de>, const N: usize>(
    list: D,
) -> Result<Option<[f64; N]>, D::Error> {
    exactly(list).map(Some)
}

/// A rule in the words of the configuration, in those of the file.
pub fn translate(error: &ConfigError) -> Diagnostic {
    let parameter = error.parameter();
    let (table, key) = match parameter {
        "clearance" => ("retainer", "clearance_mm"),
        "friction" => ("retainer", "friction"),
        "restitution" => ("retainer", "restitution"),
        "gravity" => ("run", "gravity_m_s2"),
        "sample_rate" => ("run", "sample_rate_hz"),
        "rotor_radius" => ("rotor", "radius_mm"),
        "inertia_ratio" => ("rotor", "polar_inertia_kg_m2"),
        "spin" => ("rotor", "speed_rpm"),
        "length" => ("materials", "length_mm"),
        "fastest" => ("start", "vx_mm_s"),
        // How well an edge is placed is fixed; the marks decide whether that is well enough.
        "marks" | "edge_error" | "window" => ("ball_bearing", "inner_ring_marks"),
        "bore_radius" => ("rotor", "radius_mm"),
        "cage_ratio" => ("ball_bearing", "cage_ratio"),
        "planes" => ("sensors", "planes"),
        "bits" | "full_scale" | "zero_count" => ("sensors", "bits"),
        "range" | "resolution" => ("sensors", "range_um"),
        "noise" => ("sensors", "noise_um"),
        "bandwidth" => ("sensors", "bandwidth_hz"),
        "mounting_angle" => ("sensors", "mounting_deg"),
        "skew" => ("sensors", "skew_deg"),
        "offset" => ("sensors", "offset_um"),
        "gain_error" => ("sensors", "gain_error_percent"),
        "nonlinearity" => ("sensors", "nonlinearity_percent"),
        "runout" => ("sensors", "runout_um"),
        "runout_harmonic" => ("sensors", "runout_harmonic"),
        "alert" | "danger" => ("guard", parameter),
        tuning => ("detector", tuning),
    };
    let rule = error.to_string().replacen(parameter, key, 1);
    Diagnostic::new(table, key, rule)
}
