//! `fidelity = "auto"` and `[outputs]`: from the file to what is asked.

use super::Model;
use super::diagnostic::Diagnostic;
use super::file::{ModelTable, OutputsTable, SceneFile};
use super::outputs::{Auto, Fixed, Output, Request};
use touchdown_base::plain::Number;

const MICRO: f64 = 1e-6;
const PERCENT: f64 = 1e-2;
/// Of the phases' bounds, where a scene asks for nothing, s.
const DEFAULT_PHASES: f64 = 100e-6;

/// What the scene leaves open; `model` has what it gives.
pub(super) fn auto(file: &SceneFile, model: &Model) -> Result<Option<Auto>, Diagnostic> {
    let both = file.fidelity.is_some() && file.model.fidelity.is_some();
    if both {
        return Err(Diagnostic::new(
            "model",
            "fidelity",
            "fidelity is given twice",
        ));
    }
    let given = file.fidelity.as_deref().or(file.model.fidelity.as_deref());
    match (given, &file.outputs) {
        (None, None) => Ok(None),
        (None, Some(_)) => {
            let rule = "[outputs] says what fidelity = \"auto\" has to give, but the scene has no such line";
            Err(Diagnostic::new("outputs", "", rule))
        }
        (Some("auto"), outputs) => Ok(Some(Auto {
            asked: asked(outputs.as_ref())?,
            fixed: fixed(&file.model, model),
        })),
        (Some(other), _) => {
            let rule = format!("fidelity must be \"auto\", is \"{other}\"");
            // At the top of the scene the key stands where a table's name would.
            let top = file.fidelity.is_some();
            let table = if top { "fidelity" } else { "model" };
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
    let Some(table) = table else {
        return Ok(vec![
            Request {
                output: Output::Regime,
                tolerance: 0.0,
            },
            Request {
                output: Output::Phases,
                tolerance: DEFAULT_PHASES,
            },
        ]);
    };
    let mut asked = Vec::new();
    if table.regime == Some(true) {
        asked.push(Request {
            output: Output::Regime,
            tolerance: 0.0,
        });
    }
    let tolerances = [
        (
            "impact_time_us",
            table.impact_time_us,
            Output::ImpactTime,
            MICRO,
        ),
        (
            "impact_speed_percent",
            table.impact_speed_percent,
            Output::ImpactSpeed,
            PERCENT,
        ),
        ("phases_us", table.phases_us, Output::Phases, MICRO),
        (
            "whirl_load_percent",
            table.whirl_load_percent,
            Output::WhirlLoad,
            PERCENT,
        ),
        (
            "peak_force_percent",
            table.peak_force_percent,
            Output::PeakForce,
            PERCENT,
        ),
        (
            "contact_time_percent",
            table.contact_time_percent,
            Output::ContactTime,
            PERCENT,
        ),
    ];
    for (key, given, output, unit) in tolerances {
        let Some(given) = given else { continue };
        if given <= 0.0 {
            let rule = format!(
                "{key} is a tolerance and must be above 0, is {}",
                Number(given)
            );
            return Err(Diagnostic::new("outputs", key, rule));
        }
        asked.push(Request {
            output,
            tolerance: unit * given,
        });
    }
    if asked.is_empty() {
        return Err(Diagnostic::new(
            "outputs",
            "regime",
            "[outputs] asks for nothing",
        ));
    }
    Ok(asked)
}
