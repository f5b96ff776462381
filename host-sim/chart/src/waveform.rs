//! Recorded displacement of a channel against time.

use maud::{Markup, html};

use crate::plot::{Axis, Chart};

const HEIGHT: f64 = 150.0;
/// Strokes of a kind that a chart gets.
const STROKES: usize = 400;
const CHANNELS: [&str; 4] = ["plane a, x", "plane a, y", "plane b, x", "plane b, y"];

/// What is drawn of a channel.
pub struct Waveform<'a> {
    /// 0 to 3.
    pub channel: usize,
    /// First and last moment, s.
    pub span: [f64; 2],
    /// Name of the time axis, in s.
    pub time: &'static str,
    /// For who does not see it.
    pub description: &'static str,
    /// m.
    pub clearance: f64,
    /// Class of each curve, and its points, s and m. Later ones lie over earlier ones.
    pub curves: &'a [(&'static str, Vec<(f64, f64)>)],
    /// Events at the top, and impacts at the bottom, s.
    pub strokes: [&'a [f64]; 2],
}

/// An axis that reaches somewhat beyond the farthest place, m, to either side.
pub fn displacement_axis(name: &str, farthest: f64) -> Axis {
    let reach = 1.12 * farthest;
    Axis::scaled(1e6, -reach, reach, &format!("{name}, \u{b5}m"), 5.0)
}

/// Draws it, with dashed lines at the clearance.
pub fn waveform(shown: &Waveform<'_>) -> Markup {
    let name = CHANNELS[shown.channel];
    let points = shown.curves.iter().flat_map(|(_, points)| points);
    // A missing value is not farther.
    let farthest = points.fold(shown.clearance, |most, it| most.max(it.1.abs()));
    let [from, to] = shown.span;
    let x = Axis::new(from, to, shown.time, 6.0);
    let chart = Chart {
        title: name,
        description: shown.description,
        x: &x,
        y: &displacement_axis(name, farthest),
        height: HEIGHT,
    };
    let curves = html! {
        (chart.walls(shown.clearance))
        @for (class, points) in shown.curves { (chart.curve(class, points.iter().copied())) }
    };
    let strokes = shown.strokes.map(|times| {
        let seen = times.iter().filter(|it| x.shows(**it)).take(STROKES);
        seen.map(|it| x.percent(*it)).collect::<Vec<_>>()
    });
    let front = html! {
        @for at in &strokes[0] { line.mark x1=(at) x2=(at) y1="0" y2=(HEIGHT) {} }
        @for at in &strokes[1] { line.hit x1=(at) x2=(at) y1=(HEIGHT - 9.0) y2=(HEIGHT) {} }
    };
    chart.draw(&html! {}, &curves, &front)
}
