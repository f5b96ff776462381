//! Displacement x and y against time.

use super::timeline::{onsets, strokes, visible};
use super::window::{Window, far};
use maud::{Markup, html};
use touchdown_chart::plot::{Axis, Chart, key, percent};
use touchdown_chart::waveform::displacement_axis;
use touchdown_run::outcome::{Outcome, TracePoint};
use touchdown_scene::Scene;

const HEIGHT: f64 = 190.0;

/// Draws both axes for a stretch of time.
pub fn displacement(window: Window, scene: &Scene, outcome: &Outcome) -> Markup {
    html! {
        (panel(0, window, scene, outcome))
        (panel(1, window, scene, outcome))
        ul.legend {
            (key("motion", "true motion"))
            li { svg width="34" height="12" aria-hidden="true" { path.curve.sensed d="M4 8h0M11 4h0M18 7h0M25 5h0M31 8h0" {} } "sensed" }
            li { svg width="34" height="12" aria-hidden="true" { line.true-mark x1="17" x2="17" y1="0" y2="12" {} } "true change" }
            li { svg width="34" height="12" aria-hidden="true" { line.mark x1="17" x2="17" y1="0" y2="12" {} } "detected onset" }
            li { "short strokes: impacts, true at the top, detected at the bottom" }
        }
    }
}

fn panel(axis: usize, window: Window, scene: &Scene, outcome: &Outcome) -> Markup {
    // A ring that moves lets the rotor beyond its clearance.
    let farthest = shown(&outcome.trace, window)
        .iter()
        .map(|point| point.state.position[axis].abs())
        .filter(|place| place.is_finite())
        .fold(scene.retainer.clearance, f64::max);
    let chart = Chart {
        title: ["Displacement x against time", "Displacement y against time"][axis],
        description: "True motion as a line over bands in the colour of the true phase, sensed values \
                      as dots, dashed lines at the clearance, upright lines at changes.",
        x: &window.axis(),
        y: &displacement_axis(["x (right)", "y (up)"][axis], farthest),
        height: HEIGHT,
    };
    let mut motion = chart.pen();
    let mut sensed = chart.pen();
    let mut last: Option<&TracePoint> = None;
    for point in shown(&outcome.trace, window) {
        let (time, position) = (point.state.time, point.state.position[axis]);
        match last {
            Some(from) if far(from, point, scene.retainer.clearance) => motion.dot(time, position),
            _ => motion.line_to(time, position),
        }
        last = Some(point);
        if let Some(position) = point.sensed {
            sensed.dot(time, position[axis]);
        }
    }
    let curves = html! {
        (chart.walls(scene.retainer.clearance))
        (sensed.finish("sensed"))
        (motion.finish("motion"))
    };
    chart.draw(&bands(outcome, chart.x), &curves, &marks(outcome, chart.x))
}

/// The points of the trace within a stretch of time, and one more at either end.
fn shown(trace: &[TracePoint], window: Window) -> &[TracePoint] {
    let first = trace.partition_point(|point| point.state.time < window.start);
    let end = trace.partition_point(|point| point.state.time <= window.end);
    &trace[first.saturating_sub(1)..(end + 1).min(trace.len())]
}

fn bands(outcome: &Outcome, x: &Axis) -> Markup {
    html! {
        @for (phase, from, to) in visible(&outcome.truth.whole.phases, x) {
            rect class={ "band " (<&str>::from(phase)) } x=(percent(from)) width=(percent(to - from))
                y="0" height=(HEIGHT) {}
        }
    }
}

fn marks(outcome: &Outcome, x: &Axis) -> Markup {
    let onsets = |impacts| onsets(&outcome.detection, impacts);
    let truth = &outcome.truth.whole;
    let changes: Vec<f64> = truth.phases.iter().map(|it| it.start_s).collect();
    let hits: Vec<f64> = truth.impacts.iter().map(|it| it.state.time).collect();
    html! {
        @for at in strokes(&changes, x) { line.true-mark x1=(at) x2=(at) y1="0" y2=(HEIGHT) {} }
        @for at in strokes(&onsets(false), x) { line.mark x1=(at) x2=(at) y1="0" y2=(HEIGHT) {} }
        @for at in strokes(&hits, x) { line.hit x1=(at) x2=(at) y1="0" y2="9" {} }
        @for at in strokes(&onsets(true), x) { line.hit x1=(at) x2=(at) y1=(HEIGHT - 9.0) y2=(HEIGHT) {} }
    }
}
