//! What is modelled, and how it is computed.

use serde::Serialize;

/// Rung of the ladder of models.
#[derive(
    Clone, Copy, Debug, PartialEq, Eq, Hash, Serialize, strum::Display, strum::IntoStaticStr,
)]
#[serde(rename_all = "kebab-case")]
#[strum(serialize_all = "kebab-case")]
pub enum Fidelity {
    /// Restitution and Coulomb friction on a rigid ring, each impact located.
    Rigid,
    /// The same laws by time-stepping.
    Moreau,
    /// Contact force and its duration.
    Hertz,
    /// A retainer ring on a spring, or one that turns.
    Support,
    /// A rotor that tilts, in several rings.
    TwoPlane,
    /// A rotor that tilts and bends, in rings that give way and turn.
    Coupled,
}

/// How a rung goes through time.
#[derive(
    Clone, Copy, Debug, PartialEq, Eq, Hash, Serialize, strum::Display, strum::IntoStaticStr,
)]
#[serde(rename_all = "kebab-case")]
#[strum(serialize_all = "kebab-case")]
pub enum Scheme {
    /// From the launch to the next change, in closed form or by series. Rung `rigid`.
    Launch,
    /// Impact laws at the middle of each step (Moreau, Jean). Rungs `moreau`, `support`, `two-plane`,
    /// `coupled`.
    Midpoint,
    /// Semi-implicit Euler. Rung `hertz`.
    Euler,
    /// Velocity Verlet. Rung `hertz`.
    Verlet,
}

/// Number format of the model.
#[derive(
    Clone, Copy, Debug, PartialEq, Eq, Hash, Serialize, strum::Display, strum::IntoStaticStr,
)]
#[serde(rename_all = "lowercase")]
#[strum(serialize_all = "lowercase")]
pub enum Precision {
    /// Single.
    F32,
    /// Double.
    F64,
}

/// Where square roots, sines and the like come from.
#[derive(
    Clone, Copy, Debug, PartialEq, Eq, Hash, Serialize, strum::Display, strum::IntoStaticStr,
)]
#[serde(rename_all = "lowercase")]
#[strum(serialize_all = "lowercase")]
pub enum Math {
    /// The libm crate.
    Libm,
    /// Own bounded polynomials.
    Polynomial,
    /// The micromath crate; single precision only.
    Micromath,
}

/// What is modelled, and how it is computed.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Model {
    /// The rung.
    pub rung: Fidelity,
    /// How it goes through time.
    pub scheme: Scheme,
    /// Its number format.
    pub precision: Precision,
    /// Its functions.
    pub math: Math,
    /// Output interval, and where the scheme needs one, length of a step, s.
    pub step: f64,
    /// Launch speed from which on the rest of a bounce series is summed, m/s; 0: as low as the number
    /// format resolves. Rung `rigid`.
    pub cutoff: f64,
}

impl Fidelity {
    /// All, by rising cost.
    pub const ALL: [Self; 6] = [
        Self::Rigid,
        Self::Moreau,
        Self::Hertz,
        Self::Support,
        Self::TwoPlane,
        Self::Coupled,
    ];

    /// Its schemes; the first is the default.
    pub fn schemes(self) -> &'static [Scheme] {
        match self {
            Self::Rigid => &[Scheme::Launch],
            Self::Moreau | Self::Support | Self::TwoPlane | Self::Coupled => &[Scheme::Midpoint],
            Self::Hertz => &[Scheme::Euler, Scheme::Verlet],
        }
    }
}

impl Precision {
    /// Both.
    pub const ALL: [Self; 2] = [Self::F32, Self::F64];

    /// The functions that exist in it.
    pub fn maths(self) -> &'static [Math] {
        match self {
            Self::F32 => &[Math::Libm, Math::Polynomial, Math::Micromath],
            Self::F64 => &[Math::Libm, Math::Polynomial],
        }
    }
}
