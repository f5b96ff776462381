//! Angular speed against angle while the rotor is at the wall.

use super::regions::areas;
use super::window::{far, runs};
use maud::{Markup, html};
use touchdown_base::history::RotorState;
use touchdown_base::regions::Plane;
use touchdown_chart::plot::{Axis, Chart, Pen};
use touchdown_run::outcome::{Outcome, TracePoint};
use touchdown_scene::Scene;

/// Part of the clearance beyond which the rotor counts as near the wall.
const NEAR: f64 = 0.8;

/// Range of the slow part in `sqrt(g/clearance)`: a turn without friction takes `sqrt(5)` at the bottom.
const BEGINNING: f64 = 5.0;

/// Surface speed, in `sqrt(g clearance)`, from which the slip keeps its sign until fast whirl.
const FAST: f64 = 20.0;

const HEIGHT: f64 = 330.0;

/// Draws theta-dot against theta, theta from the bottom, counter-clockwise; of a fast whirl also its
/// beginning.
pub fn phase_plane(scene: &Scene, outcome: &Outcome) -> Markup {
    let trace = &outcome.trace;
    let motion = || trace.iter().filter_map(|it| at_wall(&it.state, scene));
    let widest = motion().map(|it| it.0.abs()).fold(0.0, f64::max);
    let low = motion().map(|it| it.1).fold(0.0, f64::min);
    let high = motion().map(|it| it.1).fold(0.0, f64::max);
    if low == high {
        return html! { p.note { "The rotor did not move along the wall." } };
    }
    let slow = BEGINNING * (scene.run.gravity / scene.retainer.clearance).sqrt();
    let beginning = slow > 0.0 && high.max(-low) > 3.0 * slow;
    html! {
        @if beginning {
            (plane("Phase plane, slow part", widest, [low.max(-slow), high.min(slow)], scene, outcome))
        }
        (plane("Phase plane", widest, [low, high], scene, outcome))
    }
}

fn plane(
    title: &str,
    widest: f64,
    [low, high]: [f64; 2],
    scene: &Scene,
    outcome: &Outcome,
) -> Markup {
    let (scale, unit) = match high.max(-low) > 1e4 {
        true => (1e-3, "krad/s"),
        false => (1.0, "rad/s"),
    };
    let spans = [(30.0, 10.0), (90.0, 30.0), (180.0, 45.0)];
    let fitting = spans.into_iter().find(|span| 1.1 * widest < span.0);
    let (reach, step) = fitting.unwrap_or(spans[2]);
    let mut x = Axis::new(-reach, reach, "\u{3b8} from the bottom, degrees", 8.0);
    x.step = step;
    let margin = 0.06 * (high - low);
    let unit = format!("d\u{3b8}/dt, {unit}");
    let chart = Chart {
        title,
        description: "Angular speed against angle from the bottom while the rotor is at the wall, \
                      coloured by phase; inside a dashed curve the wall cannot hold the rotor.",
        x: &x,
        y: &Axis::scaled(scale, low - margin, high + margin, &unit, 6.0),
        height: HEIGHT,
    };
    let curves = html! {
        @if let Some(plane) = fast_plane(scene).filter(|_| reach > 90.0) {
            (areas(&plane, -scene.rotor.spin.signum(), &chart))
        }
        @if reach > 90.0 { (contact_limit(scene, chart.pen())) }
        @for run in runs(&outcome.trace) { (curve(run, scene, chart.pen())) }
    };
    chart.draw(&html! {}, &curves, &html! {})
}

/// The regions of a rotor that spins so fast that friction drives one way all the time.
fn fast_plane(scene: &Scene) -> Option<Plane> {
    let machine = &scene.machine();
    let unit = (machine.gravity * machine.clearance).sqrt();
    let fast = machine.radius * scene.rotor.spin.abs() > FAST * unit;
    let friction = Plane::FRICTION.contains(&machine.friction);
    (unit > 0.0 && fast && friction)
        .then(|| Plane::new(machine.gravity / machine.clearance, machine.friction))
}

/// Angle in degrees and its rate in rad/s, if the rotor is near the wall.
fn at_wall(state: &RotorState, scene: &Scene) -> Option<(f64, f64)> {
    let ([x, y], [vx, vy]) = (state.position, state.velocity);
    let radius = f64::hypot(x, y);
    let (angle, rate) = (x.atan2(-y), (x * vy - y * vx) / (radius * radius));
    (radius > NEAR * scene.retainer.clearance).then_some((angle.to_degrees(), rate))
}

/// Where the angle wraps, the curve runs out at one side and in at the other.
fn curve(run: &[TracePoint], scene: &Scene, mut pen: Pen<'_>) -> Markup {
    let mut last: Option<(f64, f64, &TracePoint)> = None;
    for point in run {
        let Some((angle, rate)) = at_wall(&point.state, scene) else {
            pen.lift();
            last = None;
            continue;
        };
        match last {
            Some((_, _, from)) if far(from, point, scene.retainer.clearance) => {
                pen.dot(angle, rate)
            }
            Some((before, slower, _)) if (angle - before).abs() > 180.0 => {
                let turn = 360f64.copysign(before);
                pen.line_to(angle + turn, rate);
                pen.lift();
                pen.line_to(before - turn, slower);
                pen.line_to(angle, rate);
            }
            _ => pen.line_to(angle, rate),
        }
        last = Some((angle, rate, point));
    }
    pen.finish(<&str>::from(run[run.len() - 1].phase))
}

/// Where the wall's force vanishes: `theta-dot^2 = -(g/clearance) cos theta`.
fn contact_limit(scene: &Scene, mut pen: Pen<'_>) -> Markup {
    let pressing = scene.run.gravity / scene.retainer.clearance;
    for side in [-1.0, 1.0] {
        for half in [90..=180, -180..=-90] {
            pen.lift();
            for degrees in half {
                let angle = f64::from(degrees);
                let square = (-pressing * angle.to_radians().cos()).max(0.0);
                pen.line_to(angle, side * square.sqrt());
            }
        }
    }
    pen.finish("limit")
}
