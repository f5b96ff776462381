//! What a scene asks of its model, and how closely.

use super::model::{Fidelity, Math, Model, Precision, Scheme};

/// Something that a drop gives.
#[derive(Clone, Copy, Debug, PartialEq, Eq, strum::Display)]
#[strum(serialize_all = "lowercase")]
pub enum Output {
    /// Regime at the end of the run.
    Regime,
    /// Times of the first ten impacts.
    #[strum(serialize = "impact times")]
    ImpactTime,
    /// Speeds into the wall at the first ten impacts.
    #[strum(serialize = "impact speeds")]
    ImpactSpeed,
    /// Starts and ends of permanent contact, and starts of rolling.
    Phases,
    /// Load m v^2/rho0 of a whirl at the end of the run.
    #[strum(serialize = "whirl load")]
    WhirlLoad,
    /// Greatest contact force of the first impact.
    #[strum(serialize = "peak force")]
    PeakForce,
    /// Duration of the first impact.
    #[strum(serialize = "contact time")]
    ContactTime,
}

/// An output and the greatest error that is allowed: s for times, a part of the true value for the rest;
/// nothing for the regime, which is right or wrong.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Request {
    /// What.
    pub output: Output,
    /// How closely.
    pub tolerance: f64,
}

/// A model that is to be chosen: the cheapest that gives what is asked.
#[derive(Clone, Debug, PartialEq)]
pub struct Auto {
    /// What is asked.
    pub asked: Vec<Request>,
    /// What the scene fixes all the same.
    pub fixed: Fixed,
}

/// Parts of the model that a scene gives itself.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Fixed {
    /// Rung.
    pub rung: Option<Fidelity>,
    /// Scheme.
    pub scheme: Option<Scheme>,
    /// Number format.
    pub precision: Option<Precision>,
    /// Functions.
    pub math: Option<Math>,
    /// s.
    pub step: Option<f64>,
    /// m/s.
    pub cutoff: f64,
}

impl Fixed {
    /// `model` with what is fixed: the step is put in, for the rest the model must have it.
    pub fn apply(&self, model: Model) -> Option<Model> {
        let fits = self.rung.is_none_or(|rung| rung == model.rung)
            && self.scheme.is_none_or(|scheme| scheme == model.scheme)
            && self.precision.is_none_or(|it| it == model.precision)
            && self.math.is_none_or(|math| math == model.math);
        fits.then(|| Model {
            step: self.step.unwrap_or(model.step),
            cutoff: if model.rung == Fidelity::Rigid {
                self.cutoff
            } else {
                0.0
            },
            ..model
        })
    }
}

impl Output {
    /// An error or tolerance of this output, for people.
    pub fn show(self, error: f64) -> String {
        match self {
            Self::Regime if error == 0.0 => "right".to_owned(),
            Self::Regime => "wrong".to_owned(),
            _ if !error.is_finite() => "not given".to_owned(),
            Self::ImpactTime | Self::Phases => format!("{} us", short(error * 1e6)),
            Self::ImpactSpeed | Self::WhirlLoad | Self::PeakForce | Self::ContactTime => {
                format!("{} %", short(error * 100.0))
            }
        }
    }
}

/// Three digits or so.
fn short(value: f64) -> String {
    if value != 0.0 && value < 1e-3 {
        return format!("{value:.1e}");
    }
    let decimals = (2 - value.max(1e-3).log10().floor() as i32).clamp(0, 5) as usize;
    let text = format!("{value:.decimals$}");
    match text.contains('.') {
        true => text.trim_end_matches('0').trim_end_matches('.').to_owned(),
        false => text,
    }
}
