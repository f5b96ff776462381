//! `[support]` and `[ball_bearing]`: a retainer ring that gives way and one that turns.

use serde::Deserialize;
use touchdown_models::{MountConfig, RaceConfig, StopConfig};

use super::diagnostic::Diagnostic;
use super::rule::MILLI;
use crate::sensors::Tachometers;

/// Of an optical mark, rad: 0.1 mm on a circle of 50 mm diameter.
const EDGE_ERROR: f64 = 0.004;
/// Time back that the speed of a ring is measured over, s.
const SPEED_WINDOW: f64 = 0.005;

/// What the retainer ring stands on.
pub type Support = MountConfig;
/// A stop of a ring, without friction.
pub type Stop = StopConfig;
/// Inner ring, cage, drag and heat of a ball bearing.
pub type Race = RaceConfig;

/// A ball bearing as retainer: its inner ring turns, and the rotor rubs on that.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BallBearing {
    /// Its inner ring, cage, drag and heat.
    pub race: Race,
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
        let [spring, damper] = [self.vertical_stiffness_n_m, self.vertical_damping_n_s_m];
        let vertical = [
            spring.unwrap_or(self.stiffness_n_m),
            damper.unwrap_or(self.damping_n_s_m),
        ];
        let stop = self.travel_mm.map(|travel| Stop {
            travel: MILLI * travel,
            stiffness: self.stop_stiffness_n_m,
        });
        if stop.is_none() && self.stop_stiffness_n_m.is_some() {
            let rule = "stop_stiffness_n_m needs travel_mm";
            return Err(Diagnostic::new("support", "stop_stiffness_n_m", rule));
        }
        Ok(Support {
            mass: self.mass_kg,
            stiffness: self.stiffness_n_m,
            damping: self.damping_n_s_m,
            vertical: spring.or(damper).map(|_| vertical),
            friction: self.dry_friction_n,
            stop,
        })
    }
}

impl From<&BallBearingTable> for BallBearing {
    fn from(table: &BallBearingTable) -> Self {
        Self {
            race: Race {
                inertia: table.inner_ring_inertia_kg_m2,
                dry_drag: table.dry_drag_n_m,
                viscous_drag: table.viscous_drag_n_m_s,
                cage_ratio: table.cage_ratio.unwrap_or(USUAL_CAGE_RATIO),
                heat_capacity: table.heat_capacity_j_k.unwrap_or(USUAL_HEAT_CAPACITY),
                heat_loss: table.heat_loss_w_k,
            },
            stiffness: table.stiffness_n_m,
            marks: [table.inner_ring_marks, table.cage_marks],
        }
    }
}
