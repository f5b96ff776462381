//! The detector's events and the impacts, as tables.

use super::Subject;
use maud::{Markup, html};
use touchdown_base::history::{Impact, Pulse};
pub use touchdown_chart::table::{OPEN, table};
use touchdown_chart::text::{column, error, ms, ms_or_dash, si};
use touchdown_core::event::EventKind;
use touchdown_run::matching::{Match, Matches};
use touchdown_run::outcome::{DetectedEvent, Outcome};
use touchdown_scene::names::event_name;

/// Velocity jump from which the detector is designed to find an impact, m/s.
const DESIGN_JUMP: f64 = 18e-3;

/// All events of the detector and what became of the true ones.
pub fn events(outcome: &Outcome, matches: &Matches) -> Markup {
    let detection = &outcome.detection;
    let missed = matches
        .events
        .iter()
        .filter(|it| it.detected.is_none() && it.kind != EventKind::Impact);
    let missed: Vec<&Match> = missed.collect();
    let head = html! {
        th { "Event" }
        th.number { "Onset" br; "ms" }
        th.number { "Declared" br; "ms" }
        th.number { "Confirmed" br; "ms" }
        th.number { "Latency" br; "ms" }
        th.number { "Onset error" br; "ms" }
        th { "Plane" }
        th { "Against the truth" }
    };
    let row = |&(index, event): &(usize, &DetectedEvent)| {
        let is_false = matches.false_events.contains(&index);
        event_row(event, matches.of_detected(index), is_false)
    };
    let all = detection.events.iter().enumerate();
    let (hits, changes): (Vec<_>, Vec<_>) = all.partition(|it| it.1.event == EventKind::Impact);
    html! {
        p {
            (detection.events.len()) " events in " (detection.samples) " samples, "
            (matches.false_events.len()) " false, " (detection.faults) " unusable channel values."
        }
        @if !changes.is_empty() { (table("Events of the detector", &head, changes.iter().map(row))) }
        @if !hits.is_empty() {
            details {
                summary { "Detected impacts: " (hits.len()) }
                (table("Detected impacts", &head, hits.iter().map(row)))
            }
        }
        @for missed in missed.iter().take(OPEN) {
            p.missed { "Missed: " (event_name(missed.kind)) " at " (ms(missed.onset_s)) "\u{a0}ms" }
        }
        @if missed.len() > OPEN { p.missed { "and " (missed.len() - OPEN) " more missed." } }
        p.note {
            "Latency: declared less true onset. Onset error: estimated less true onset. A regime has no instant of its "
            "own; its latency counts from the start of the contact."
        }
    }
}

fn event_row(event: &DetectedEvent, truth: Option<&Match>, is_false: bool) -> Markup {
    let judgement = match truth {
        Some(_) => "true",
        None if is_false => "false",
        None => "not judged",
    };
    html! {
        td {
            (event_name(event.event))
            @if let Some(speed) = event.normal_speed_m_s { ", " (si(speed, "m/s")) }
        }
        td.number { (ms(event.onset_s)) }
        td.number { (ms(event.declared_s)) }
        td.number { (ms_or_dash(event.confirmed_s)) }
        td.number { (ms_or_dash(truth.and_then(|it| it.latency_s))) }
        td.number { (ms_or_dash(truth.and_then(|it| it.onset_error_s))) }
        td { (event.plane) }
        td class=(if is_false { "missed" } else { "" }) {
            (judgement)
            @if let Some(time) = event.withdrawn_s { ", withdrawn at " (ms(time)) "\u{a0}ms" }
        }
    }
}

/// The true impacts, whether they were detected, and the model's error at each.
pub fn impacts(subject: &Subject, outcome: &Outcome, matches: &Matches) -> Markup {
    let truth = &outcome.truth.impacts;
    if truth.is_empty() {
        return html! { p { "None." } };
    }
    let found: Vec<&Match> = matches.of_kind(EventKind::Impact).collect();
    let hard = |impact: &Impact| impact.normal_impulse / subject.machine.mass >= DESIGN_JUMP;
    let hard: Vec<bool> = truth.iter().map(hard).collect();
    let detected = found.iter().filter(|it| it.detected.is_some()).count();
    let hard_found = found
        .iter()
        .zip(&hard)
        .filter(|(it, hard)| **hard && it.detected.is_some());
    let forces = outcome.model.has_forces();
    let head = html! {
        th.number { "Index" }
        th.number { "Time" br; "ms" }
        th.number { "Normal speed" br; "mm/s" }
        th.number { "Impulse" br; "mN\u{a0}s" }
        th { "Detected" }
        th.number { "Latency" br; "ms" }
        th.number { "Onset error" br; "ms" }
        th.number { "Model: time error" br; "s" }
        th.number { "Model: speed error" br; "relative" }
        @if forces {
            th.number { "Peak force" br; "N" }
            th.number { "Contact" br; "ms" }
        }
    };
    let model = &outcome.model.impacts;
    let row = |((index, impact), found): ((usize, &Impact), &&Match)| {
        let model = model.get(index);
        html! {
            (impact_row(index, impact, model, found))
            @if forces { (force_cells(model.and_then(|it| it.pulse))) }
        }
    };
    let rows = truth.iter().enumerate().zip(&found).map(row);
    html! {
        p {
            (truth.len()) " impacts, " (detected) " detected. Of the " (hard.iter().filter(|it| **it).count())
            " whose velocity jump reaches " (si(DESIGN_JUMP, "m/s"))
            ", from which detection is the design target, " (hard_found.count()) " were detected."
        }
        (table("Impacts", &head, rows))
        p.note {
            "Normal speed: into the wall just before. The series ends where the bounce speed is below the reference's "
            "cut-off; its last impacts are far below any sensor's noise. Model and reference are compared by index."
            @if forces { " Peak force and length of the contact are the model's; an impact that turns into permanent contact has none of its own." }
        }
    }
}

fn impact_row(index: usize, truth: &Impact, model: Option<&Impact>, found: &Match) -> Markup {
    let time_error = model.map(|model| model.state.time - truth.state.time);
    let speed_error = model.map(|model| model.normal_speed / truth.normal_speed - 1.0);
    html! {
        td.number { (index) }
        td.number { (ms(truth.state.time)) }
        td.number { (column(truth.normal_speed * 1e3)) }
        td.number { (column(truth.normal_impulse * 1e3)) }
        td { (if found.detected.is_some() { "yes" } else { "no" }) }
        td.number { (ms_or_dash(found.latency_s)) }
        td.number { (ms_or_dash(found.onset_error_s)) }
        td.number { (time_error.map_or("\u{2013}".to_owned(), error)) }
        td.number { (speed_error.map_or("\u{2013}".to_owned(), error)) }
    }
}

fn force_cells(pulse: Option<Pulse>) -> Markup {
    let number = |value: Option<f64>| value.map_or("\u{2013}".to_owned(), column);
    html! {
        td.number { (number(pulse.map(|it| it.peak_force))) }
        td.number { (number(pulse.map(|it| it.duration * 1e3))) }
    }
}
