//! The detector's events and the impacts, as tables.

use maud::{Markup, html};
use touchdown_base::history::{Impact, Pulse};
use touchdown_chart::table::{OPEN, table};
use touchdown_chart::text::{column, error, ms, or_dash, si};
use touchdown_core::event::EventKind;
use touchdown_run::matching::{Match, Matches};
use touchdown_run::outcome::{DetectedEvent, Outcome};
use touchdown_scene::Scene;

/// Velocity jump from which the detector is designed to find an impact, m/s.
const DESIGN_JUMP: f64 = 18e-3;

/// All events of the detector and what became of the true ones.
pub fn events(outcome: &Outcome, matches: &Matches) -> Markup {
    let detection = &outcome.detection;
    let missed = |it: &&Match| it.detected.is_none() && it.kind != EventKind::Impact;
    let missed: Vec<&Match> = matches.events.iter().filter(missed).collect();
    let all = detection.events.iter().enumerate();
    let (hits, changes): (Vec<_>, Vec<_>) = all.partition(|it| it.1.event == EventKind::Impact);
    html! {
        p {
            (detection.events.len()) " events in " (detection.summary.samples) " samples, "
            (matches.false_events.len()) " false, " (detection.summary.faults) " unusable channel values."
        }
        @if !changes.is_empty() { (listed("Events of the detector", &changes, matches)) }
        @if !hits.is_empty() {
            details {
                summary { "Detected impacts: " (hits.len()) }
                (listed("Detected impacts", &hits, matches))
            }
        }
        @for missed in missed.iter().take(OPEN) {
            p.missed { "Missed: " (<&str>::from(missed.kind)) " at " (ms(missed.onset_s)) "\u{a0}ms" }
        }
        @if missed.len() > OPEN { p.missed { "and " (missed.len() - OPEN) " more missed." } }
        p.note {
            "Latency: declared less true onset. Onset error: estimated less true onset. A regime has no instant of its "
            "own; its latency counts from the start of the contact."
        }
    }
}

/// Of events with their numbers.
fn listed(name: &str, events: &[(usize, &DetectedEvent)], matches: &Matches) -> Markup {
    let truth = |index: usize| matches.of_detected(index);
    let late = |index| or_dash(truth(index).and_then(|it| it.latency_s), ms);
    let off = |index| or_dash(truth(index).and_then(|it| it.onset_error_s), ms);
    table(name, events)
        .words("Event", |(_, it)| {
            let speed = it.normal_speed_m_s.map(|it| format!(", {}", si(it, "m/s")));
            <&str>::from(it.event).to_owned() + &speed.unwrap_or_default()
        })
        .number("Onset\nms", |it| ms(it.1.onset_s))
        .number("Declared\nms", |it| ms(it.1.declared_s))
        .number("Confirmed\nms", |it| or_dash(it.1.confirmed_s, ms))
        .number("Latency\nms", |it| late(it.0))
        .number("Onset error\nms", |it| off(it.0))
        .words("Plane", |it| it.1.plane)
        .marked("Against the truth", |(index, it)| {
            let (class, judgement) = match truth(*index) {
                _ if matches.false_events.contains(index) => ("missed", "false"),
                Some(_) => ("", "true"),
                None => ("", "not judged"),
            };
            let withdrawn = (it.withdrawn_s).map(|it| format!(", withdrawn at {}\u{a0}ms", ms(it)));
            (class, judgement.to_owned() + &withdrawn.unwrap_or_default())
        })
        .draw()
}

/// The true impacts, whether they were detected, and the model's error at each.
pub fn impacts(scene: &Scene, outcome: &Outcome, matches: &Matches) -> Markup {
    let truth = &outcome.truth.whole.impacts;
    let model = &outcome.model.histories.whole;
    if truth.is_empty() {
        return html! { p { "None." } };
    }
    let found: Vec<&Match> = matches.of_kind(EventKind::Impact).collect();
    let is_hard = |it: &Impact| it.normal_impulse / scene.rotor.mass >= DESIGN_JUMP;
    let hard = || truth.iter().zip(&found).filter(|it| is_hard(it.0));
    let hard_found = hard().filter(|(_, it)| it.detected.is_some()).count();
    let detected = found.iter().filter(|it| it.detected.is_some()).count();
    let forces = model.has_forces();
    html! {
        p {
            (truth.len()) " impacts, " (detected) " detected. Of the " (hard().count())
            " whose velocity jump reaches " (si(DESIGN_JUMP, "m/s"))
            ", from which detection is the design target, " (hard_found) " were detected."
        }
        (impact_table(outcome, &found))
        p.note {
            "Normal speed: into the wall just before. The series ends where the bounce speed is below a "
            "cut-off; its last impacts are far below any sensor's noise. "
            @if outcome.by_reference { "Model and reference are compared by index." }
            @else { "The model's errors are estimated; a dash stands where they are not certain." }
            @if forces { " Peak force and length of the contact are the model's; an impact that turns into permanent contact has none of its own." }
        }
    }
}

/// Of the model's time, s, and of its speed, relative: against the reference, else estimated.
fn model_errors(outcome: &Outcome, index: usize) -> Option<[f64; 2]> {
    let truth = &outcome.truth.whole.impacts[index];
    if !outcome.by_reference {
        let known = outcome.accuracy.as_ref()?.impacts[index]?;
        return Some([known.time_s, known.normal_speed_m_s / truth.normal_speed]);
    }
    let model = outcome.model.histories.whole.impacts.get(index)?;
    Some([
        model.state.time - truth.state.time,
        model.normal_speed / truth.normal_speed - 1.0,
    ])
}

/// Each impact as the sensors saw it, the model's pulse and errors, and as detected.
fn impact_table(outcome: &Outcome, found: &[&Match]) -> Markup {
    let (truth, model) = (&outcome.truth.whole.impacts, &outcome.model.histories.whole);
    let milli = |value: f64| column(value * 1e3);
    let seen = |it: &Match| ["no", "yes"][usize::from(it.detected.is_some())];
    let off = |k: usize, which: usize| or_dash(model_errors(outcome, k).map(|it| it[which]), error);
    let pulse = |k: usize, of: fn(Pulse) -> f64| {
        or_dash(model.impacts.get(k).and_then(|it| it.pulse).map(of), column)
    };
    let rows: Vec<usize> = (0..found.len()).collect();
    let table = table("Impacts", &rows)
        .number("Index", |k| *k)
        .number("Time\nms", |k| ms(truth[*k].state.time))
        .number("Normal speed\nmm/s", |k| milli(truth[*k].normal_speed))
        .number("Impulse\nmN\u{a0}s", |k| milli(truth[*k].normal_impulse))
        .words("Detected", |k| seen(found[*k]))
        .number("Latency\nms", |k| or_dash(found[*k].latency_s, ms))
        .number("Onset error\nms", |k| or_dash(found[*k].onset_error_s, ms))
        .number("Model: time error\ns", |k| off(*k, 0))
        .number("Model: speed error\nrelative", |k| off(*k, 1));
    if !model.has_forces() {
        return table.draw();
    }
    table
        .number("Peak force\nN", |k| pulse(*k, |it| it.peak_force))
        .number("Contact\nms", |k| pulse(*k, |it| it.duration * 1e3))
        .draw()
}
