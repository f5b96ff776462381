//! The regions of the phase plane as areas of a chart.

use std::f64::consts::{FRAC_PI_2, PI};

use maud::{Markup, html};
use touchdown_base::regions::{Orbit, Plane};
use touchdown_chart::plot::Chart;

/// Points of a boundary, closer together at its ends, where it is steep.
const POINTS: u32 = 240;

/// A, B and C as areas, with the boundary of B and the least speed of A, in a chart of rad/s over degrees. `side` is 1, or
/// -1 where friction drives clockwise.
pub fn areas(plane: &Plane, side: f64, chart: &Chart<'_>) -> Markup {
    let (whirl, swing) = (plane.slowest_whirl(), plane.widest_swing());
    let [lowest, highest] = chart.y.ends();
    let fastest = highest.abs().max(lowest.abs());
    let least = |phi: f64| match whirl.holds(phi) {
        true => whirl.rate(phi),
        false => plane.limit(phi),
    };
    let leftmost = swing.held_until(0.0, -FRAC_PI_2);
    let stops = |orbit: Orbit| move |phi: f64| orbit.square(phi).max(0.0).sqrt();
    // There along one speed (rad/s) and back along another, over a range of angles (rad).
    let between = |(from, to), low: &dyn Fn(f64) -> f64, high: &dyn Fn(f64) -> f64, class| {
        let angles = (0..=POINTS).map(|n| {
            let part = 0.5 - 0.5 * (PI * f64::from(n) / f64::from(POINTS)).cos();
            from + (to - from) * part
        });
        let there = angles.clone().map(|phi| (phi, low(phi)));
        let back = angles.rev().map(|phi| (phi, high(phi)));
        let mut pen = chart.pen();
        for (phi, rate) in there.chain(back) {
            let rate = (side * rate).clamp(lowest, highest);
            pen.line_to(side * phi.to_degrees(), rate);
        }
        pen.fill(class)
    };
    html! {
        @for half in [(-PI, -FRAC_PI_2), (FRAC_PI_2, PI)] {
            (between(half, &|phi| -plane.limit(phi), &|phi| plane.limit(phi), "no-hold"))
        }
        (between((-PI, PI), &least, &|_| fastest, "whirl"))
        (between((leftmost, FRAC_PI_2), &|phi| -stops(swing)(phi), &stops(swing), "swing"))
        @for (slow, fast) in plane.turning_whirls().take_while(|it| it.0.rate(0.0) < fastest) {
            @let from = if fast.holds(-PI) { -PI } else { -FRAC_PI_2 };
            (between((from, PI), &|phi| -stops(fast)(phi), &|phi| -stops(slow)(phi), "whirl"))
        }
    }
}
