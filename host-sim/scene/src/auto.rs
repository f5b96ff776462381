//! `fidelity = "auto"` and `[outputs]`: from the file to what is asked.

use super::Model;
use super::diagnostic::Diagnostic;
use super::file::{ModelTable, OutputsTable, SceneFile};
use super::outputs::{Auto, Fixed, Output, Request};
use super::rule::{Keys, MICRO};
use touchdown_base::plain::Number;

const OUTPUTS: Keys = Keys("outputs");
const PERCENT: f64 = 1e-2;
const REGIME: Request = Request {
    output: Output::Regime,
    tolerance: 0.0,
};
/// Of the phases' bounds, where a scene asks for nothing, s.
const DEFAULT_PHASES: f64 = 100e-6;

/// What the scene leaves open; `model` has what it gives.
pub(super) fn auto(file: &SceneFile, model: &Model) -> Result<Option<Auto>, Diagnostic> {
    let both = file.fidelity.is_some() && file.model.fidelity.is_some();
    if both {
        return Err(Keys("model").broken("fidelity", "fidelity is given twice"));
    }
    let given = file.fidelity.as_deref().or(file.model.fidelity.as_deref());
    match (given, &file.outputs) {
        (None, None) => Ok(None),
        (None, Some(_)) => {
            let rule = "[outputs] says what fidelity = \"auto\" has to give, but the scene has no such line";
            Err(OUTPUTS.broken("", rule))
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
