//! Fig. 7: the pulse of the contact force.

use maud::{Markup, html};

use super::Curve;
use super::contact::{half, whole, wide};
use super::hertz::Contact;
use super::straight;
use touchdown_base::failure::Failure;
use touchdown_chart::plot::{Axis, Chart, key};
use touchdown_scene::Scene;

const FIGURE: &str = "7";
/// Width of the paper's window, s: 32.8 to 33.4 ms.
const WINDOW: f64 = 0.6e-3;
/// Start of the pulse in it, s.
const START: f64 = 0.2e-3;
const POINTS: usize = 120;
const HEIGHT: f64 = 260.0;

/// Half the rotor on each bearing, after a fall through either gap: the closed form, and over it the
/// model's run.
pub fn curves(base: &Scene) -> Result<Vec<Curve>, Failure> {
    let narrow = half(whole(base));
    let wide = half(wide(whole(base), base));
    let exact = |contact: &Contact| contact.pulse(POINTS);
    let ours = |contact: &Contact| straight::curve(base, contact);
    Ok(vec![
        curve("closed form, 0.3 mm", "pulse", exact(&narrow)),
        curve("closed form, 0.75 mm", "pulse wide", exact(&wide)),
        curve("run of rung hertz, 0.3 mm", "pulse run", ours(&narrow)?),
        curve("run of rung hertz, 0.75 mm", "pulse run", ours(&wide)?),
    ])
}

fn curve(name: &str, class: &'static str, pulse: Vec<(f64, f64)>) -> Curve {
    let mut points = vec![Some([0.0, 0.0])];
    let shown = pulse
        .into_iter()
        .map(|(time, force)| [START + time, force])
        .filter(|point| point[0] > 0.0 && point[0] < WINDOW);
    points.extend(shown.map(Some));
    points.push(Some([WINDOW, 0.0]));
    Curve {
        figure: FIGURE,
        name: name.to_owned(),
        x: "time, s",
        y: "contact force, N",
        points,
        class,
    }
}

pub fn drawing(curves: &[Curve]) -> Markup {
    let shown = || curves.iter().filter(|it| it.figure == FIGURE);
    let top = shown().map(Curve::top).fold(0.0, f64::max) * 1e-3;
    let x = Axis::new(0.0, WINDOW * 1e3, "time, ms", 6.0);
    let y = Axis::new(-0.05 * top, 1.1 * top, "contact force, kN", 5.0);
    let chart = Chart {
        title: "Fig. 7: contact force",
        description: "Force of an elastic Hertz contact over time, in either gap: closed form and run of the model.",
        x: &x,
        y: &y,
        height: HEIGHT,
    };
    let drawn = html! { @for curve in shown() { (curve.draw(&chart, [1e3, 1e-3])) } };
    html! {
        (chart.plain(&drawn))
        ul.legend { @for curve in shown() { (key(curve.class, &curve.name)) } }
    }
}
