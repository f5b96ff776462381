//! `fidelity = "auto"` and `[outputs]`: what a scene asks of its model, and how closely.

use serde::Deserialize;
use touchdown_base::plain::Number;

use super::diagnostic::Diagnostic;
use super::model::{Fidelity, Math, Model, ModelTable, Precision, Scheme};
use super::rule::{Keys, MICRO};

const OUTPUTS: Keys = Keys("outputs");
const PERCENT: f64 = 1e-2;
const REGIME: Request = Request {
    output: Output::Regime,
    tolerance: 0.0,
};
/// Of the phases' bounds, where a scene asks for nothing, s.
const DEFAULT_PHASES: f64 = 100e-6;

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

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct OutputsTable {
    pub regime: Option<bool>,
    pub impact_time_us: Option<f64>,
    pub impact_speed_percent: Option<f64>,
    pub phases_us: Option<f64>,
    pub whirl_load_percent: Option<f64>,
    pub peak_force_percent: Option<f64>,
    pub contact_time_percent: Option<f64>,
}

/// What the scene leaves open; `at_top` is the line of the scene, `model` has what `table` gives.
pub(super) fn auto(
    at_top: Option<&str>,
    table: &ModelTable,
    outputs: Option<&OutputsTable>,
    model: &Model,
) -> Result<Option<Auto>, Diagnostic> {
    if at_top.and(table.fidelity.as_ref()).is_some() {
        return Err(Keys("model").broken("fidelity", "fidelity is given twice"));
    }
    match (at_top.or(table.fidelity.as_deref()), outputs) {
        (None, None) => Ok(None),
        (None, Some(_)) => {
            let rule = "[outputs] says what fidelity = \"auto\" has to give, but the scene has no such line";
            Err(OUTPUTS.broken("", rule))
        }
        (Some("auto"), outputs) => Ok(Some(Auto {
            asked: asked(outputs)?,
            fixed: fixed(table, model),
        })),
        (Some(other), _) => {
            let rule = format!("fidelity must be \"auto\", is \"{other}\"");
            // At the top of the scene the key stands where a table's name would.
            let table = at_top.map_or("model", |_| "fidelity");
            Err(Diagnostic::new(table, "fidelity", rule))
        }
    }
}

fn fixed(table: &ModelTable, model: &Model) -> Fixed {
    Fixed {
        rung: table.rung.is_some().then_some(model.rung),
        scheme: table.scheme.is_some().then_some(model.scheme),
        precision: table.precision.is_some().then_some(model.precision),
        math: table.math.is_some().then_some(model.math),
        step: table.step_us.is_some().then_some(model.step),
        cutoff: model.cutoff,
    }
}

fn asked(table: Option<&OutputsTable>) -> Result<Vec<Request>, Diagnostic> {
    use Output::{ContactTime, ImpactSpeed, ImpactTime, PeakForce, Phases, WhirlLoad};
    let Some(it) = table else {
        let phases = Request {
            output: Phases,
            tolerance: DEFAULT_PHASES,
        };
        return Ok(vec![REGIME, phases]);
    };
    let mut asked = Vec::new();
    asked.extend((it.regime == Some(true)).then_some(REGIME));
    for (key, given, output) in [
        ("impact_time_us", it.impact_time_us, ImpactTime),
        ("impact_speed_percent", it.impact_speed_percent, ImpactSpeed),
        ("phases_us", it.phases_us, Phases),
        ("whirl_load_percent", it.whirl_load_percent, WhirlLoad),
        ("peak_force_percent", it.peak_force_percent, PeakForce),
        ("contact_time_percent", it.contact_time_percent, ContactTime),
    ] {
        let Some(given) = given else { continue };
        if given <= 0.0 {
            let given = Number(given);
            let rule = format!("{key} is a tolerance and must be above 0, is {given}");
            return Err(OUTPUTS.broken(key, rule));
        }
        let unit = match output {
            ImpactTime | Phases => MICRO,
            _ => PERCENT,
        };
        asked.push(Request {
            output,
            tolerance: unit * given,
        });
    }
    if asked.is_empty() {
        return Err(OUTPUTS.broken("regime", "[outputs] asks for nothing"));
    }
    Ok(asked)
}
