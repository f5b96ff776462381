//! The path of the rotor's centre inside the clearance circle.

use super::window::{far, runs};
use maud::{Markup, html};
use std::f64::consts::{FRAC_PI_2, PI, TAU};
use std::fmt::Write;
use touchdown_base::history::{Impact, PhaseKind};
use touchdown_chart::plot::{Axis, coordinate};
use touchdown_chart::text::significant;
use touchdown_run::outcome::{Outcome, TracePoint};

/// Radius of the clearance circle in drawing units; the drawing is 488 of them wide.
const RADIUS: f64 = 180.0;

/// Of the clearance: half the width of the drawn circle.
const AT_WALL: f64 = 0.02;

/// Draws the rotor's whole run; clearance in m, spin in rad/s.
pub fn orbit(clearance: f64, spin: f64, outcome: &Outcome) -> Markup {
    // A rotor that tilts hits with its ends.
    let own = outcome.truth.rings.is_empty();
    let impacts = &outcome.truth.whole.impacts[..];
    let hits = if own { impacts } else { &[] };
    draw("Orbit", clearance, spin, &outcome.trace, hits)
}

/// Draws a path with equal axes in a gap, m, and where impacts were; spin in rad/s.
pub fn draw(
    title: &str,
    clearance: f64,
    spin: f64,
    trace: &[TracePoint],
    impacts: &[Impact],
) -> Markup {
    let scale = RADIUS / clearance;
    let micro = 1.25 * clearance * 1e6;
    let axis = Axis::new(-micro, micro, "\u{b5}m", 6.0);
    let place = |value: f64| coordinate(value * 1e-6 * scale);
    html! {
        svg.orbit role="img" viewBox="-252 -226 488 472" {
            title { (title) }
            desc {
                "Path of the rotor's centre with equal axes, coloured by phase, inside the clearance "
                "circle; rings mark impacts, the outer arrow the direction of spin."
            }
            @for (value, text) in axis.ticks() {
                line.grid x1=(place(value)) x2=(place(value)) y1="-205" y2="205" {}
                line.grid y1=(place(value)) y2=(place(value)) x1="-205" x2="205" {}
                text.tick x=(place(value)) y="220" text-anchor="middle" { (text) }
                text.tick x="-208" y=(place(-value)) dy="4" text-anchor="end" { (text) }
            }
            text.unit x="0" y="238" text-anchor="middle" { "x (right) and y (up), \u{b5}m" }
            circle.clearance r=(RADIUS) {}
            @for run in runs(trace) {
                path class={ "curve " (<&str>::from(run[run.len() - 1].phase)) } d=(path(run, clearance, scale)) {}
            }
            @for (x, y) in hits(impacts, scale) {
                circle.hit cx=(coordinate(x)) cy=(coordinate(y)) r="3.5" {}
            }
            (spin_arrow(spin))
        }
    }
}

/// In drawing units.
fn place([x, y]: [f64; 2], scale: f64) -> (f64, f64) {
    (x * scale, -y * scale)
}

/// In contact the points are joined by arcs, so that a whirl with few points a turn is still round.
fn path(run: &[TracePoint], clearance: f64, scale: f64) -> String {
    let mut path = String::new();
    let mut last: Option<((f64, f64), &TracePoint)> = None;
    for point in run {
        let to = place(point.state.position, scale);
        if !(to.0.is_finite() && to.1.is_finite()) {
            continue;
        }
        let (x, y) = (coordinate(to.0), coordinate(to.1));
        let _ = match last {
            None => write!(path, "M{x} {y}"),
            Some((from, _)) if f64::hypot(to.0 - from.0, to.1 - from.1) < 0.4 => {
                last = Some((from, point));
                continue;
            }
            Some((_, from)) if along_wall(from, point, clearance) => {
                let turn = turn(from, point);
                let (large, sweep) = (u8::from(turn.abs() > PI), u8::from(turn < 0.0));
                write!(path, "A{RADIUS} {RADIUS} 0 {large} {sweep} {x} {y}")
            }
            Some((_, from)) if far(from, point, clearance) => write!(path, "M{x} {y}h0"),
            Some(_) => write!(path, "L{x} {y}"),
        };
        last = Some((to, point));
    }
    path
}

/// Whether the motion between two points is a piece of the circle: a rotor that tilts is in contact inside it.
fn along_wall(from: &TracePoint, to: &TracePoint, clearance: f64) -> bool {
    let contact = matches!(to.phase, PhaseKind::Sliding | PhaseKind::Rolling);
    let at_wall = |point: &TracePoint| {
        let [x, y] = point.state.position;
        (x.hypot(y) / clearance - 1.0).abs() < AT_WALL
    };
    contact && at_wall(from) && at_wall(to)
}

/// Angle between two points, rad, counter-clockwise: the short way, but with the motion where that is
/// fast enough to have gone round the other way.
fn turn(from: &TracePoint, to: &TracePoint) -> f64 {
    let angle = |point: &TracePoint| point.state.position[1].atan2(point.state.position[0]);
    let ([x, y], [vx, vy]) = (to.state.position, to.state.velocity);
    let rate = (x * vy - y * vx) / (x * x + y * y);
    let short = (angle(to) - angle(from) + PI).rem_euclid(TAU) - PI;
    let fast = (rate * (to.state.time - from.state.time)).abs() > FRAC_PI_2;
    if fast && short * rate < 0.0 {
        short + TAU.copysign(rate)
    } else {
        short
    }
}

/// In drawing units, those that fall on others left out.
fn hits(impacts: &[Impact], scale: f64) -> Vec<(f64, f64)> {
    let mut drawn: Vec<(f64, f64)> = Vec::new();
    for at in impacts.iter().map(|it| place(it.state.position, scale)) {
        let apart = |it: &(f64, f64)| f64::hypot(it.0 - at.0, it.1 - at.1) > 1.5;
        if drawn.iter().all(apart) {
            drawn.push(at);
        }
    }
    drawn
}

fn spin_arrow(spin: f64) -> Markup {
    let rpm = significant(spin.abs() * 30.0 / PI, 5);
    let (path, turn) = match spin {
        0.0 => ("", ""),
        0.0.. => (
            "M194 -70A206 206 0 0 0 150 -141M150 -141l1 12M150 -141l11 5",
            "\u{21ba}",
        ),
        _ => (
            "M150 -141A206 206 0 0 1 194 -70M194 -70l1 -12M194 -70l-10 -7",
            "\u{21bb}",
        ),
    };
    html! {
        path.arrow d=(path) {}
        text.label x="232" y="-196" text-anchor="end" {
            @if spin == 0.0 { "no spin" } @else { "spin " (rpm) " rpm " (turn) }
        }
    }
}
