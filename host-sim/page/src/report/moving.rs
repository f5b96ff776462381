//! What moves besides the rotor's centre: its ends, the retainer ring, the inner ring.

use super::orbit::draw;
use super::window::Window;
use maud::{Markup, html};
use std::f64::consts::TAU;
use touchdown_base::history::{History, PhaseKind};
use touchdown_chart::plot::{Axis, Chart, key};
use touchdown_run::outcome::{Outcome, TracePoint};
use touchdown_scene::{Ring, Scene};
use touchdown_truth::Moving;

const HEIGHT: f64 = 190.0;
const MICRO: f64 = 1e6;

/// One orbit a ring of a rotor that tilts.
pub fn ends(scene: &Scene, outcome: &Outcome) -> Markup {
    let rings = scene.rings().iter().zip(&outcome.truth.rings).enumerate();
    html! {
        div.pair {
            @for (index, (ring, truth)) in rings {
                section {
                    h2 { "Orbit in ring " (ring.name) }
                    (end(index, ring, truth, scene, outcome))
                    p.note { (format!("At {:.0} mm from the centre of mass, gap {} \u{b5}m; {} impacts.", ring.place * 1e3, ring.retainer.clearance * MICRO, truth.impacts.len())) }
                }
            }
        }
    }
}

fn end(index: usize, ring: &Ring, truth: &History, scene: &Scene, outcome: &Outcome) -> Markup {
    let in_ring = |point: &TracePoint| match point.moving {
        Moving::Ends(ends) => Some(at(point, ends[index], phase_at(truth, point.state.time))),
        _ => None,
    };
    let trace: Vec<_> = outcome.trace.iter().filter_map(in_ring).collect();
    let title = format!("Orbit in ring {}", ring.name);
    let (clearance, spin) = (ring.retainer.clearance, scene.rotor.spin);
    draw(&title, clearance, spin, &trace, &truth.impacts)
}

/// The same moment at another place of the rotor.
fn at(point: &TracePoint, position: [f64; 2], phase: PhaseKind) -> TracePoint {
    let mut point = *point;
    point.state.position = position;
    point.state.velocity = [0.0; 2];
    point.phase = phase;
    point
}

fn phase_at(truth: &History, time: f64) -> PhaseKind {
    let after = truth.phases.partition_point(|phase| phase.start_s <= time);
    let phase = truth.phases.get(after.saturating_sub(1));
    phase.map_or(PhaseKind::FreeFall, |phase| phase.phase)
}

/// Displacement of the retainer ring, m, and spin of its inner ring, rad/s; none where they do not move.
fn ring_at(point: &TracePoint) -> ([f64; 2], f64) {
    match point.moving {
        Moving::Ring {
            position,
            race_spin,
            ..
        } => (position, race_spin),
        _ => ([0.0; 2], 0.0),
    }
}

/// Path of the rotor in a ring that moves itself.
pub fn in_ring(scene: &Scene, outcome: &Outcome) -> Markup {
    let relative = |point: &TracePoint| {
        let ([x, y], [u, v]) = (point.state.position, ring_at(point).0);
        at(point, [x - u, y - v], point.phase)
    };
    let trace: Vec<_> = outcome.trace.iter().map(relative).collect();
    let (clearance, spin) = (scene.retainer.clearance, scene.rotor.spin);
    draw("Orbit in the retainer ring", clearance, spin, &trace, &[])
}

/// Whether the retainer ring moves in the trace.
pub fn ring_moves(outcome: &Outcome) -> bool {
    outcome.trace.iter().any(|it| ring_at(it).0 != [0.0; 2])
}

/// Whether its inner ring turns.
pub fn race_turns(outcome: &Outcome) -> bool {
    outcome.trace.iter().any(|it| ring_at(it).1 != 0.0)
}

/// Displacement of the ring against time.
pub fn ring(window: Window, outcome: &Outcome) -> Markup {
    let names = [("x (right)", "motion"), ("y (up)", "pulse")];
    let title = "Displacement of the retainer ring";
    let axis = [title, "\u{b5}m from its rest place"];
    let place = |point: &TracePoint| ring_at(point).0.map(|x| x * MICRO);
    lines(axis, names, window, outcome, place)
}

/// Speeds of inner ring, cage and rotor against time; `cage` is the speed of the cage over the inner ring's.
pub fn speeds(cage: f64, window: Window, outcome: &Outcome) -> Markup {
    let rpm = 60.0 / TAU;
    let [rotor, race] = [("rotor", "motion"), ("inner ring", "pulse")];
    let names = [rotor, race, ("cage", "limit")];
    let title = "Speed of rotor, inner ring and cage";
    let axis = [title, "1/min, counter-clockwise"];
    lines(axis, names, window, outcome, |point| {
        let race = ring_at(point).1;
        [point.state.spin, race, cage * race].map(|speed| speed * rpm)
    })
}

fn lines<const N: usize>(
    [title, unit]: [&str; 2],
    names: [(&str, &str); N],
    window: Window,
    outcome: &Outcome,
    of: impl Fn(&TracePoint) -> [f64; N],
) -> Markup {
    let shown = |point: &&TracePoint| (window.start..=window.end).contains(&point.state.time);
    let points = outcome.trace.iter().filter(shown);
    let values: Vec<(f64, [f64; N])> = points.map(|it| (it.state.time, of(it))).collect();
    let all = || values.iter().flat_map(|(_, values)| values).copied();
    let (low, high) = (all().fold(0.0, f64::min), all().fold(0.0, f64::max));
    let margin = 0.06 * (high - low);
    let chart = Chart {
        title,
        description: "Of the reference, over time.",
        x: &window.axis(),
        y: &Axis::new(low - margin, high + margin, unit, 5.0),
        height: HEIGHT,
    };
    let points = |index: usize| values.iter().map(move |it| (it.0, it.1[index]));
    let curves = html! {
        @for (index, (_, class)) in names.iter().enumerate() { (chart.curve(class, points(index))) }
    };
    html! {
        (chart.plain(&curves))
        ul.legend { @for (name, class) in names { (key(class, name)) } }
    }
}
