//! Phases over time: the truth above, the detector below.

use super::window::Window;
use maud::{Markup, html};
use strum::VariantArray;
use touchdown_base::history::{History, Phase, PhaseKind};
use touchdown_chart::plot::{Axis, columns, key, percent};
use touchdown_core::event::EventKind;
use touchdown_run::outcome::{DetectedEvent, Detection, Outcome};
use touchdown_scene::Scene;
use touchdown_scene::names::phase_name;

const BAR: f64 = 24.0;
const ROW: f64 = 52.0;
const LANE: f64 = 16.0;
const LANES: usize = 5;

/// Width of the smallest plot area that labels must fit into, px.
const NARROW: f64 = 330.0;

/// Part of the width from which labels stand left of their lines.
const LEFT_FROM: f64 = 0.6;

/// Advance of a label's letter, px.
const LETTER: f64 = 6.4;

/// Draws the strip for a stretch of time.
pub fn timeline(title: &str, window: Window, scene: &Scene, outcome: &Outcome) -> Markup {
    let x = window.axis();
    let events = &outcome.detection.events;
    let seen_row = |name: &str, time: fn(&DetectedEvent) -> f64| {
        let phases = detected_phases(&outcome.detection, window.end, time);
        let impacts = events.iter().filter(|it| it.event == EventKind::Impact);
        (name.to_owned(), phases, impacts.map(time).collect())
    };
    let whose = ["Truth (model)", "Truth (reference)"][usize::from(outcome.by_reference)];
    let true_row = |name: String, truth: &'_ History| {
        let hits = truth.impacts.iter().map(|it| it.state.time);
        (name, truth.phases.clone(), hits.collect())
    };
    let rings = scene.rings().iter().zip(&outcome.truth.rings);
    let mut rows: Vec<(String, Vec<Phase>, Vec<f64>)> =
        vec![true_row(whose.to_owned(), &outcome.truth.whole)];
    rows.extend(rings.map(|(ring, truth)| true_row(format!("Truth, ring {}", ring.name), truth)));
    rows.push(seen_row("Detector, by estimated onset", |it| it.onset_s));
    let declared = seen_row("Detector, as declared at the time", |it| it.declared_s);
    rows.push(declared);
    let (labels, lanes) = labels(events, &x);
    let bars = rows.len() as f64 * ROW;
    let height = bars + lanes as f64 * LANE + 8.0;
    html! {
        div.chart data-x=(x.range()) data-height=(height) {
            svg role="img" width="100%" height=(height + 40.0) {
                title { (title) }
                desc {
                    "Coloured bars over time: true phases above, the detector's phases below, as "
                    "estimated and as known at the time; short strokes are impacts."
                }
                (columns(&x, height))
                @for (number, (name, phases, hits)) in rows.iter().enumerate() {
                    @let top = number as f64 * ROW + 20.0;
                    text.row x="0" y=(top - 6.0) { (name) }
                    (bar(phases, hits, &x, top))
                }
                @for label in &labels { (label.line(bars)) }
                @for label in &labels { (label.text(bars)) }
            }
        }
    }
}

/// Colours and line styles of the phases.
pub fn legend() -> Markup {
    html! {
        ul.legend {
            @for phase in PhaseKind::VARIANTS { (key(phase.into(), phase_name(*phase))) }
        }
    }
}

fn bar(phases: &[Phase], hits: &[f64], x: &Axis, top: f64) -> Markup {
    html! {
        rect.void x="0" y=(top) width="100%" height=(BAR) {}
        @for (phase, from, to) in visible(phases, x) {
            rect class={ "bar " (<&str>::from(phase)) }
                x=(percent(from)) width=(percent(to - from)) y=(top) height=(BAR) {}
            @if (to - from) * NARROW > phase_name(phase).len() as f64 * LETTER + 4.0 {
                text class={ "name " (<&str>::from(phase)) } x=(percent((from + to) / 2.0))
                    y=(top + BAR - 7.5) text-anchor="middle" { (phase_name(phase)) }
            }
        }
        @for at in strokes(hits, x) {
            line.hit x1=(at) x2=(at) y1=(top) y2=(top + 6.0) {}
        }
    }
}

/// Phases on the axis with their ends as fractions of it; of phases too short to be seen, as many as fit.
pub fn visible(phases: &[Phase], x: &Axis) -> Vec<(PhaseKind, f64, f64)> {
    const NARROWEST: f64 = 5e-4;
    let mut shown: Vec<(PhaseKind, f64, f64)> = Vec::new();
    for phase in phases {
        let drawn = shown.last().map_or(0.0, |last| last.2);
        let from = x.fraction(phase.start_s).max(drawn);
        let to = x.fraction(phase.end_s).min(1.0);
        if to > drawn && from < 1.0 {
            shown.push((phase.phase, from, to.max(from + NARROWEST)));
        }
    }
    shown
}

/// Estimated onsets of the declared impacts, or of all other events, s.
pub fn onsets(detection: &Detection, impacts: bool) -> Vec<f64> {
    let events = detection.events.iter();
    let wanted = events.filter(|it| (it.event == EventKind::Impact) == impacts);
    wanted.map(|it| it.onset_s).collect()
}

/// Positions of the visible times, without those that fall on the one before.
pub fn strokes(times: &[f64], x: &Axis) -> Vec<String> {
    let shown = times.iter().filter(|time| x.shows(**time));
    let places = shown.map(|time| format!("{:.1}%", 100.0 * x.fraction(*time)));
    let mut places: Vec<String> = places.collect();
    places.dedup();
    places
}

/// The detector's view as phases, each event taking effect at the time that `time` gives.
fn detected_phases(detection: &Detection, end: f64, time: fn(&DetectedEvent) -> f64) -> Vec<Phase> {
    let mut changes: Vec<(f64, PhaseKind)> = Vec::new();
    for event in &detection.events {
        let phase = match event.event {
            EventKind::Levitated => PhaseKind::Levitated,
            EventKind::FreeFall | EventKind::LiftOff => PhaseKind::FreeFall,
            EventKind::Impact => PhaseKind::Impact,
            EventKind::Sliding => PhaseKind::Sliding,
            EventKind::Rolling => PhaseKind::Rolling,
            _ => continue,
        };
        changes.push((time(event), phase));
        changes.extend(event.withdrawn_s.map(|at| (at, PhaseKind::Levitated)));
    }
    changes.sort_by(|a, b| a.0.total_cmp(&b.0));
    changes.dedup_by_key(|it| it.1);
    let ends = changes.iter().skip(1).map(|it| Some(it.0)).chain([None]);
    let phase = |(&(start_s, phase), next): (&_, Option<f64>)| Phase {
        phase,
        start_s,
        end_s: next.unwrap_or(end.max(start_s)),
    };
    changes.iter().zip(ends).map(phase).collect()
}

/// A declared event, drawn below the bars.
struct Label {
    at: f64,
    lane: usize,
    text: String,
}

impl Label {
    fn foot(&self, bars: f64) -> f64 {
        bars + self.lane as f64 * LANE + 14.0
    }

    fn line(&self, bars: f64) -> Markup {
        let x = percent(self.at);
        html! { line.mark x1=(x) x2=(x) y1=(bars - ROW + 20.0) y2=(self.foot(bars)) {} }
    }

    fn text(&self, bars: f64) -> Markup {
        let (anchor, dx) = match self.at > LEFT_FROM {
            true => ("end", "-5"),
            false => ("start", "5"),
        };
        html! {
            text.label x=(percent(self.at)) y=(self.foot(bars)) dx=(dx) text-anchor=(anchor) { (self.text) }
        }
    }

    /// Left and right end as fractions of the narrowest chart.
    fn extent(&self) -> (f64, f64) {
        let width = (self.text.chars().count() as f64 * LETTER + 10.0) / NARROW;
        match self.at > LEFT_FROM {
            true => (self.at - width, self.at),
            false => (self.at, self.at + width),
        }
    }
}

/// Labels of the declared events other than impacts, in lanes so that none covers another; what finds
/// no lane is left to the table.
fn labels(events: &[DetectedEvent], x: &Axis) -> (Vec<Label>, usize) {
    let mut labels: Vec<Label> = Vec::new();
    for event in events.iter().filter(|it| it.event != EventKind::Impact) {
        let name = <&str>::from(event.event);
        let fates = [
            (Some(event.declared_s), name.to_owned()),
            (event.confirmed_s, format!("{name} confirmed")),
            (event.withdrawn_s, format!("{name} withdrawn")),
        ];
        for (time, text) in fates {
            let Some(time) = time.filter(|time| x.shows(*time)) else {
                continue;
            };
            let mut label = Label {
                at: x.fraction(time),
                lane: 0,
                text,
            };
            let (from, to) = label.extent();
            let apart = |it: &Label| to < it.extent().0 || from > it.extent().1;
            let free = |lane: &usize| labels.iter().all(|it| it.lane != *lane || apart(it));
            if let Some(lane) = (0..LANES).find(free) {
                label.lane = lane;
                labels.push(label);
            }
        }
    }
    let lanes = labels.iter().map(|label| label.lane + 1).max().unwrap_or(0);
    (labels, lanes)
}
