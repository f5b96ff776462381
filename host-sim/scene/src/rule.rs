//! Rules that many keys share, and the units they are written in.

use touchdown_base::plain::Number;
use touchdown_rotor::error::ConfigError;

use super::diagnostic::Diagnostic;

/// A turn a minute, rad/s.
pub const RPM: f64 = std::f64::consts::TAU / 60.0;
/// Of a unit.
pub const MILLI: f64 = 1e-3;
/// Of a unit.
pub const MICRO: f64 = 1e-6;
/// How far outside the gap rounding may put a start on the wall, relative to the clearance.
pub(super) const ON_THE_WALL: f64 = 1e-9;

pub(super) fn above_zero(
    table: &'static str,
    key: &'static str,
    value: f64,
) -> Result<f64, Diagnostic> {
    holds(table, key, value, value > 0.0, "above 0")
}

pub(crate) fn zero_or_more(
    table: &'static str,
    key: &'static str,
    value: f64,
) -> Result<f64, Diagnostic> {
    holds(table, key, value, value >= 0.0, "0 or more")
}

fn holds(
    table: &'static str,
    key: &'static str,
    value: f64,
    is_right: bool,
    rule: &str,
) -> Result<f64, Diagnostic> {
    let broken = || format!("{key} must be {rule}, is {}", Number(value));
    let value = is_right.then_some(value);
    value.ok_or_else(|| Diagnostic::new(table, key, broken()))
}

pub(crate) fn between(
    table: &'static str,
    key: &'static str,
    value: f64,
    range: std::ops::RangeInclusive<f64>,
) -> Result<f64, Diagnostic> {
    let [low, high] = [*range.start(), *range.end()].map(Number);
    let rule = format!("{low} to {high}");
    holds(table, key, value, range.contains(&value), &rule)
}

/// The one of `all` that has this name.
pub(super) fn named<T: Copy>(
    table: &'static str,
    key: &'static str,
    given: &str,
    all: &[T],
    name: impl Fn(T) -> &'static str,
) -> Result<T, Diagnostic> {
    all.iter()
        .copied()
        .find(|&item| name(item) == given)
        .ok_or_else(|| {
            let names: Vec<_> = all
                .iter()
                .map(|&item| format!("\"{}\"", name(item)))
                .collect();
            let rule = format!("{key} must be {}, is \"{given}\"", names.join(" or "));
            Diagnostic::new(table, key, rule)
        })
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
