//! What the detector must be told, and every threshold.

/// The machine, as far as the detector needs it; SI.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct MachineConfig {
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

/// Thresholds and times; the defaults suit the rig of the source paper.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(default, deny_unknown_fields))]
pub struct Tuning {
    /// Probability that one sample of quiet levitation declares something.
    pub false_alarm: f32,
}

impl Default for Tuning {
    fn default() -> Self {
        Self { false_alarm: 1e-11 }
    }
}

/// All that the detector is told.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct DetectorConfig {
    /// Samples per second, Hz.
    pub sample_rate: f32,
    /// The machine.
    pub machine: MachineConfig,
    /// Thresholds and times.
    pub tuning: Tuning,
}
