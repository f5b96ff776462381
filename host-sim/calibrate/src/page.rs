//! What was found, for people: a table, and a page.

use std::f64::consts::TAU;

use maud::{Markup, html};
use touchdown_chart::plot::{Axis, Chart, key};
use touchdown_chart::shell;
use touchdown_chart::table::table;

use crate::ellipse::Ellipse;
use crate::{Checked, Plane, Value};

/// Points of a curve, and most that are drawn of the readings.
const POINTS: usize = 1_000;

/// Name, value, 95 % error and unit of each quantity.
fn rows(plane: &Plane) -> [[String; 4]; 11] {
    let found = |it: Value| (it.value, Some(it.error));
    let plain = |it: f64| (it, None);
    let (um, one, degrees) = ((1e6, "um"), (1.0, ""), (1_f64.to_degrees(), "deg"));
    let rows = [
        ("zero, first axis", found(plane.zero_m[0]), 3, um),
        ("zero, second axis", found(plane.zero_m[1]), 3, um),
        ("gain, first axis", found(plane.gain[0]), 5, one),
        ("gain, second axis", found(plane.gain[1]), 5, one),
        ("gain, second over first", found(plane.gain_ratio), 5, one),
        ("skew", found(plane.skew_rad), 4, degrees),
        ("radius", found(plane.radius_m), 3, um),
        ("residual, rms", plain(plane.residual_m), 3, um),
        ("correlation", plain(plane.correlation), 2, one),
        ("wall touched", plain(plane.arc_deg), 0, (1.0, "deg")),
        ("samples on the wall", plain(plane.on_wall as f64), 0, one),
    ];
    rows.map(|(name, (value, error), digits, (scale, unit))| {
        let number = |it: f64| format!("{:.digits$}", scale * it);
        let error = match error {
            None => String::new(),
            Some(0.0) => "given".to_owned(),
            Some(error) => number(error),
        };
        [name.to_owned(), number(value), error, unit.to_owned()]
    })
}

/// Of one plane, for a terminal.
pub fn text(checked: &Checked) -> String {
    let head = format!("plane {}", checked.name);
    let mut text = format!("{head:<26}{:>12}{:>13}\n", "value", "95 % error");
    for [name, value, error, unit] in checked.plane.iter().flat_map(rows) {
        let line = format!("  {name:<24}{value:>12}{error:>13}  {unit}");
        text = text + line.trim_end() + "\n";
    }
    if let Some(why) = &checked.refused {
        text += &format!("  refused: {why}\n");
    }
    text
}

/// All as a page.
pub fn page(title: &str, planes: &[Checked]) -> String {
    let body = html! {
        h1 { (title) }
        p { "Zero, gain and skew of the sensors from a rotor that was led round the retainer." }
        @for Checked { name, plane, refused, readings } in planes {
            h2 { "Plane " (name) }
            @if let Some(why) = refused { p { "Refused: " (why) } }
            @if let Some(plane) = plane {
                (table("values", &rows(plane)).names("", |it| it[0].clone()).number("value", |it| it[1].clone())
                    .number("95 % error", |it| it[2].clone()).words("unit", |it| it[3].clone()).draw())
                (orbit(&plane.fitted.ellipse, &readings.kept))
                (residuals(plane))
            }
        }
    };
    shell::page(title, &body).into_string()
}

/// Readings and the curve through those on the wall.
fn orbit(ellipse: &Ellipse, readings: &[[f64; 2]]) -> Markup {
    let [u, v, a, b, _] = ellipse.0;
    let axis = |zero: f64, label| {
        let (zero, far) = (1e6 * zero, 1.2e6 * a.max(b));
        Axis::new(zero - far, zero + far, label, 6.0)
    };
    let chart = Chart {
        title: "Readings",
        description: "Readings of both axes, and the curve of the wall",
        x: &axis(u, "first axis, \u{b5}m"),
        y: &axis(v, "second axis, \u{b5}m"),
        height: 420.0,
    };
    let micro = |[u, v]: [f64; 2]| (1e6 * u, 1e6 * v);
    let turn = (0..=POINTS).map(|it| it as f64 / POINTS as f64 * TAU);
    let curve = turn.map(|it| micro(ellipse.point(it)));
    let dots = dots(&chart, readings, micro);
    html! {
        ul.legend { (key("sensed", "readings")) (key("limit", "wall")) }
        (chart.plain(&html! { (dots) (chart.curve("limit", curve)) }))
    }
}

/// Over the angle.
fn residuals(plane: &Plane) -> Markup {
    let far = 5e6 * plane.residual_m;
    let chart = Chart {
        title: "Residual",
        description: "Distance of the readings on the wall from the curve, over the angle",
        x: &Axis::new(0.0, 360.0, "angle from the first axis, deg", 8.0),
        y: &Axis::new(-far, far, "residual, outward, \u{b5}m", 6.0),
        height: 220.0,
    };
    chart.plain(&dots(&chart, &plane.fitted.residuals, |[angle, it]| {
        (angle.to_degrees().rem_euclid(360.0), 1e6 * it)
    }))
}

/// As many as are drawn, where they lie in the chart.
fn dots(chart: &Chart, all: &[[f64; 2]], place: impl Fn([f64; 2]) -> (f64, f64)) -> Markup {
    let mut dots = chart.pen();
    for it in all.iter().step_by(all.len().div_ceil(4 * POINTS).max(1)) {
        let (x, y) = place(*it);
        dots.dot(x, y);
    }
    dots.finish("sensed")
}
