//! What the detector must be told, and every threshold.

use touchdown_rotor::error::ConfigError;
use touchdown_rotor::scales::{not_negative, positive};

/// Part of the told clearance within which no wall reads: (0.8 - 0.3)/1.3, with zero and clearance told wrong by 0.3 of it
/// and gain by 0.2.
pub const NEAREST_WALL: f32 = 0.38;
/// Most instants that a test's bank has room for.
pub(crate) const MOST_INSTANTS: usize = 32;
/// Fewest instants that a test looks at.
pub(crate) const FEWEST_INSTANTS: u8 = 4;

/// The machine, as far as the detector needs it; SI.
#[derive(Clone, Copy, Debug, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct MachineConfig {
    /// Rotor mass, kg; for impulses and loads only.
    pub mass: f32,
    /// Radial clearance of the retainer, m.
    pub clearance: f32,
    /// Gravity, downwards, m/s^2; 0 for a vertical machine.
    pub gravity: f32,
    /// Rotor radius at the retainer, m.
    pub rotor_radius: f32,
    /// Polar inertia over mass times rotor radius squared; 1/2 for a solid cylinder.
    pub inertia_ratio: f32,
    /// Friction coefficient between rotor and retainer.
    pub friction: f32,
    /// Restitution of an impact, 0 to 1.
    pub restitution: f32,
    /// Nominal spin, counter-clockwise positive, rad/s; its sign decides between forward and
    /// backward whirl where no spin is measured.
    pub spin: f32,
}

/// Thresholds and times, SI; `docs/know/detector.md` derives each. The defaults suit the rig of the source paper.
#[derive(Clone, Copy, Debug, PartialEq, serde::Serialize, serde::Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct Tuning {
    /// Probability with which one instant of a test's bank declares something in one sample of white
    /// noise, 1e-15 to 0.01. Every likelihood ratio is compared with the logarithm of its inverse.
    pub false_alarm: f32,
    /// Levitated time that noise and position are learnt from before the monitor is armed, s.
    pub arming_time: f32,
    /// Longest fall that is searched for, s. A fall is found after about
    /// (20 d^2 sigma^2/(g^2 rate))^(1/5), 1.5 ms at 3 um and 10 kHz.
    pub release_horizon: f32,
    /// Instants in that time at which it may have begun, 4 to 32.
    pub release_instants: u8,
    /// Longest time since a velocity jump that is searched for, s.
    pub impact_horizon: f32,
    /// Instants in that time at which it may have been, 4 to 32.
    pub impact_instants: u8,
    /// Way from the levitated position beyond which no caught disturbance goes, as a part of the
    /// clearance: confirms a fall.
    pub confirm_travel: f32,
    /// Time back within noise that withdraws a declared fall, s.
    pub catch_time: f32,
    /// How far the retainer's wall may seem from its nominal place, as a part of the clearance:
    /// offset and gain error of the sensors.
    pub wall_tolerance: f32,
    /// Acceleration that the equations of flight may be wrong by, m/s^2.
    pub flight_error: f32,
    /// Acceleration that the equations of flight may be wrong by at one end of a rotor that tilts, m/s^2.
    pub tilt_error: f32,
    /// Acceleration that the equations of contact may be wrong by, m/s^2.
    pub contact_error: f32,
    /// Time without motion that counts as levitated again or at rest, s.
    pub still_time: f32,
    /// Standard deviation of the friction coefficient for a forecast, as a part of it.
    pub friction_error: f32,
    /// Standard deviation of the configured restitution for a forecast, before any impact has shown it.
    pub restitution_error: f32,
    /// Changes of motion that a forecast solves for after each tick; one in contact counts as three, and is
    /// solved if it is the first.
    pub forecast_changes: u8,
}

impl Default for Tuning {
    fn default() -> Self {
        Self {
            false_alarm: 1e-11,
            arming_time: 0.14,
            release_horizon: 4e-3,
            release_instants: 8,
            impact_horizon: 0.8e-3,
            impact_instants: 16,
            confirm_travel: 0.17,
            catch_time: 5e-3,
            wall_tolerance: 0.07,
            flight_error: 0.1,
            tilt_error: 3.0,
            contact_error: 0.15,
            still_time: 0.05,
            friction_error: 0.1,
            restitution_error: 0.05,
            forecast_changes: 3,
        }
    }
}

/// All that the detector is told.
#[derive(Clone, Copy, Debug, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct DetectorConfig {
    /// Samples per second, Hz.
    pub sample_rate: f32,
    /// The machine.
    pub machine: MachineConfig,
    /// Thresholds and times.
    pub tuning: Tuning,
}

impl DetectorConfig {
    /// Names the first parameter that breaks its rule.
    pub fn validate(&self) -> Result<(), ConfigError> {
        positive("sample_rate", self.sample_rate)?;
        if !(100.0..=200_000.0).contains(&self.sample_rate) {
            return Err(ConfigError::OutOfRange("sample_rate", "100 to 200 000 Hz"));
        }
        self.machine.validate()?;
        self.tuning.validate()?;
        Ok(())
    }
}

impl MachineConfig {
    /// Slip that friction takes off, m/s, for each m/s that the wall takes off the speed into it.
    pub(crate) fn slip_per_impulse(&self) -> f32 {
        self.friction * (1.0 + 1.0 / self.inertia_ratio)
    }

    fn validate(&self) -> Result<(), ConfigError> {
        positive("mass", self.mass)?;
        positive("clearance", self.clearance)?;
        not_negative("gravity", self.gravity)?;
        positive("rotor_radius", self.rotor_radius)?;
        positive("inertia_ratio", self.inertia_ratio)?;
        not_negative("friction", self.friction)?;
        not_negative("restitution", self.restitution)?;
        if self.restitution > 1.0 {
            return Err(ConfigError::OutOfRange("restitution", "0 to 1"));
        }
        if !self.spin.is_finite() {
            return Err(ConfigError::NotFinite("spin"));
        }
        Ok(())
    }
}

impl Tuning {
    fn validate(&self) -> Result<(), ConfigError> {
        positive("false_alarm", self.false_alarm)?;
        if !(1e-15..=0.01).contains(&self.false_alarm) {
            return Err(ConfigError::OutOfRange("false_alarm", "1e-15 to 0.01"));
        }
        let time = (10.0, "10 s or less");
        let part = (0.5, "0.5 or less");
        let any = (f32::INFINITY, "");
        for (name, value, (most, rule)) in [
            ("arming_time", self.arming_time, time),
            ("release_horizon", self.release_horizon, time),
            ("impact_horizon", self.impact_horizon, time),
            ("confirm_travel", self.confirm_travel, part),
            ("catch_time", self.catch_time, time),
            ("wall_tolerance", self.wall_tolerance, part),
            ("flight_error", self.flight_error, any),
            ("tilt_error", self.tilt_error, any),
            ("contact_error", self.contact_error, any),
            ("still_time", self.still_time, time),
        ] {
            positive(name, value)?;
            if value > most {
                return Err(ConfigError::OutOfRange(name, rule));
            }
        }
        for (name, instants) in [
            ("release_instants", self.release_instants),
            ("impact_instants", self.impact_instants),
        ] {
            if !(FEWEST_INSTANTS..=MOST_INSTANTS as u8).contains(&instants) {
                return Err(ConfigError::OutOfRange(name, "4 to 32"));
            }
        }
        for (name, part) in [
            ("friction_error", self.friction_error),
            ("restitution_error", self.restitution_error),
        ] {
            not_negative(name, part)?;
            if part > 0.5 {
                return Err(ConfigError::OutOfRange(name, "0.5 or less"));
            }
        }
        Ok(())
    }
}
