//! Two recordings as one HTML page.

use maud::{Markup, html};

use touchdown_chart::plot::key;
use touchdown_chart::shell::page as in_style;
use touchdown_chart::table::table;
use touchdown_chart::text::{or_dash, significant};
use touchdown_chart::waveform::{Waveform, waveform};
use touchdown_run::compare::Comparison;
use touchdown_run::compare::table::verdict;
use touchdown_run::replay::Excerpt;
use touchdown_scene::Scene;

/// Writes the page.
pub fn page(scene: &Scene, comparison: &Comparison) -> String {
    let ([a, b], aligned) = (&comparison.files, &comparison.aligned);
    let [first, second] = comparison.regimes.map(|it| it.map_or("none", <&str>::from));
    let body = html! {
        p.kind { "Two recordings" }
        h1 { (a) " and " (b) }
        p { "Scene: " (scene.heading()) }
        p class=(if comparison.beyond > 0 { "verdict alarm" } else { "verdict" }) {
            (verdict(comparison)) ". Regime: " (first) ", " (second) "."
        }
        @for warning in &comparison.warnings { p.alarm { (warning) } }
        @if let Some(excerpts) = &comparison.excerpts {
            section {
                h2 { "First drop" }
                @for channel in 0..aligned.waveform_rms_m.len() { (panel(channel, excerpts, scene, aligned.shift_s)) }
                ul.legend {
                    (key("motion", a))
                    (key("sensed", &format!("{b}, shifted by {:.6}\u{a0}s", -aligned.shift_s)))
                }
            }
        }
        section {
            h2 { "Events" }
            (events(comparison))
            p.note { "Onsets, each on its own clock; differences after alignment. Impacts below 20 mm/s are not judged." }
        }
    };
    in_style(&format!("{a} and {b}"), &body).into_string()
}

fn panel(channel: usize, [a, b]: &[Excerpt; 2], scene: &Scene, shift: f64) -> Markup {
    waveform(&Waveform {
        channel,
        span: [a.start, a.time(a.positions.len())],
        time: "time of the first, s",
        description: "Displacement of both recordings against time, the second shifted onto the first; \
                      dashed lines at the clearance.",
        clearance: scene.retainer.clearance,
        curves: &[
            ("sensed", b.points(channel, -shift)),
            ("motion", a.points(channel, 0.0)),
        ],
        strokes: [&[], &[]],
    })
}

fn events(comparison: &Comparison) -> Markup {
    let text = |value, scale, digits| or_dash(value, |it| significant(it * scale, digits));
    if comparison.events.is_empty() {
        return html! { p { "None." } };
    }
    table("Events", &comparison.events)
        .words("Event", |it| <&str>::from(it.event))
        .number("First\ns", |it| text(it.a_s, 1.0, 7))
        .number("Second\ns", |it| text(it.b_s, 1.0, 7))
        .number("Difference\nms", |it| text(it.difference_s, 1e3, 4))
        .number("First\nmm/s", |it| text(it.a_speed_m_s, 1e3, 4))
        .number("Second\nmm/s", |it| text(it.b_speed_m_s, 1e3, 4))
        .number("Difference\n%", |it| text(it.speed_difference, 100.0, 3))
        .marked("Within", |it| match it.within {
            Some(true) => ("", "yes"),
            Some(false) => ("missed", "no"),
            None => ("", "not judged"),
        })
        .draw()
}
