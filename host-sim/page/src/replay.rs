//! The replay of a recording as one HTML page.

use maud::{Markup, html};

use crate::report::spectrum::spectra;
use crate::report::timeline::onsets;
use touchdown_chart::shell::page as in_style;
use touchdown_chart::table::table;
use touchdown_chart::text::{ms, si, significant};
use touchdown_chart::waveform::{Waveform, waveform};
use touchdown_run::replay::{Excerpt, Replay};
use touchdown_scene::Scene;

/// Writes the page; `drop` is the first drop, sample by sample.
pub fn page(name: &str, scene: &Scene, replay: &Replay, drop: Option<&Excerpt>) -> String {
    let detection = &replay.detection;
    let seconds = detection.summary.samples as f64 / replay.rate;
    let body = html! {
        p.kind { "Replay of a recording" }
        h1 { (name) }
        p { "Scene: " (scene.heading()) }
        @for warning in &replay.warnings { p.alarm { (warning) } }
        dl.figures {
            (figure("Samples", &detection.summary.samples.to_string()))
            (figure("Rate", &si(replay.rate, "Hz")))
            (figure("Length", &si(seconds, "s")))
            (figure("Events", &(detection.events.len() as u64 + detection.left_out).to_string()))
            (figure("Impacts of the last drop", &detection.severity.impacts.to_string()))
            (figure("Its hardest impact", &si(detection.severity.impact_speed_m_s, "m/s")))
            (figure("Unusable channel values", &detection.summary.faults.to_string()))
        }
        @if let Some(format) = &replay.format { p.note { (format) } }
        @if let Some(drop) = drop {
            section {
                h2 { "First drop" }
                @let span = [drop.start, drop.time(drop.positions.len())];
                (panels(span, scene, replay, |it| drop.points(it, 0.0)))
            }
        }
        section {
            h2 { "Whole recording" }
            (whole(scene, replay))
            p.note {
                "Least and greatest displacement of each " (replay.envelope.stride) " samples. Dashed: clearance. "
                "Strokes at the top: events; at the bottom: impacts."
            }
        }
        section {
            h2 { "Full spectrum" }
            (spectrum(scene, replay))
        }
        section {
            h2 { "Events" }
            (events(replay))
            @if detection.left_out > 0 {
                p.note { (detection.left_out) " further messages of the detector were counted, not kept." }
            }
        }
    };
    in_style(&format!("Replay of {name}"), &body).into_string()
}

fn figure(name: &str, value: &str) -> Markup {
    html! { div { dt { (name) } dd { (value) } } }
}

fn whole(scene: &Scene, replay: &Replay) -> Markup {
    let envelope = &replay.envelope;
    let stretch = envelope.stride as f64 / replay.rate;
    let end = replay.start + replay.detection.summary.samples as f64 / replay.rate;
    panels([replay.start, end], scene, replay, |channel| {
        let buckets = envelope.buckets().enumerate();
        let points = buckets.flat_map(|(index, bucket)| {
            let time = replay.start + (index as f64 + 0.5) * stretch;
            bucket[channel].map(|place| (time, place))
        });
        points.collect()
    })
}

/// A chart for each channel, through its `points`, s and m.
fn panels(
    span: [f64; 2],
    scene: &Scene,
    replay: &Replay,
    points: impl Fn(usize) -> Vec<(f64, f64)>,
) -> Markup {
    let [events, impacts] = [false, true].map(|it| onsets(&replay.detection, it));
    let panel = |channel: usize| {
        waveform(&Waveform {
            channel,
            span,
            time: "time, s",
            description: "Recorded displacement against time, dashed lines at the clearance, strokes at events.",
            clearance: scene.retainer.clearance,
            curves: &[("motion", points(channel))],
            strokes: [&events, &impacts],
        })
    };
    html! {
        @for channel in 0..2 * usize::from(replay.envelope.planes) { (panel(channel)) }
    }
}

/// Before and after the first drop's onset.
fn spectrum(scene: &Scene, replay: &Replay) -> Markup {
    let drop = replay.first_drop().map(|it| it.onset_s);
    let (begin, end) = (f64::NEG_INFINITY, f64::INFINITY);
    let parts = match drop {
        Some(onset) => vec![
            ("levitated", "before it", [begin, onset]),
            ("motion", "from the first drop on", [onset, end]),
        ],
        None => vec![("motion", "all of it", [begin, end])],
    };
    spectra(&replay.spectrogram, scene.rotor.spin, &parts, "time, s")
}

fn events(replay: &Replay) -> Markup {
    let events = &replay.detection.events;
    if events.is_empty() {
        return html! { p { "None." } };
    }
    table("Events", events)
        .words("Event", |it| {
            let fault = it
                .fault
                .map(|it| format!(" of {}: {}", it.channel, it.kind));
            <&str>::from(it.event).to_owned() + &fault.unwrap_or_default()
        })
        .number("Onset\ns", |it| format!("{:.6}", it.onset_s))
        .number("Declared\ns", |it| format!("{:.6}", it.declared_s))
        .number("Latency\nms", |it| ms(it.declared_s - it.onset_s))
        .words("Plane", |it| it.plane)
        .number("Speed\nmm/s", |it| {
            let speed = it.normal_speed_m_s.map(|it| significant(it * 1e3, 4));
            speed.unwrap_or_default()
        })
        .words("Fate", |it| match (it.confirmed_s, it.withdrawn_s) {
            (Some(time), _) => format!("confirmed at {time:.6} s"),
            (_, Some(time)) => format!("withdrawn at {time:.6} s"),
            _ => String::new(),
        })
        .draw()
}
