//! Why a combination was chosen, for people.

use std::fmt::Write;

use super::{Candidate, Choice};
use touchdown_scene::Model;

/// Cheaper combinations that are listed.
const LISTED: usize = 3;

/// The choice, what it costs, and what the next cheaper ones lack.
pub fn explain(choice: &Choice) -> String {
    let mut text = String::new();
    let Some(best) = choice.best() else {
        let _ = writeln!(
            text,
            "fidelity: none of {} combinations gives all that is asked; the best of each output:",
            choice.candidates.len()
        );
        for (index, request) in choice.asked.iter().enumerate() {
            let errors = choice.candidates.iter().map(|it| it.errors[index]);
            let _ = writeln!(
                text,
                "  {}: {}, asked {}",
                request.output,
                request.output.show(errors.fold(f64::INFINITY, f64::min)),
                request.output.show(request.tolerance)
            );
        }
        return text;
    };
    let _ = writeln!(
        text,
        "fidelity: {}; of {} combinations\nthe cheapest that suffices, measured over {} s",
        name(&best.model),
        choice.candidates.len(),
        choice.measured
    );
    let _ = writeln!(
        text,
        "  {} instructions a simulated second on the target",
        count(best.cost)
    );
    for (request, &error) in choice.asked.iter().zip(&best.errors) {
        let _ = writeln!(
            text,
            "  {}: {}, asked {}",
            request.output,
            request.output.show(error),
            request.output.show(request.tolerance)
        );
    }
    let cheaper = choice
        .candidates
        .iter()
        .take_while(|it| !it.suffices(&choice.asked));
    let cheaper: Vec<&Candidate> = cheaper.collect();
    let shown = cheaper.iter().rev().take(LISTED);
    for candidate in shown {
        let _ = writeln!(text, "  cheaper, but: {}", lacks(candidate, choice));
    }
    if cheaper.len() > LISTED {
        let _ = writeln!(text, "  and {} more", cheaper.len() - LISTED);
    }
    text
}

fn lacks(candidate: &Candidate, choice: &Choice) -> String {
    let faults: Vec<String> = choice
        .asked
        .iter()
        .zip(&candidate.errors)
        .filter(|(request, error)| **error > request.tolerance)
        .map(|(request, &error)| format!("{} {}", request.output, request.output.show(error)))
        .collect();
    format!(
        "{}, {}: {}",
        name(&candidate.model),
        count(candidate.cost),
        faults.join(", ")
    )
}

/// A combination, for people.
pub(crate) fn name(model: &Model) -> String {
    format!(
        "{} {} {} {}, step {} us",
        model.rung,
        model.scheme,
        model.precision,
        model.math,
        (model.step * 1e9).round() / 1e3
    )
}

fn count(instructions: f64) -> String {
    if instructions < 1e6 {
        format!("{:.0} thousand", instructions / 1e3)
    } else {
        format!("{:.1} million", instructions / 1e6)
    }
}
