//! The head of the page: what happened, in a line and a few figures.

use super::accuracy::peak;
use maud::{Markup, Render, html};
use std::f64::consts::TAU;
use touchdown_base::history::{History, PhaseKind, Regime};
use touchdown_chart::text::{ms, or_dash, si, significant};
use touchdown_core::event::EventKind;
use touchdown_run::matching::{Match, Matches, regime_event};
use touchdown_run::outcome::Outcome;
use touchdown_scene::Scene;
use touchdown_scene::names::regime_name;

/// Draws the title, the verdict and the key figures.
pub fn verdict(scene: &Scene, outcome: &Outcome, matches: &Matches) -> Markup {
    let truth = &outcome.truth.whole;
    let contact = first_contact(truth);
    html! {
        header {
            p.kind { "Touchdown report" }
            h1 { (scene.heading()) }
            p.note { (scene.source.as_ref().unwrap_or(&scene.name)) }
            p class=(if whirls(truth) { "verdict alarm" } else { "verdict" }) {
                (motion(truth)) " " (detection(outcome, matches))
            }
            dl.figures {
                (figure("Regime at the end", regime_name(truth.regime), whirl(truth)))
                (figure("Peak impact speed", &or_dash(peak(truth), |it| si(it, "m/s")), impact_count(truth)))
                (figure("First contact", &contact.0, contact.1))
                (fall_figure(outcome, matches))
                (regime_figure(outcome, matches))
            }
        }
    }
}

/// Whether it does at the end of the run.
pub fn whirls(truth: &History) -> bool {
    matches!(truth.regime, Regime::ForwardWhirl | Regime::BackwardWhirl)
}

fn figure(name: &str, value: &str, note: impl Render) -> Markup {
    html! { div { dt { (name) } dd { (value) } dd.note { (note) } } }
}

fn motion(truth: &History) -> Markup {
    html! {
        @match truth.regime {
            Regime::ForwardWhirl => { "The rotor whirls round the retainer with its spin after " },
            Regime::BackwardWhirl => { "The rotor is driven into backward whirl round the retainer within " },
            Regime::Pendulum => { "No whirl at the end: the rotor swings at the bottom of the retainer after " },
            Regime::Rest => { "No whirl at the end: the rotor lies still on the retainer after " },
            Regime::Intermittent => {
                "No whirl at the end: the rotor keeps lifting off and falling back, " (truth.lift_offs.len()) " times in "
            },
            Regime::Bouncing => { "The rotor is not in permanent contact after " },
        }
        (si(truth.end.time, "s")) "."
    }
}

fn detection(outcome: &Outcome, matches: &Matches) -> Markup {
    let fall = matches.of_kind(EventKind::FreeFall).next();
    let first = outcome.truth.whole.impacts.first().map(|it| it.state.time);
    let whirls = [EventKind::ForwardWhirl, EventKind::BackwardWhirl];
    html! {
        @match fall.map(|fall| fall.latency_s) {
            None => {},
            Some(None) => { "The detector missed the free fall." },
            Some(Some(latency)) => {
                "The detector declared the free fall " (si(latency, "s")) " after the release"
                @if let Some(first) = first {
                    ", " (si((first - latency).abs(), "s")) " " (if latency < first { "before" } else { "after" }) " the first contact"
                }
                "."
            },
        }
        @for whirl in whirls.map(|it| matches.of_kind(it).next()).into_iter().flatten() {
            @if let Some(latency) = whirl.latency_s {
                " The detector named the whirl " (si(latency, "s")) " after that contact began."
            } @else { " The detector did not name the whirl." }
        }
        @match matches.false_events.len() {
            0 => {},
            1 => { " One of the detector's events is false." },
            count => { " " (count) " of the detector's events are false." },
        }
    }
}

fn whirl(truth: &History) -> Markup {
    let ([x, y], [vx, vy]) = (truth.end.position, truth.end.velocity);
    let rate = (x * vy - y * vx).abs() / (TAU * (x * x + y * y));
    html! {
        @if whirls(truth) {
            (significant(truth.end.turns_in_contact.abs(), 3)) " turns in this contact, at the end " (si(rate, "Hz"))
            " (on a rigid support an upper bound)"
        } @else { "no whirl at the end of the run" }
    }
}

fn impact_count(truth: &History) -> String {
    match truth.impacts.len() {
        0 => "no impacts".to_owned(),
        1 => "1 impact, into the wall".to_owned(),
        count => format!("{count} impacts, into the wall"),
    }
}

fn first_contact(truth: &History) -> (String, &'static str) {
    let impact = truth.impacts.first().map(|impact| impact.state.time);
    let contact = truth.contact_starts.first().copied();
    match impact.into_iter().chain(contact).reduce(f64::min) {
        Some(0.0) => ("at the start".to_owned(), "starts on the retainer"),
        Some(time) => (format!("{}\u{a0}ms", ms(time)), "after the release"),
        None => ("none".to_owned(), "in this run"),
    }
}

fn fall_figure(outcome: &Outcome, matches: &Matches) -> Markup {
    let fall = matches.of_kind(EventKind::FreeFall).next();
    let first = outcome.truth.whole.phases.first();
    let levitated = first.is_some_and(|it| it.phase == PhaseKind::Levitated);
    let note = match fall.and_then(|fall| fall.detected) {
        None if levitated => "never declared".to_owned(),
        None => "no release in this run".to_owned(),
        Some(index) => match outcome.detection.events[index].confirmed_s {
            Some(time) => format!("confirmed at {}\u{a0}ms", ms(time)),
            None => "declared, never confirmed".to_owned(),
        },
    };
    figure("Free fall: latency", &latency(fall), note)
}

fn regime_figure(outcome: &Outcome, matches: &Matches) -> Markup {
    let kind = regime_event(outcome.truth.whole.regime);
    let regime = kind.and_then(|kind| matches.of_kind(kind).next());
    let note = match regime {
        Some(found) if found.detected.is_some() => "from the start of the last contact",
        Some(_) => "never declared",
        None => "no event names this regime",
    };
    figure("Regime: latency", &latency(regime), note)
}

fn latency(found: Option<&Match>) -> String {
    let latency = found.and_then(|found| found.latency_s);
    or_dash(latency, |time| format!("{}\u{a0}ms", ms(time)))
}
