//! One self-contained HTML page for a drop: no script, nothing loaded from outside.

mod accuracy;
pub(crate) mod chart;
mod displacement;
pub(crate) mod orbit;
mod parameters;
mod phase_plane;
pub(crate) mod regions;
mod stretch;
pub(crate) mod tables;
pub(crate) mod text;
mod timeline;
mod verdict;
pub mod window;

#[cfg(test)]
mod fixture;
#[cfg(test)]
mod tests;

use crate::matching::match_events;
use crate::outcome::Outcome;
use crate::reference::Machine;
use maud::{DOCTYPE, Markup, PreEscaped, html};
use window::Window;

/// What was dropped and how; SI.
#[derive(Clone, Debug, PartialEq)]
pub struct Subject {
    /// Heading.
    pub title: String,
    /// Where the scene comes from.
    pub source: String,
    /// Rotor and retainer.
    pub machine: Machine,
    /// At the release, counter-clockwise positive, rad/s.
    pub spin: f64,
    /// From the release, s.
    pub duration: f64,
    /// Of the sensors, Hz.
    pub sample_rate: f64,
    /// Number type of the model, `f64` or `f32`.
    pub precision: String,
    /// Output interval of the model, s.
    pub step: f64,
    /// Of the sensors' noise.
    pub seed: u64,
    /// Of a sensor, standard deviation, m.
    pub noise: f64,
    /// Component and version.
    pub versions: Vec<(String, String)>,
}

/// Writes the page.
pub fn render(subject: &Subject, outcome: &Outcome) -> String {
    let matches = match_events(&outcome.truth, &outcome.detection);
    let whole = Window::whole(&outcome.truth);
    let window = Window::interesting(
        &outcome.truth,
        subject.machine.clearance,
        subject.machine.gravity,
    );
    let zoomed = window != whole;
    let body = html! {
        (verdict::verdict(subject, outcome, &matches))
        section {
            h2 { "Timeline" }
            (timeline::legend())
            @if zoomed {
                h3 { "First part" }
                (timeline::timeline("Timeline, first part", window, outcome))
                h3 { "Whole run" }
            }
            (timeline::timeline("Timeline, whole run", whole, outcome))
            p.note { "Short strokes in the bars are impacts. Labels below the bars stand at the time of declaration." }
        }
        div.pair {
            section {
                h2 { "Orbit" }
                (orbit::orbit(subject.machine.clearance, subject.spin, outcome))
                p.note { "True motion over the whole run, in the colours of the timeline. Outer circle: clearance. Rings: impacts. Here and below, dots stand alone where the points of the trace are too far apart to be joined." }
            }
            section {
                h2 { "Phase plane at the wall" }
                (phase_plane::phase_plane(subject, outcome))
                p.note { "True motion where the rotor is beyond 80 % of the clearance. Inside a dashed curve the wall cannot hold the rotor: contact ends there. Shaded, where a full turn is shown and the spin is fast: contact is kept for ever in whirl (orange) or in a swing (green), as in Fig. 3 of the source paper." }
            }
        }
        section {
            h2 { "Displacement" }
            (displacement::displacement(window, subject, outcome))
            @if zoomed {
                details {
                    summary { "Displacement over the whole run" }
                    (displacement::displacement(whole, subject, outcome))
                }
            }
        }
        section { h2 { "Detector" } (tables::events(outcome, &matches)) }
        section { h2 { "Impacts" } (tables::impacts(subject, outcome, &matches)) }
        section { h2 { "Model against reference" } (accuracy::accuracy(subject, outcome)) }
        section { h2 { "Parameters" } (parameters::parameters(subject)) }
        section { h2 { "Not modelled" } (parameters::limits(outcome.model.has_forces())) }
        section { h2 { "Versions" } (parameters::versions(subject)) }
    };
    let title = format!("{} \u{2013} touchdown report", subject.title);
    page(&title, &body).into_string()
}

/// A page in the report's style.
pub(crate) fn page(title: &str, body: &Markup) -> Markup {
    html! {
        (DOCTYPE)
        html lang="en" {
            head {
                meta charset="utf-8";
                meta name="viewport" content="width=device-width, initial-scale=1";
                meta name="color-scheme" content="light dark";
                title { (title) }
                style { (PreEscaped(include_str!("style.css"))) }
            }
            body { main { (body) } }
        }
    }
}
