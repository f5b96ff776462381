//! The scene file as it is written: one struct a table, in the file's units.

use serde::de::DeserializeOwned;
use serde::{Deserialize, Serialize};
use touchdown_core::detect::Tuning;
use touchdown_core::guard::GuardConfig;

use super::base::BaseTable;
use super::calibration::CalibrationTable;
use super::diagnostic::{self, Limits};
use super::faults::FaultTable;
use super::magnet::MagnetTable;
use super::materials::MaterialsTable;
use super::mode::ModeTable;
use super::model::ModelTable;
use super::outputs::OutputsTable;
use super::rule::exactly;
use super::sensors::SensorsConfig;
use super::support::{BallBearingTable, SupportTable};
use super::two_plane::{RingTable, TwoPlaneTable};
use touchdown_base::input_error::InputError;

/// The tables of `text`; errors name it `name`.
pub fn tables<T: DeserializeOwned>(name: &str, text: &str) -> Result<T, InputError> {
    toml::from_str(text).map_err(|error| {
        let rule = error
            .message()
            .replacen("missing field", "missing required key", 1)
            .replacen("unknown field", "unknown key", 1);
        InputError::at_span(name, text, error.span().unwrap_or(0..0), rule)
    })
}

/// The same with numbers that are finite and within their limits.
pub fn read<T: DeserializeOwned>(name: &str, text: &str, limits: Limits) -> Result<T, InputError> {
    let file = tables(name, text)?;
    match diagnostic::first_broken(text, limits) {
        Some((rule, span)) => Err(InputError::at_span(name, text, span, rule)),
        None => Ok(file),
    }
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct SceneFile {
    pub title: Option<String>,
    pub source: Option<String>,
    pub fidelity: Option<String>,
    pub rotor: RotorTable,
    pub retainer: RetainerTable,
    pub stator: Option<StatorTable>,
    pub support: Option<SupportTable>,
    pub ball_bearing: Option<BallBearingTable>,
    pub two_plane: Option<TwoPlaneTable>,
    #[serde(default)]
    pub ring: Vec<RingTable>,
    #[serde(default)]
    pub magnet: Vec<MagnetTable>,
    pub base: Option<BaseTable>,
    #[serde(default)]
    pub mode: Vec<ModeTable>,
    #[serde(default)]
    pub start: StartTable,
    pub run: RunTable,
    #[serde(default)]
    pub model: ModelTable,
    pub outputs: Option<OutputsTable>,
    pub materials: Option<MaterialsTable>,
    #[serde(default)]
    pub sensors: SensorsConfig,
    pub calibration: Option<CalibrationTable>,
    #[serde(default)]
    pub fault: Vec<FaultTable>,
    #[serde(default)]
    pub detector: Tuning,
    #[serde(default)]
    pub guard: GuardTable,
}

/// Table `[guard]`; parts of the clearance.
#[derive(Deserialize)]
#[serde(default, deny_unknown_fields)]
pub(super) struct GuardTable {
    pub alert: f32,
    pub danger: f32,
    #[serde(deserialize_with = "exactly")]
    pub zones: [f64; 3],
}

impl Default for GuardTable {
    fn default() -> Self {
        let GuardConfig { alert, danger } = GuardConfig::default();
        Self {
            alert,
            danger,
            zones: [0.3, 0.4, 0.5],
        }
    }
}

/// Table `[rotor]`, as it is written.
#[derive(Deserialize, Serialize)]
#[serde(deny_unknown_fields)]
pub struct RotorTable {
    /// kg.
    pub mass_kg: f64,
    /// mm.
    pub radius_mm: f64,
    /// kg m^2; by default that of a solid cylinder.
    pub polar_inertia_kg_m2: Option<f64>,
    /// Counter-clockwise positive, 1/min.
    pub speed_rpm: f64,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct StatorTable {
    pub gap_mm: f64,
}

/// Table `[retainer]`, as it is written.
#[derive(Deserialize, Serialize)]
#[serde(deny_unknown_fields)]
pub struct RetainerTable {
    /// Radial, mm.
    pub clearance_mm: f64,
    /// Coulomb's coefficient.
    pub friction: f64,
    /// 0 to 1.
    pub restitution: f64,
}

#[derive(Default, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct StartTable {
    pub x_mm: Option<f64>,
    pub y_mm: Option<f64>,
    pub vx_mm_s: Option<f64>,
    pub vy_mm_s: Option<f64>,
    pub angle_deg: Option<f64>,
    pub tangential_mm_s: Option<f64>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct RunTable {
    pub duration_s: f64,
    pub gravity_m_s2: Option<f64>,
    #[serde(default)]
    pub inclination_deg: f64,
    pub sample_rate_hz: Option<f64>,
    pub seed: Option<u64>,
}
