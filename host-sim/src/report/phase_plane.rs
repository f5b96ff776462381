//! Angular speed against angle while the rotor is at the wall.

use super::Subject;
use super::chart::{Axis, Chart, Pen};
use super::text::phase_class;
use crate::history::RotorState;
use crate::outcome::{Outcome, TracePoint};
use maud::{Markup, html};

/// Part of the clearance beyond which the rotor counts as near the wall.
const NEAR: f64 = 0.8;

const HEIGHT: f64 = 360.0;

/// Draws theta-dot against theta, theta from the bottom, counter-clockwise.
pub fn phase_plane(subject: &Subject, outcome: &Outcome) -> Markup {
    let fastest = outcome
        .trace
        .iter()
        .filter_map(|point| at_wall(&point.state, subject))
        .map(|(_, speed)| speed.abs())
        .fold(0.0, f64::max);
    if fastest == 0.0 {
        return html! { p.note { "The rotor did not move along the wall." } };
    }
    let (factor, unit) = if fastest > 1e4 {
        (1e-3, "krad/s")
    } else {
        (1.0, "rad/s")
    };
    let widest = outcome
        .trace
        .iter()
        .filter_map(|point| at_wall(&point.state, subject));
    let widest = widest.map(|(angle, _)| angle.abs()).fold(0.0, f64::max);
    let mut x = Axis::new(-180.0, 180.0, "\u{3b8} from the bottom, degrees", 8.0);
    x.step = 45.0;
    if widest < 80.0 {
        x = Axis::new(-90.0, 90.0, &x.label, 6.0);
        x.step = 30.0;
    }
    let reach = 1.08 * fastest * factor;
    let y = Axis::new(-reach, reach, &format!("d\u{3b8}/dt, {unit}"), 6.0);
    let chart = Chart {
        title: "Phase plane",
        description: "Angular speed against angle from the bottom while the rotor is at the wall, \
                      coloured by phase; inside the dashed curve the wall cannot hold the rotor.",
        x: &x,
        y: &y,
        height: HEIGHT,
    };
    let curves = html! {
        (contact_limit(subject, chart.pen(), factor))
        @for run in runs(&outcome.trace) { (curve(run, subject, chart.pen(), factor)) }
    };
    chart.draw(&html! {}, &curves, &html! {})
}

/// The stretches of one phase, each from the last point of the one before.
pub fn runs(trace: &[TracePoint]) -> impl Iterator<Item = &[TracePoint]> {
    let mut end = 0;
    trace.chunk_by(|a, b| a.phase == b.phase).map(move |run| {
        let start = end;
        end += run.len();
        &trace[usize::saturating_sub(start, 1)..end]
    })
}

/// Angle in degrees and its rate in rad/s, if the rotor is near the wall.
fn at_wall(state: &RotorState, subject: &Subject) -> Option<(f64, f64)> {
    let ([x, y], [vx, vy]) = (state.position, state.velocity);
    let radius = f64::hypot(x, y);
    let near = radius > NEAR * subject.clearance;
    near.then(|| {
        (
            x.atan2(-y).to_degrees(),
            (x * vy - y * vx) / (radius * radius),
        )
    })
}

/// Where the angle wraps, the curve runs out at one side and in at the other; where it turns too far
/// between two points to be followed, there are dots.
fn curve(run: &[TracePoint], subject: &Subject, mut pen: Pen<'_>, factor: f64) -> Markup {
    let mut last: Option<(f64, f64, f64)> = None;
    for point in run {
        let Some((angle, speed)) = at_wall(&point.state, subject) else {
            pen.lift();
            last = None;
            continue;
        };
        let (time, speed) = (point.state.time, speed * factor);
        let turned = |since: f64| (speed / factor * (time - since)).to_degrees();
        match last {
            Some((_, _, since)) if turned(since).abs() > 90.0 => pen.dot(angle, speed),
            Some((before, slower, _)) if (angle - before).abs() > 180.0 => {
                let turn = 360f64.copysign(before);
                pen.line_to(angle + turn, speed);
                pen.lift();
                pen.line_to(before - turn, slower);
                pen.line_to(angle, speed);
            }
            _ => pen.line_to(angle, speed),
        }
        last = Some((angle, speed, time));
    }
    pen.finish(phase_class(run[run.len() - 1].phase))
}

/// Where the wall's force vanishes: `theta-dot^2 = -(g/clearance) cos theta`.
fn contact_limit(subject: &Subject, mut pen: Pen<'_>, factor: f64) -> Markup {
    let pressing = subject.gravity / subject.clearance;
    for side in [-1.0, 1.0] {
        for half in [90..=180, -180..=-90] {
            pen.lift();
            for degrees in half {
                let angle = f64::from(degrees);
                let square = (-pressing * angle.to_radians().cos()).max(0.0);
                pen.line_to(angle, side * square.sqrt() * factor);
            }
        }
    }
    pen.finish("limit")
}
