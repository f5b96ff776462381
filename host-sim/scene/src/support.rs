//! `[support]` and `[ball_bearing]`: a retainer ring that gives way and one that turns.

use serde::Deserialize;
use touchdown_models::{MountConfig, RaceConfig, StopConfig};

use super::diagnostic::Diagnostic;
use super::limits;
use super::rule::{Keys, MILLI};
use crate::sensors::Tachometers;

/// Of an optical mark, rad: 0.1 mm on a circle of 50 mm diameter.
const EDGE_ERROR: f64 = 0.004;
/// Time back that the speed of a ring is measured over, s.
const SPEED_WINDOW: f64 = 0.005;

/// What the retainer ring stands on.
pub type Support = MountConfig;
/// A stop of a ring, without friction.
pub type Stop = StopConfig;

/// A ball bearing as retainer: its inner ring turns, and the rotor rubs on that.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BallBearing {
    /// Its inner ring, cage, drag and heat.
    pub race: RaceConfig,
    /// Of balls and races under a load, N/m; rigid without.
    pub stiffness: Option<f64>,
    /// Marks that the optical sensors see on a turn of inner ring and cage; none where there is no sensor.
    pub marks: [Option<u16>; 2],
}

impl BallBearing {
    /// The optical sensors, where there are any, on a ring of this bore radius (m).
    pub(super) fn tachometers(&self, bore_radius: f64) -> Option<Tachometers> {
        (self.marks != [None; 2]).then_some(Tachometers {
            marks: self.marks,
            cage_ratio: self.race.cage_ratio,
            bore_radius,
            edge_error: EDGE_ERROR,
            window: SPEED_WINDOW,
        })
    }
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct SupportTable {
    mass_kg: f64,
    stiffness_n_m: f64,
    vertical_stiffness_n_m: Option<f64>,
    #[serde(default)]
    damping_n_s_m: f64,
    vertical_damping_n_s_m: Option<f64>,
    #[serde(default)]
    dry_friction_n: f64,
    travel_mm: Option<f64>,
    stop_stiffness_n_m: Option<f64>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct BallBearingTable {
    inner_ring_inertia_kg_m2: f64,
    #[serde(default)]
    dry_drag_n_m: f64,
    #[serde(default)]
    viscous_drag_n_m_s: f64,
    cage_ratio: Option<f64>,
    heat_capacity_j_k: Option<f64>,
    #[serde(default)]
    heat_loss_w_k: f64,
    stiffness_n_m: Option<f64>,
    inner_ring_marks: Option<u16>,
    cage_marks: Option<u16>,
}

/// (1 - ball over pitch diameter)/2 where balls are a fifth of the pitch diameter, as in deep-groove
/// bearings.
const USUAL_CAGE_RATIO: f64 = 0.4;
/// 0.2 kg of steel, 460 J/(kg K).
const USUAL_HEAT_CAPACITY: f64 = 92.0;

impl SupportTable {
    pub fn check(&self) -> Result<Support, Diagnostic> {
        const KEYS: Keys = Keys("support");
        let stiffness = |key, value| KEYS.within(key, value, limits::STIFFNESS_N_M);
        let damping = |key, value| KEYS.within(key, value, limits::DAMPING_N_S_M);
        let along_x = [
            stiffness("stiffness_n_m", self.stiffness_n_m)?,
            damping("damping_n_s_m", self.damping_n_s_m)?,
        ];
        let [spring, damper] = [self.vertical_stiffness_n_m, self.vertical_damping_n_s_m];
        let given = spring.is_some() || damper.is_some();
        let along_y = [
            stiffness("vertical_stiffness_n_m", spring.unwrap_or(along_x[0]))?,
            damping("vertical_damping_n_s_m", damper.unwrap_or(along_x[1]))?,
        ];
        Ok(Support {
            mass: KEYS.within("mass_kg", self.mass_kg, limits::MASS_KG)?,
            stiffness: along_x[0],
            damping: along_x[1],
            vertical: given.then_some(along_y),
            friction: KEYS.between(
                "dry_friction_n",
                self.dry_friction_n,
                limits::DRY_FRICTION_N,
            )?,
            stop: self.stop(KEYS)?,
        })
    }

    fn stop(&self, keys: Keys) -> Result<Option<Stop>, Diagnostic> {
        const KEY: &str = "stop_stiffness_n_m";
        let stiffness = |it| keys.within(KEY, it, limits::STIFFNESS_N_M);
        let stiffness = self.stop_stiffness_n_m.map(stiffness).transpose()?;
        let Some(travel) = self.travel_mm else {
            return match stiffness {
                Some(_) => Err(keys.broken(KEY, "stop_stiffness_n_m needs travel_mm")),
                None => Ok(None),
            };
        };
        Ok(Some(Stop {
            travel: MILLI * keys.within("travel_mm", travel, limits::TRAVEL_MM)?,
            stiffness,
        }))
    }
}

impl BallBearingTable {
    pub fn check(&self) -> Result<BallBearing, Diagnostic> {
        const KEYS: Keys = Keys("ball_bearing");
        let inertia = self.inner_ring_inertia_kg_m2;
        let cage_ratio = self.cage_ratio.unwrap_or(USUAL_CAGE_RATIO);
        let capacity = self.heat_capacity_j_k.unwrap_or(USUAL_HEAT_CAPACITY);
        let stiffness = |it| KEYS.within("stiffness_n_m", it, limits::STIFFNESS_N_M);
        let drag = |key, value| KEYS.within(key, value, limits::DRAG);
        let marks = [
            ("inner_ring_marks", self.inner_ring_marks),
            ("cage_marks", self.cage_marks),
        ];
        for (key, marks) in marks {
            if let Some(marks) = marks {
                KEYS.between(key, f64::from(marks), limits::MARKS)?;
            }
        }
        let key = "inner_ring_inertia_kg_m2";
        let race = RaceConfig {
            inertia: KEYS.within(key, inertia, limits::RING_INERTIA_KG_M2)?,
            dry_drag: drag("dry_drag_n_m", self.dry_drag_n_m)?,
            viscous_drag: drag("viscous_drag_n_m_s", self.viscous_drag_n_m_s)?,
            cage_ratio: KEYS.between("cage_ratio", cage_ratio, limits::CAGE_RATIO)?,
            heat_capacity: KEYS.within("heat_capacity_j_k", capacity, limits::HEAT_CAPACITY_J_K)?,
            heat_loss: drag("heat_loss_w_k", self.heat_loss_w_k)?,
        };
        Ok(BallBearing {
            race,
            stiffness: self.stiffness_n_m.map(stiffness).transpose()?,
            marks: marks.map(|(_, marks)| marks),
        })
    }
}
