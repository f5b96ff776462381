//! How hard a drop is on the machine, from position and speed alone.

use crate::detect::{DetectorConfig, MachineConfig};
use crate::error::ConfigError;
use crate::scales::positive;

/// Speed that the velocity index is measured in where nothing else sets one, m/s.
const DRIFT: f32 = 0.05;

/// What a drop has done so far; SI.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub struct Severity {
    /// Impacts that were declared.
    pub impacts: u32,
    /// Greatest speed into the wall, m/s.
    pub impact_speed: f32,
    /// Greatest impulse along the normal, N s.
    pub impulse: f32,
    /// Sum of them, N s.
    pub total_impulse: f32,
    /// Time in permanent contact, s.
    pub dwell: f32,
    /// Greatest speed of the centre in parts of sqrt(g rho0): 1.41 after a fall through the clearance.
    pub velocity_index: f32,
    /// Greatest frequency of going round the retainer in one contact, of whirl that was declared, Hz.
    pub whirl_frequency: f32,
    /// Greatest force of that whirl, m rho0 (2 pi f)^2 + m g, N.
    pub whirl_load: f32,
}

/// Coefficients.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Severeness {
    machine: MachineConfig,
    period: f32,
    speed: f32,
}

/// What a tick adds.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Strain {
    /// Speed of the centre, m/s, where known.
    pub(crate) speed: Option<f32>,
    pub(crate) in_contact: bool,
    /// Rate of a declared whirl, rad/s.
    pub(crate) whirl: Option<f32>,
}

impl Severeness {
    pub(crate) fn try_new(config: &DetectorConfig) -> Result<Self, ConfigError> {
        let machine = config.machine;
        positive("mass", machine.mass)?;
        let square = machine.gravity * machine.clearance;
        Ok(Self {
            machine,
            period: 1.0 / config.sample_rate,
            speed: if square > 0.0 {
                crate::real::sqrt(square)
            } else {
                DRIFT
            },
        })
    }

    /// An impact at `normal_speed` (m/s) where the restitution seems to be `restitution`.
    pub(crate) fn hit(&self, severity: &mut Severity, normal_speed: f32, restitution: f32) {
        let impulse = self.machine.mass * (1.0 + restitution) * normal_speed;
        severity.impacts = severity.impacts.saturating_add(1);
        severity.impact_speed = severity.impact_speed.max(normal_speed);
        severity.impulse = severity.impulse.max(impulse);
        severity.total_impulse += impulse;
    }

    /// A tick after the release.
    pub(crate) fn take(&self, severity: &mut Severity, strain: &Strain) {
        let Self {
            machine,
            period,
            speed: unit,
        } = self;
        if strain.in_contact {
            severity.dwell += period;
        }
        if let Some(speed) = strain.speed {
            severity.velocity_index = severity.velocity_index.max(speed / unit);
        }
        if let Some(rate) = strain.whirl {
            let load = machine.mass * (machine.clearance * rate * rate + machine.gravity);
            let frequency = rate.abs() / core::f32::consts::TAU;
            severity.whirl_frequency = severity.whirl_frequency.max(frequency);
            severity.whirl_load = severity.whirl_load.max(load);
        }
    }
}
