//! `[[magnet]]`: a magnetic bearing after the release.

use serde::Deserialize;

use super::diagnostic::Diagnostic;
use super::rule::{MILLI, between};
use super::{limits, list};

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
    #[serde(default, deserialize_with = "list::exactly")]
    force_n: [f64; 2],
    from_s: Option<f64>,
    until_s: Option<f64>,
}

impl MagnetTable {
    /// From when and until when it is on, s, where either is given.
    fn on(&self) -> Result<Option<[f64; 2]>, Diagnostic> {
        const TABLE: &str = "magnet";
        if self.from_s.is_none() && self.until_s.is_none() {
            return Ok(None);
        }
        let from = self.from_s.unwrap_or(0.0);
        let from = between(TABLE, "from_s", from, limits::MOMENT_S)?;
        let Some(until) = self.until_s else {
            return Ok(Some([from, f64::INFINITY]));
        };
        between(TABLE, "until_s", until, limits::MOMENT_S)?;
        if until <= from {
            return Err(Diagnostic::new(
                TABLE,
                "until_s",
                "until_s must be after from_s",
            ));
        }
        Ok(Some([from, until]))
    }
}

pub(super) fn all_magnets(tables: &[MagnetTable]) -> Result<Vec<Magnet>, Diagnostic> {
    const TABLE: &str = "magnet";
    if tables.len() > MAGNETS {
        let rule = format!(
            "[[magnet]] must stand {MAGNETS} times at most, stands {} times",
            tables.len()
        );
        return Err(Diagnostic::new(TABLE, "z_mm", rule));
    }
    let magnets = tables.iter().enumerate();
    magnets
        .map(|(index, table)| {
            let check = || {
                let stiffness = table.stiffness_n_m;
                if stiffness != 0.0 {
                    between(
                        TABLE,
                        "stiffness_n_m",
                        stiffness.abs(),
                        limits::STIFFNESS_N_M,
                    )?;
                }
                for force in table.force_n {
                    between(TABLE, "force_n", force, limits::FORCE_N)?;
                }
                Ok(Magnet {
                    place: MILLI * between(TABLE, "z_mm", table.z_mm, limits::PLACE_MM)?,
                    stiffness,
                    force: table.force_n,
                    on: table.on()?,
                    damping: between(
                        TABLE,
                        "damping_n_s_m",
                        table.damping_n_s_m,
                        limits::DAMPING_N_S_M,
                    )?,
                })
            };
            check().map_err(|flaw: Diagnostic| flaw.in_row(index))
        })
        .collect()
}
