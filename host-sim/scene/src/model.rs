//! What is modelled, and how it is computed.

use serde::{Deserialize, Serialize};
use strum::{Display, IntoStaticStr, VariantArray};

use super::Run;
use super::diagnostic::Diagnostic;
use super::rule::{Keys, MICRO, MILLI};

/// Rung of the ladder of models.
#[derive(
    Clone, Copy, Debug, PartialEq, Eq, Hash, Serialize, Display, IntoStaticStr, VariantArray,
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
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Serialize, Display, IntoStaticStr)]
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
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Serialize, Display, IntoStaticStr)]
#[serde(rename_all = "lowercase")]
#[strum(serialize_all = "lowercase")]
pub enum Precision {
    /// Single.
    F32,
    /// Double.
    F64,
}

/// Where square roots, sines and the like come from.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Serialize, Display, IntoStaticStr)]
#[serde(rename_all = "lowercase")]
#[strum(serialize_all = "lowercase")]
pub enum Math {
    /// The libm crate.
    Libm,
    /// Own bounded polynomials; single precision only.
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
    /// What the scene has and the model does without.
    pub left_out: LeftOut,
}

/// A part of a machine that a model can do without.
#[derive(Clone, Copy, Debug, PartialEq, Eq, IntoStaticStr, VariantArray)]
pub enum Removable {
    /// It bounds whirl.
    #[strum(serialize = "retainer's mass, spring, damper")]
    Mount,
    /// Of a mount.
    #[strum(serialize = "hard stop of the retainer")]
    Stop,
    /// The wall turns.
    #[strum(serialize = "inner ring, cage, drag, heat")]
    BallBearing,
    /// With all that needs it. The level decides whether a model has it.
    #[strum(serialize = "tilt, gyroscopic effect, both ends")]
    Tilt,
    /// And skew.
    #[strum(serialize = "unbalance")]
    Unbalance,
    /// Of bias or failed magnets.
    #[strum(serialize = "magnetic force that is left")]
    Magnets,
    /// All modes.
    #[strum(serialize = "bending of the shaft")]
    Bending,
    /// What the machine stands on.
    #[strum(serialize = "motion of the base")]
    Base,
}

/// A set of parts.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct LeftOut(u8);

impl LeftOut {
    /// For people.
    pub fn names(self) -> Vec<&'static str> {
        let all = Removable::VARIANTS.iter();
        let out = all.filter(|part| self.0 & 1 << **part as u8 != 0);
        out.map(<&'static str>::from).collect()
    }
}

impl Model {
    /// Whether it has `part` where its level does; the stop goes with its mount.
    pub fn has(&self, part: Removable) -> bool {
        let has = |part| self.left_out.0 & 1 << part as u8 == 0;
        has(part) && (part != Removable::Stop || has(Removable::Mount))
    }

    /// The same model without `part`.
    pub fn without(self, part: Removable) -> Self {
        match part {
            Removable::Tilt => Self {
                rung: Fidelity::Support,
                ..self
            },
            _ => Self {
                left_out: LeftOut(self.left_out.0 | 1 << part as u8),
                ..self
            },
        }
    }
}

impl Fidelity {
    /// All, by rising cost.
    pub const ALL: &[Self] = Self::VARIANTS;

    /// Its schemes; the first is the default.
    pub fn schemes(self) -> &'static [Scheme] {
        match self {
            Self::Rigid => &[Scheme::Launch],
            Self::Moreau | Self::Support | Self::TwoPlane | Self::Coupled => &[Scheme::Midpoint],
            Self::Hertz => &[Scheme::Euler, Scheme::Verlet],
        }
    }

    /// The functions that it has in a number format. Left out is what changes a step by less than 2 % on the target:
    /// own polynomials in f64, and micromath in rungs with rings of their own (docs/decisions/0033-functions-of-the-model.md).
    pub fn maths(self, precision: Precision) -> &'static [Math] {
        match (self, precision) {
            (_, Precision::F64) => &[Math::Libm],
            (Self::Support | Self::TwoPlane | Self::Coupled, _) => &[Math::Libm, Math::Polynomial],
            _ => &[Math::Libm, Math::Polynomial, Math::Micromath],
        }
    }
}

impl Math {
    /// All.
    pub const ALL: [Self; 3] = [Self::Libm, Self::Polynomial, Self::Micromath];
}

impl Precision {
    /// Both.
    pub const ALL: [Self; 2] = [Self::F32, Self::F64];
}

#[derive(Default, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct ModelTable {
    pub rung: Option<String>,
    pub scheme: Option<String>,
    pub math: Option<String>,
    pub precision: Option<String>,
    pub step_us: Option<f64>,
    pub cutoff_mm_s: Option<f64>,
    pub contact: Option<String>,
    pub fidelity: Option<String>,
}

pub(super) fn model(table: &ModelTable, run: &Run, needed: Fidelity) -> Result<Model, Diagnostic> {
    const KEYS: Keys = Keys("model");
    let rung = KEYS.named_or("rung", &table.rung, needed, Fidelity::ALL)?;
    let parts = match rung {
        Fidelity::Support => "[support] or [ball_bearing]",
        Fidelity::TwoPlane | Fidelity::Coupled => "[two_plane] and [[ring]]",
        Fidelity::Rigid | Fidelity::Moreau | Fidelity::Hertz => "",
    };
    // The coupled rung has all that rigid rings have.
    let more = (rung, needed) == (Fidelity::Coupled, Fidelity::TwoPlane);
    let less = (rung, needed) == (Fidelity::TwoPlane, Fidelity::Coupled);
    if less {
        let rule = "rung = \"two-plane\" has no support, ball bearing, mode, base, compliant contact, magnet's damping, limit or times: leave them out, or rung";
        return Err(KEYS.broken("rung", rule));
    }
    if !parts.is_empty() && needed != rung && !more {
        let rule = format!("rung = \"{}\" needs {parts}", rung);
        return Err(KEYS.broken("rung", rule));
    }
    let schemes = rung.schemes();
    let scheme = KEYS.named_or("scheme", &table.scheme, schemes[0], schemes)?;
    let (double, both) = (Precision::F64, &Precision::ALL);
    let precision = KEYS.named_or("precision", &table.precision, double, both)?;
    let math = KEYS.named_or("math", &table.math, Math::Libm, &Math::ALL)?;
    if !rung.maths(precision).contains(&math) {
        let rule = format!("math = \"{math}\" is not in rung = \"{rung}\" in {precision}");
        return Err(KEYS.broken("math", rule));
    }
    let step = match table.step_us {
        Some(step) => MICRO * step,
        None => (1.0 / run.sample_rate).clamp(MICRO, 1000.0 * MICRO),
    };
    let cutoff = match table.cutoff_mm_s {
        None => 0.0,
        Some(_) if rung != Fidelity::Rigid => {
            let rule = "cutoff_mm_s is that of rung = \"rigid\"".to_owned();
            return Err(KEYS.broken("cutoff_mm_s", rule));
        }
        Some(speed) => MILLI * speed,
    };
    Ok(Model {
        rung,
        scheme,
        precision,
        math,
        step,
        cutoff,
        left_out: LeftOut::default(),
    })
}
