//! What was found, for people: a table, and a page.

use maud::html;
use touchdown_chart::plot::{Axis, Chart, key};
use touchdown_chart::shell;
use touchdown_chart::table::table;

use crate::{Checked, Plane, Value};

/// Points of a curve, and most that are drawn of the readings.
const POINTS: usize = 1_000;

/// A row: name, value, 95 % error, unit.
type Row = [String; 4];

fn rows(plane: &Plane) -> Vec<Row> {
    let plain = |name: &str, value: f64, digits: usize, unit: &str| {
        let value = format!("{value:.digits$}");
        [name.to_owned(), value, String::new(), unit.to_owned()]
    };
    let row = |name: &str, it: Value, scale: f64, digits: usize, unit: &str| {
        let mut row = plain(name, scale * it.value, digits, unit);
        row[2] = match it.error {
            0.0 => "given".to_owned(),
            error => format!("{:.digits$}", scale * error),
        };
        row
    };
    let degrees = 180.0 / std::f64::consts::PI;
    let [first, second] = plane.zero_m;
    let [gain, other] = plane.gain;
    vec![
        row("zero, first axis", first, 1e6, 3, "um"),
        row("zero, second axis", second, 1e6, 3, "um"),
        row("gain, first axis", gain, 1.0, 5, ""),
        row("gain, second axis", other, 1.0, 5, ""),
        row("gain, second over first", plane.gain_ratio, 1.0, 5, ""),
        row("skew", plane.skew_rad, degrees, 4, "deg"),
        row("radius", plane.radius_m, 1e6, 3, "um"),
        plain("residual, rms", 1e6 * plane.residual_m, 3, "um"),
        plain("correlation", plane.correlation, 2, ""),
        plain("wall touched", plane.arc_deg, 0, "deg"),
        plain("samples on the wall", plane.on_wall as f64, 0, ""),
    ]
}

/// Of one plane, for a terminal.
pub fn text(checked: &Checked) -> String {
    let head = format!("plane {}", checked.name);
    let mut text = format!("{head:<26}{:>12}{:>13}\n", "value", "95 % error");
    for [name, value, error, unit] in checked.plane.iter().flat_map(rows) {
        let line = format!("  {name:<24}{value:>12}{error:>13}  {unit}");
        text += line.trim_end();
        text.push('\n');
    }
    if let Some(why) = checked.refused() {
        text += &format!("  refused: {why}\n");
    }
    text
}

/// All as a page.
pub fn page(title: &str, planes: &[Checked]) -> String {
    let body = html! {
        h1 { (title) }
        p { "Zero, gain and skew of the sensors from a rotor that was led round the retainer." }
        @for Checked { name, plane, readings } in planes {
            h2 { "Plane " (name) }
            @match plane {
                Err(why) => p { "Refused: " (why) },
                Ok(plane) => {
                    @if let Some(why) = &plane.refused { p { "Refused: " (why) } }
                    (table("values", &rows(plane)).names("", |it| it[0].clone()).number("value", |it| it[1].clone())
                        .number("95 % error", |it| it[2].clone()).words("unit", |it| it[3].clone()).draw())
                    (orbit(plane, readings.kept()))
                    (residuals(plane))
                },
            }
        }
    };
    shell::page(title, &body).into_string()
}

/// Readings and the curve through those on the wall.
fn orbit(plane: &Plane, readings: &[[f64; 2]]) -> maud::Markup {
    let [a, b] = plane.ellipse.amplitude;
    let axis = |k: usize, label| {
        let (zero, far) = (1e6 * plane.ellipse.zero[k], 1.2e6 * a.max(b));
        Axis::new(zero - far, zero + far, label, 6.0)
    };
    let (x, y) = (
        axis(0, "first axis, \u{b5}m"),
        axis(1, "second axis, \u{b5}m"),
    );
    let chart = Chart {
        title: "Readings",
        description: "Readings of both axes, and the curve of the wall",
        x: &x,
        y: &y,
        height: 420.0,
    };
    let mut dots = chart.pen();
    for [u, v] in some(readings) {
        dots.dot(1e6 * u, 1e6 * v);
    }
    let turn = (0..=POINTS).map(|it| it as f64 / POINTS as f64 * std::f64::consts::TAU);
    let curve = turn
        .map(|it| plane.ellipse.point(it))
        .map(|[u, v]| (1e6 * u, 1e6 * v));
    html! {
        ul.legend { (key("sensed", "readings")) (key("limit", "wall")) }
        (chart.plain(&html! { (dots.finish("sensed")) (chart.curve("limit", curve)) }))
    }
}

/// As many as are drawn.
fn some(all: &[[f64; 2]]) -> impl Iterator<Item = &[f64; 2]> {
    all.iter().step_by(all.len().div_ceil(4 * POINTS).max(1))
}

/// Over the angle.
fn residuals(plane: &Plane) -> maud::Markup {
    let x = Axis::new(0.0, 360.0, "angle from the first axis, deg", 8.0);
    let far = 5e6 * plane.residual_m;
    let y = Axis::new(-far, far, "residual, outward, \u{b5}m", 6.0);
    let chart = Chart {
        title: "Residual",
        description: "Distance of the readings on the wall from the curve, over the angle",
        x: &x,
        y: &y,
        height: 220.0,
    };
    let mut dots = chart.pen();
    for [angle, it] in some(&plane.residuals) {
        dots.dot(angle.to_degrees().rem_euclid(360.0), 1e6 * it);
    }
    chart.plain(&dots.finish("sensed"))
}
