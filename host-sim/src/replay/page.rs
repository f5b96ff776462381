//! The replay of a recording as one HTML page.

use maud::{Markup, html};
use touchdown_core::event::EventKind;

use super::{Excerpt, Replay};
use crate::names::event_name;
use crate::outcome::DetectedEvent;
use crate::report::chart::{Axis, Chart};
use crate::report::page as in_style;
use crate::report::tables::table;
use crate::report::text::{ms_or_dash, si, significant};
use crate::scene::Scene;

const HEIGHT: f64 = 150.0;
const MICRO: f64 = 1e6;
/// Strokes at events that a chart gets.
const STROKES: usize = 400;
const CHANNELS: [&str; 4] = ["plane a, x", "plane a, y", "plane b, x", "plane b, y"];

/// Writes the page; `drop` is the first drop, sample by sample.
pub fn page(name: &str, scene: &Scene, replay: &Replay, drop: Option<&Excerpt>) -> String {
    let detection = &replay.detection;
    let seconds = detection.samples as f64 / replay.rate;
    let body = html! {
        p.kind { "Replay of a recording" }
        h1 { (name) }
        p { "Scene: " (scene.heading()) }
        @for warning in &replay.warnings { p.alarm { (warning) } }
        dl.figures {
            (figure("Samples", &detection.samples.to_string()))
            (figure("Rate", &si(replay.rate, "Hz")))
            (figure("Length", &si(seconds, "s")))
            (figure("Events", &(detection.events.len() as u64 + detection.left_out).to_string()))
            (figure("Impacts of the last drop", &detection.severity.impacts.to_string()))
            (figure("Its hardest impact", &si(detection.severity.impact_speed_m_s, "m/s")))
            (figure("Unusable channel values", &detection.faults.to_string()))
        }
        @if let Some(format) = &replay.format { p.note { (format) } }
        @if let Some(drop) = drop {
            section {
                h2 { "First drop" }
                (close(drop, scene, replay))
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
    let end = replay.start + replay.detection.samples as f64 / replay.rate;
    let stretch = envelope.stride as f64 / replay.rate;
    html! {
        @for channel in 0..2 * usize::from(envelope.planes) {
            (panel(channel, [replay.start, end], scene, replay, |line| {
                for (index, bucket) in envelope.buckets().enumerate() {
                    let time = replay.start + (index as f64 + 0.5) * stretch;
                    line(time, bucket[channel][0]);
                    line(time, bucket[channel][1]);
                }
            }))
        }
    }
}

fn close(drop: &Excerpt, scene: &Scene, replay: &Replay) -> Markup {
    let end = drop.time(drop.positions.len());
    html! {
        @for channel in 0..2 * usize::from(replay.envelope.planes) {
            (panel(channel, [drop.start, end], scene, replay, |line| {
                for (index, positions) in drop.positions.iter().enumerate() {
                    line(drop.time(index), positions[channel]);
                }
            }))
        }
    }
}

/// A chart of one channel; `draw` hands out its points, s and m.
fn panel(
    channel: usize,
    [from, to]: [f64; 2],
    scene: &Scene,
    replay: &Replay,
    draw: impl Fn(&mut dyn FnMut(f64, f64)),
) -> Markup {
    let clearance = scene.retainer.clearance;
    let mut farthest = clearance;
    draw(&mut |_, place| {
        if place.abs() > farthest {
            farthest = place.abs();
        }
    });
    let x = Axis::new(from, to, "time, s", 6.0);
    let reach = 1.12 * farthest * MICRO;
    let y = Axis::new(
        -reach,
        reach,
        &format!("{}, \u{b5}m", CHANNELS[channel]),
        5.0,
    );
    let chart = Chart {
        title: CHANNELS[channel],
        description: "Recorded displacement against time, dashed lines at the clearance, strokes at events.",
        x: &x,
        y: &y,
        height: HEIGHT,
    };
    let mut motion = chart.pen();
    draw(&mut |time, place| motion.line_to(time, place * MICRO));
    let mut wall = chart.pen();
    for side in [-1.0, 1.0] {
        wall.lift();
        wall.line_to(x.lo, side * clearance * MICRO);
        wall.line_to(x.hi, side * clearance * MICRO);
    }
    let curves = html! { (wall.finish("wall")) (motion.finish("motion")) };
    let strokes = |impacts: bool| {
        let wanted = move |it: &&DetectedEvent| (it.event == EventKind::Impact) == impacts;
        let onsets = replay
            .detection
            .events
            .iter()
            .filter(wanted)
            .map(|it| it.onset_s);
        let shown = onsets.filter(|it| x.shows(*it)).take(STROKES);
        shown.map(|it| x.percent(it)).collect::<Vec<_>>()
    };
    let front = html! {
        @for at in strokes(false) { line.mark x1=(at) x2=(at) y1="0" y2=(HEIGHT) {} }
        @for at in strokes(true) { line.hit x1=(at) x2=(at) y1=(HEIGHT - 9.0) y2=(HEIGHT) {} }
    };
    chart.draw(&html! {}, &curves, &front)
}

fn events(replay: &Replay) -> Markup {
    let head = html! {
        th { "Event" }
        th.number { "Onset" br; "s" }
        th.number { "Declared" br; "s" }
        th.number { "Latency" br; "ms" }
        th { "Plane" }
        th.number { "Speed" br; "mm/s" }
        th { "Fate" }
    };
    let row = |event: &DetectedEvent| {
        let speed = event.normal_speed_m_s.map(|it| significant(it * 1e3, 4));
        let fault = event
            .fault
            .map(|it| format!(" of {}: {}", it.channel, it.kind.name()));
        let fate = match (event.confirmed_s, event.withdrawn_s) {
            (Some(time), _) => format!("confirmed at {time:.6} s"),
            (_, Some(time)) => format!("withdrawn at {time:.6} s"),
            _ => String::new(),
        };
        html! {
            td { (event_name(event.event)) (fault.unwrap_or_default()) }
            td.number { (format!("{:.6}", event.onset_s)) }
            td.number { (format!("{:.6}", event.declared_s)) }
            td.number { (ms_or_dash(Some(event.declared_s - event.onset_s))) }
            td { (event.plane) }
            td.number { (speed.unwrap_or_default()) }
            td { (fate) }
        }
    };
    let events = &replay.detection.events;
    if events.is_empty() {
        return html! { p { "None." } };
    }
    table("Events", &head, events.iter().map(row))
}
