//! Why a combination was chosen, for people.

use std::fmt::Write;

use super::{Candidate, Choice, Tried};
use touchdown_scene::Model;

/// Cheaper combinations that are listed.
const LISTED: usize = 3;

/// The choice, what it costs, how often it holds, and what the next cheaper ones lack.
pub fn explain(choice: &Choice) -> String {
    let taken = choice.taken();
    let (name, all) = (name(&taken.model), choice.candidates.len());
    let mut text = format!("fidelity: {name}; of {all} combinations\n");
    let which = match choice.suffices() {
        true => "the cheapest that suffices",
        false => "the nearest: none gives all that is asked",
    };
    let _ = writeln!(text, "{which}, measured over {} s", choice.measured);
    if let Some(count) = taken.cost.map(count) {
        let on = "instructions a simulated second on the target";
        let _ = writeln!(text, "  {count} {on}");
    }
    for (index, request) in choice.asked.iter().enumerate() {
        let show = |error| request.output.show(error);
        let _ = write!(text, "  {}: {}", request.output, show(taken.errors[index]));
        if let Some(tried) = &taken.tried {
            let _ = write!(text, ", at worst {}", show(tried.worst[index]));
        }
        let _ = writeln!(text, ", asked {}", show(request.tolerance));
    }
    if let Some(Tried { drops, kept, .. }) = taken.tried {
        let _ = writeln!(text, "  kept in {kept} of {drops} drops around this one");
    }
    if !choice.suffices() {
        return text;
    }
    let cheaper = &choice.candidates[..choice.taken];
    for candidate in cheaper.iter().rev().take(LISTED) {
        let _ = writeln!(text, "  cheaper, but: {}", lacks(candidate, choice));
    }
    if cheaper.len() > LISTED {
        let _ = writeln!(text, "  and {} more", cheaper.len() - LISTED);
    }
    text
}

fn lacks(candidate: &Candidate, choice: &Choice) -> String {
    let (errors, around) = match &candidate.tried {
        Some(tried) => (&tried.worst, ", in a drop around this one"),
        None => (&candidate.errors, ""),
    };
    let all = choice.asked.iter().zip(errors);
    let beyond = all.filter(|(request, error)| **error > request.tolerance);
    let faults = beyond.map(|(it, error)| format!("{} {}", it.output, it.output.show(*error)));
    let faults = faults.collect::<Vec<_>>().join(", ");
    let cost = candidate.cost.map_or("not counted".to_owned(), count);
    format!("{}, {cost}: {faults}{around}", name(&candidate.model))
}

/// A combination, for people.
pub(crate) fn name(model: &Model) -> String {
    let Model { rung, scheme, .. } = model;
    let step = (model.step * 1e9).round() / 1e3;
    let numbers = format!("{} {}", model.precision, model.math);
    let mut name = format!("{rung} {scheme} {numbers}, step {step} us");
    for part in model.left_out.names() {
        let _ = write!(name, ", without {part}");
    }
    name
}

fn count(instructions: f64) -> String {
    if instructions < 1e6 {
        format!("{:.0} thousand", instructions / 1e3)
    } else {
        format!("{:.1} million", instructions / 1e6)
    }
}
