//! `[[magnet]]`: a magnetic bearing after the release.

use serde::Deserialize;

use super::diagnostic::Diagnostic;
use super::limits;
use super::rule::{Keys, MILLI, exactly};

/// Most magnets: two planes of them, as they are left and as they come back.
const MAGNETS: usize = 4;

/// What is left of a magnetic bearing.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Magnet {
    /// From the rotor's centre of mass, m.
    pub place: f64,
    /// Force per displacement, along it where positive: the negative stiffness of permanent flux, N/m.
    pub stiffness: f64,
    /// Force against the velocity, N s/m.
    pub damping: f64,
    /// N.
    pub force: [f64; 2],
    /// Greatest force on each axis, either way, N; without bound where none.
    pub limit: Option<f64>,
    /// From when and until when it is on, s after the release; always without.
    pub on: Option<[f64; 2]>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct MagnetTable {
    z_mm: f64,
    #[serde(default)]
    stiffness_n_m: f64,
    #[serde(default)]
    damping_n_s_m: f64,
    #[serde(default, deserialize_with = "exactly")]
    force_n: [f64; 2],
    limit_n: Option<f64>,
    from_s: Option<f64>,
    until_s: Option<f64>,
}

const KEYS: Keys = Keys("magnet");

impl MagnetTable {
    fn check(&self) -> Result<Magnet, Diagnostic> {
        let stiffness = self.stiffness_n_m;
        if stiffness != 0.0 {
            KEYS.between("stiffness_n_m", stiffness.abs(), limits::STIFFNESS_N_M)?;
        }
        Ok(Magnet {
            place: MILLI * self.z_mm,
            stiffness,
            force: self.force_n,
            limit: self.limit_n,
            on: self.on()?,
            damping: self.damping_n_s_m,
        })
    }

    /// From when and until when it is on, s, where either is given.
    fn on(&self) -> Result<Option<[f64; 2]>, Diagnostic> {
        let given = self.from_s.or(self.until_s).is_some();
        let [from, until] = [
            self.from_s.unwrap_or(0.0),
            self.until_s.unwrap_or(f64::INFINITY),
        ];
        if until <= from {
            return Err(KEYS.broken("until_s", "until_s must be after from_s"));
        }
        Ok(given.then_some([from, until]))
    }
}

pub(super) fn all_magnets(tables: &[MagnetTable]) -> Result<Vec<Magnet>, Diagnostic> {
    KEYS.rows("z_mm", tables, MAGNETS, |_, table| table.check())
}
