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
use touchdown_chart::shell::page;
use touchdown_run::matching::match_events;
use touchdown_run::outcome::Outcome;
use touchdown_run::timebase::Timebase;
use touchdown_scene::Scene;
use window::Window;

/// Writes the page.
pub fn render(scene: &Scene, outcome: &Outcome) -> String {
    let truth = &outcome.truth.whole;
    let matches = match_events(truth, &outcome.detection);
    let whole = Window::whole(truth);
    let window = Window::interesting(truth, scene.retainer.clearance, scene.run.gravity);
    let zoomed = window != whole;
    let (ring_moves, _) = moving::ring_moves(outcome);
    let body = html! {
        (verdict::verdict(scene, outcome, &matches))
        section {
            h2 { "Timeline" }
            (timeline::legend())
            @if zoomed {
                h3 { "First part" }
                (timeline::timeline("Timeline, first part", window, scene, outcome))
                h3 { "Whole run" }
            }
            (timeline::timeline("Timeline, whole run", whole, scene, outcome))
            p.note { "Short strokes in the bars are impacts. Labels below the bars stand at the time of declaration." }
        }
        div.pair {
            section {
                @if ring_moves {
                    h2 { "Orbit in the retainer ring" }
                    (moving::in_ring(scene, outcome))
                } @else {
                    h2 { "Orbit" }
                    (orbit::orbit(scene.retainer.clearance, scene.rotor.spin, outcome))
                }
                p.note {
                    @if ring_moves { "The rotor as seen from the ring, which moves. " }
                    @else if !outcome.truth.rings.is_empty() { "The centre of mass; its ends are below. " }
                    @else { "Rings: impacts. " }
                    "True motion over the whole run, in the colours of the timeline. Outer circle: clearance. Here and below, dots stand alone where the points of the trace are too far apart to be joined."
                }
            }
            section {
                h2 { "Phase plane at the wall" }
                (phase_plane::phase_plane(scene, outcome))
                p.note { "True motion where the rotor is beyond 80 % of the clearance. Inside a dashed curve the wall cannot hold the rotor: contact ends there. Shaded, where a full turn is shown and the spin is fast: contact is kept for ever in whirl (orange) or in a swing (green), as in Fig. 3 of the source paper." }
            }
        }
        (parts_that_move(whole, scene, outcome))
        section { h2 { "Contact force" } (force::force(window, scene, outcome)) }
        section {
            h2 { "Displacement" }
            (displacement::displacement(window, scene, outcome))
            @if zoomed {
                details {
                    summary { "Displacement over the whole run" }
                    (displacement::displacement(whole, scene, outcome))
                }
            }
        }
        section {
            h2 { "Full spectrum" }
            (spectra(whole, scene, outcome))
        }
        section { h2 { "Detector" } (tables::events(outcome, &matches)) }
        section { h2 { "Controller" } (controller::controller(&outcome.conduct, Timebase::of(scene))) }
        section { h2 { "Forecast of whirl" } (foresight::forecasts(outcome)) }
        section { h2 { "Impacts" } (tables::impacts(scene, outcome, &matches)) }
        section { h2 { "Severity" } (severity::severity(outcome)) }
        section { h2 { "Sensors" } (health::health(outcome)) }
        section { h2 { "Accuracy of the model" } (accuracy::accuracy(scene, outcome)) }
        @if let Some(ledger) = &outcome.model.ledger {
            section { h2 { "Energy" } (energy::energy(ledger)) }
        }
        section { h2 { "Parameters" } (parameters::parameters(scene)) }
        section { h2 { "Not modelled" } (parameters::limits(scene, outcome.model.histories.whole.has_forces())) }
        section { h2 { "Versions" } (parameters::versions()) }
    };
    let title = format!("{} \u{2013} touchdown report", scene.heading());
    page(&title, &body).into_string()
}

fn spectra(whole: Window, scene: &Scene, outcome: &Outcome) -> Markup {
    spectrum::spectra(&Spectra {
        found: &outcome.spectrogram,
        spin: scene.rotor.spin,
        parts: vec![
            ("levitated", "before it", [f64::NEG_INFINITY, 0.0]),
            ("motion", "after the release", [0.0, whole.end]),
        ],
        time: "time since release, s",
    })
}

/// Ends, ring and inner ring, where they are there.
fn parts_that_move(whole: Window, scene: &Scene, outcome: &Outcome) -> Markup {
    let (ring, race) = moving::ring_moves(outcome);
    html! {
        @if !scene.rings().is_empty() { (moving::ends(scene, outcome)) }
        @if ring {
            section {
                h2 { "Retainer ring" }
                (moving::ring(whole, outcome))
            }
        }
        @if let (true, Some(bearing)) = (race, &scene.ball_bearing) {
            section {
                h2 { "Ball bearing" }
                (moving::speeds(bearing.race.cage_ratio, whole, outcome))
            }
        }
    }
}
