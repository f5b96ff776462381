//! The regions of the phase plane as areas of a chart.

use std::f64::consts::{FRAC_PI_2, PI};

use maud::{Markup, html};
use touchdown_base::regions::{Orbit, Plane};
use touchdown_chart::plot::{Axis, Chart};

/// Points of a boundary, closer together at its ends, where it is steep.
const POINTS: u32 = 240;

/// How a chart shows a plane.
#[derive(Clone, Copy, Debug)]
pub struct View<'a> {
    /// The plane.
    pub plane: &'a Plane,
    /// 1, or -1 where friction drives clockwise.
    pub side: f64,
    /// From rad/s to the unit of the chart.
    pub factor: f64,
}

/// A, B and C as areas, with the boundary of B and the least speed of A, over a chart of degrees.
pub fn areas(view: View<'_>, chart: &Chart<'_>) -> Markup {
    let plane = view.plane;
    let (whirl, swing) = (plane.slowest_whirl(), plane.widest_swing());
    let fastest = chart.y.hi.abs().max(chart.y.lo.abs()) / view.factor;
    let least = |phi: f64| match whirl.holds(phi) {
        true => whirl.rate(phi),
        false => plane.limit(phi),
    };
    let leftmost = swing.held_until(0.0, -FRAC_PI_2);
    let stops = |orbit: Orbit| move |phi: f64| orbit.square(phi).max(0.0).sqrt();
    html! {
        @for half in [(-PI, -FRAC_PI_2), (FRAC_PI_2, PI)] {
            (view.between(chart, half, &|phi| -plane.limit(phi), &|phi| plane.limit(phi), "no-hold"))
        }
        (view.between(chart, (-PI, PI), &least, &|_| fastest, "whirl"))
        (view.between(chart, (leftmost, FRAC_PI_2), &|phi| -stops(swing)(phi), &stops(swing), "swing"))
        @for (slow, fast) in plane.turning_whirls().take_while(|it| it.0.rate(0.0) < fastest) {
            @let from = if fast.holds(-PI) { -PI } else { -FRAC_PI_2 };
            (view.between(chart, (from, PI), &|phi| -stops(fast)(phi), &|phi| -stops(slow)(phi), "whirl"))
        }
    }
}

impl View<'_> {
    /// The area between two speeds (rad/s) over a range of angles (rad).
    fn between(
        self,
        chart: &Chart<'_>,
        (from, to): (f64, f64),
        low: &dyn Fn(f64) -> f64,
        high: &dyn Fn(f64) -> f64,
        class: &str,
    ) -> Markup {
        let mut pen = chart.pen();
        let angles = (0..=POINTS).map(|n| {
            let part = 0.5 - 0.5 * (PI * f64::from(n) / f64::from(POINTS)).cos();
            from + (to - from) * part
        });
        let there = angles.clone().map(|phi| (phi, low(phi)));
        let back = angles.rev().map(|phi| (phi, high(phi)));
        for (phi, rate) in there.chain(back) {
            let (angle, rate) = self.place(phi, rate);
            pen.line_to(angle, within(chart.y, rate));
        }
        pen.fill(class)
    }

    /// Degrees and the chart's unit.
    pub fn place(&self, phi: f64, rate: f64) -> (f64, f64) {
        (self.side * phi.to_degrees(), self.side * rate * self.factor)
    }
}

fn within(axis: &Axis, value: f64) -> f64 {
    value.clamp(axis.lo, axis.hi)
}
