//! One self-contained HTML page for a drop: nothing loaded from outside, complete without its script, which adds a
//! cursor and a zoom to the charts.

mod accuracy;
mod controller;
mod displacement;
mod energy;
pub mod force;
mod foresight;
mod health;
mod moving;
pub mod orbit;
mod parameters;
mod phase;
mod phase_plane;
pub mod regions;
mod severity;
pub(crate) mod spectrum;
mod stretch;
pub mod tables;
mod timeline;
mod verdict;
pub mod window;

#[cfg(test)]
mod fixture;
#[cfg(test)]
mod tests;

use maud::{Markup, html};
use spectrum::Spectra;
use touchdown_base::machine::Machine;
use touchdown_chart::shell::page;
use touchdown_run::fidelity::force::Press;
use touchdown_run::matching::match_events;
use touchdown_run::outcome::Outcome;
use touchdown_scene::parts::Part;
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
    /// Rings of a rotor that tilts; else none.
    pub rings: Vec<RingSubject>,
    /// Speed of a ball bearing's cage over that of its inner ring.
    pub cage_ratio: Option<f64>,
    /// Of the machine, in and out.
    pub parts: Vec<Part>,
    /// How far a rigid rotor can be trusted.
    pub validity: Option<String>,
    /// How the contact presses, where the scene gives the materials.
    pub press: Option<Press>,
    /// Component and version.
    pub versions: Vec<(String, String)>,
}

/// A ring of a rotor that tilts; SI.
#[derive(Clone, Debug, PartialEq)]
pub struct RingSubject {
    /// For people.
    pub name: String,
    /// Radial, m.
    pub clearance: f64,
    /// From the centre of mass, m.
    pub place: f64,
    /// Of the normal speed, 0 to 1.
    pub restitution: f64,
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
    let (ring_moves, _) = moving::ring_moves(outcome);
    let body = html! {
        (verdict::verdict(subject, outcome, &matches))
        section {
            h2 { "Timeline" }
            (timeline::legend())
            @if zoomed {
                h3 { "First part" }
                (timeline::timeline("Timeline, first part", window, subject, outcome))
                h3 { "Whole run" }
            }
            (timeline::timeline("Timeline, whole run", whole, subject, outcome))
            p.note { "Short strokes in the bars are impacts. Labels below the bars stand at the time of declaration." }
        }
        div.pair {
            section {
                @if ring_moves {
                    h2 { "Orbit in the retainer ring" }
                    (moving::in_ring(subject, outcome))
                } @else {
                    h2 { "Orbit" }
                    (orbit::orbit(subject.machine.clearance, subject.spin, outcome))
                }
                p.note {
                    @if ring_moves { "The rotor as seen from the ring, which moves. " }
                    @else if !outcome.rings.is_empty() { "The centre of mass; its ends are below. " }
                    @else { "Rings: impacts. " }
                    "True motion over the whole run, in the colours of the timeline. Outer circle: clearance. Here and below, dots stand alone where the points of the trace are too far apart to be joined."
                }
            }
            section {
                h2 { "Phase plane at the wall" }
                (phase_plane::phase_plane(subject, outcome))
                p.note { "True motion where the rotor is beyond 80 % of the clearance. Inside a dashed curve the wall cannot hold the rotor: contact ends there. Shaded, where a full turn is shown and the spin is fast: contact is kept for ever in whirl (orange) or in a swing (green), as in Fig. 3 of the source paper." }
            }
        }
        (parts_that_move(whole, subject, outcome))
        section { h2 { "Contact force" } (force::force(window, subject, outcome)) }
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
        section {
            h2 { "Full spectrum" }
            (spectra(whole, subject, outcome))
        }
        section { h2 { "Detector" } (tables::events(outcome, &matches)) }
        section { h2 { "Controller" } (controller::controller(outcome)) }
        section { h2 { "Forecast of whirl" } (foresight::forecasts(outcome)) }
        section { h2 { "Impacts" } (tables::impacts(subject, outcome, &matches)) }
        section { h2 { "Severity" } (severity::severity(outcome)) }
        section { h2 { "Sensors" } (health::health(outcome)) }
        section { h2 { "Model against reference" } (accuracy::accuracy(subject, outcome)) }
        @if let Some(ledger) = &outcome.ledger {
            section { h2 { "Energy" } (energy::energy(ledger)) }
        }
        section { h2 { "Parameters" } (parameters::parameters(subject)) }
        section { h2 { "Not modelled" } (parameters::limits(subject, outcome.model.has_forces())) }
        section { h2 { "Versions" } (parameters::versions(subject)) }
    };
    let title = format!("{} \u{2013} touchdown report", subject.title);
    page(&title, &body).into_string()
}

fn spectra(whole: Window, subject: &Subject, outcome: &Outcome) -> Markup {
    spectrum::spectra(&Spectra {
        found: &outcome.spectrogram,
        spin: subject.spin,
        parts: vec![
            ("levitated", "before it", [f64::NEG_INFINITY, 0.0]),
            ("motion", "after the release", [0.0, whole.end]),
        ],
        time: "time since release, s",
    })
}

/// Ends, ring and inner ring, where they are there.
fn parts_that_move(whole: Window, subject: &Subject, outcome: &Outcome) -> Markup {
    let (ring, race) = moving::ring_moves(outcome);
    html! {
        @if !subject.rings.is_empty() { (moving::ends(subject, outcome)) }
        @if ring {
            section {
                h2 { "Retainer ring" }
                (moving::ring(whole, outcome))
            }
        }
        @if let (true, Some(cage)) = (race, subject.cage_ratio) {
            section {
                h2 { "Ball bearing" }
                (moving::speeds(cage, whole, outcome))
            }
        }
    }
}
