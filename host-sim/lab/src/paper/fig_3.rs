//! Fig. 3: the phase plane at the wall with its regions, and motions through it.

use std::f64::consts::{FRAC_PI_2, PI};

use maud::{Markup, html};

use super::Curve;
use super::rig::{on_wall, pendulum_square, rate};
use touchdown_base::history::PhaseKind;
use touchdown_base::regions::{Orbit, Plane};
use touchdown_chart::plot::{Axis, Chart};
use touchdown_page::report::regions::areas;
use touchdown_scene::Scene;
use touchdown_truth::reference::Reference;

const FIGURE: &str = "3";
const ANGLE: &str = "theta from the bottom, deg";
const RATE: &str = "theta', rad/s";
/// Angle from the bottom, deg, and theta', rad/s, from which motions are drawn.
const STARTS: [(f64, f64); 9] = [
    (0.0, 110.0),
    (0.0, 200.0),
    (88.0, -40.0),
    (100.0, -150.0),
    (-97.0, 75.0),
    (-179.0, 190.0),
    (-179.0, 340.0),
    (140.0, -240.0),
    (179.0, -420.0),
];
/// Spacing of the points of a motion, s.
const SPACING: f64 = 0.1e-3;
/// Longest motion: a swing closes in less, s.
const LONGEST: u32 = 600;
/// Height of the drawing, px, and range of theta', rad/s.
const HEIGHT: f64 = 460.0;
const RANGE: f64 = 500.0;

fn plane(base: &Scene) -> Plane {
    Plane::new(pendulum_square(base), base.retainer.friction)
}

/// Boundaries in closed form, motions from the reference.
pub fn curves(base: &Scene) -> Vec<Curve> {
    let plane = plane(base);
    let curve = |name: &str, class, points| Curve {
        figure: FIGURE,
        name: name.to_owned(),
        x: ANGLE,
        y: RATE,
        points,
        class,
    };
    let slowest = held(plane.slowest_whirl(), -PI, PI);
    let widest = closed(plane.widest_swing());
    let mut curves = vec![
        curve("A: slowest whirl that keeps contact", "boundary", slowest),
        curve("B: widest swing that keeps contact", "boundary", widest),
    ];
    for side in [1.0, -1.0] {
        let limit = |phi: f64| Some([phi.to_degrees(), side * plane.limit(phi)]);
        let halves = [spaced(-PI, -FRAC_PI_2), spaced(FRAC_PI_2, PI)].into_iter();
        let points = halves.flat_map(|half| half.map(limit).chain([None]));
        let name = "C: below it the wall cannot hold the rotor";
        curves.push(curve(name, "limit", points.collect()));
    }
    for (angle, rate) in STARTS {
        let name = format!("motion from {angle} deg and {rate} rad/s");
        curves.push(curve(&name, "path", motion(base, angle, rate)));
    }
    curves
}

pub fn drawing(base: &Scene, curves: &[Curve]) -> Markup {
    let mut x = Axis::new(-180.0, 180.0, "\u{3b8} from the bottom, degrees", 8.0);
    x.step = 60.0;
    let y = Axis::new(-RANGE, RANGE, "\u{3b8}\u{2032}, rad/s", 10.0);
    let chart = Chart {
        title: "Fig. 3: phase plane",
        description: "Angular speed against angle from the bottom. Region A, whirl, above; region B, swing, round \
                      the bottom; region C, where the wall cannot hold the rotor, at both ends.",
        x: &x,
        y: &y,
        height: HEIGHT,
    };
    let plane = plane(base);
    let drawn = html! {
        (areas(&plane, 1.0, &chart))
        @for curve in curves.iter().filter(|it| it.figure == FIGURE) {
            (curve.draw(&chart, [1.0, 1.0]))
        }
    };
    let names = [
        (-90.0, 430.0, "A"),
        (-12.0, 40.0, "B"),
        (160.0, 0.0, "C"),
        (-160.0, 0.0, "C"),
    ];
    let front = html! {
        @for (angle, rate, name) in names {
            text.label.region-name x=(x.percent(angle)) y=((1.0 - y.fraction(rate)) * HEIGHT) dy="6"
                text-anchor="middle" { (name) }
        }
    };
    chart.draw(&html! {}, &drawn, &front)
}

/// Angles from one to another, closer together at both ends, where boundaries are steep.
fn spaced(from: f64, to: f64) -> impl Iterator<Item = f64> {
    (0..=120).map(move |n| {
        let part = 0.5 - 0.5 * (PI * f64::from(n) / 120.0).cos();
        from + (to - from) * part
    })
}

/// Where the wall holds a motion with the friction.
fn held(orbit: Orbit, from: f64, to: f64) -> Vec<Option<[f64; 2]>> {
    let point = |phi: f64| [phi.to_degrees(), orbit.rate(phi)];
    spaced(from, to)
        .map(|phi| orbit.holds(phi).then(|| point(phi)))
        .collect()
}

/// A swing there and back.
fn closed(orbit: Orbit) -> Vec<Option<[f64; 2]>> {
    let (left, right) = (orbit.held_until(0.0, -FRAC_PI_2), FRAC_PI_2);
    let speed = |phi: f64| orbit.square(phi).max(0.0).sqrt();
    let there = spaced(left, right).map(|phi| Some([phi.to_degrees(), speed(phi)]));
    let back = spaced(right, left).map(|phi| Some([phi.to_degrees(), -speed(phi)]));
    there.chain(back).collect()
}

/// From a point until contact is lost, the top is reached, or a swing has closed.
fn motion(base: &Scene, start: f64, speed: f64) -> Vec<Option<[f64; 2]>> {
    let scene = on_wall(base, start.to_radians(), speed, 1.0);
    let mut reference = Reference::new(&scene.machine(), &scene.start, scene.rotor.spin);
    let mut points = Vec::new();
    for step in 0..=LONGEST {
        let state = reference.advance(f64::from(step) * SPACING, &mut |_| {});
        let angle = start + 360.0 * state.turns_in_contact;
        if reference.phase() != PhaseKind::Sliding || angle.abs() > 180.0 {
            break;
        }
        points.push(Some([angle, rate(&state)]));
    }
    points
}
