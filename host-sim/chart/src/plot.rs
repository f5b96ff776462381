//! Small inline SVG charts with linear or logarithmic axes.
//!
//! A chart has a fixed height and the width of its container: positions along x are percentages, curves
//! are stretched by a nested viewBox, and text keeps its size, so the same drawing is legible on a phone
//! and on paper.

use maud::{Markup, PreEscaped, html};
use std::fmt::Write;

/// Drawing units across a curve's width.
const WIDTH: f64 = 1000.0;

/// Points nearer than this to the last one drawn are left out, in drawing units.
const RESOLUTION: f64 = 0.35;

/// An axis, in the unit that its label names.
#[derive(Clone, Debug)]
pub struct Axis {
    /// From the unit of the values to its own.
    scale: f64,
    /// At the left or lower end, in its unit; the power of ten where it is logarithmic.
    pub lo: f64,
    /// At the right or upper end; likewise.
    pub hi: f64,
    /// Quantity and unit.
    label: String,
    /// Distance of the ticks; in decades where it is logarithmic.
    pub step: f64,
    log: bool,
}

impl Axis {
    /// An axis with about `ticks` ticks at multiples of 1, 2 or 5.
    pub fn new(lo: f64, hi: f64, label: &str, ticks: f64) -> Self {
        Self::scaled(1.0, lo, hi, label, ticks)
    }

    /// The same of ends and values that are multiplied by `scale` to be in its unit.
    pub fn scaled(scale: f64, lo: f64, hi: f64, label: &str, ticks: f64) -> Self {
        let (lo, hi) = (lo * scale, hi * scale);
        let hi = if hi > lo { hi } else { lo + 1.0 };
        let raw = (hi - lo) / ticks;
        let power = 10f64.powf(raw.log10().floor());
        let nice = [1.0, 2.0, 5.0].into_iter().find(|it| it * power >= raw);
        Self {
            scale,
            lo,
            hi,
            label: label.to_owned(),
            step: nice.unwrap_or(10.0) * power,
            log: false,
        }
    }

    /// A logarithmic axis that holds both values, of whole decades, with at most `ticks` ticks.
    pub fn decades(lo: f64, hi: f64, label: &str, ticks: f64) -> Self {
        let (lo, hi) = (lo.log10().floor(), hi.log10().ceil());
        let hi = hi.max(lo + 1.0);
        Self {
            step: ((hi - lo) / ticks).ceil(),
            log: true,
            ..Self::new(lo, hi, label, ticks)
        }
    }

    /// Ends, whether it is logarithmic, and label, for the page's script.
    pub fn range(&self) -> String {
        let log = u8::from(self.log);
        format!("{} {} {log} {}", self.lo, self.hi, self.label)
    }

    /// 0 at the left or lower end, 1 at the other.
    pub fn fraction(&self, value: f64) -> f64 {
        let value = value * self.scale;
        self.part(if self.log { value.log10() } else { value })
    }

    fn part(&self, shown: f64) -> f64 {
        (shown - self.lo) / (self.hi - self.lo)
    }

    /// Position along x as an SVG percentage, kept within the chart.
    pub fn percent(&self, value: f64) -> String {
        percent(self.fraction(value).clamp(0.0, 1.0))
    }

    /// Whether the value lies on the axis.
    pub fn shows(&self, value: f64) -> bool {
        (0.0..=1.0).contains(&self.fraction(value))
    }

    /// The least and the greatest value that it shows, if it is linear.
    pub fn ends(&self) -> [f64; 2] {
        [self.lo, self.hi].map(|end| end / self.scale)
    }

    /// Ticks: numbers in its unit, powers of ten where it is logarithmic, and their texts.
    pub fn ticks(&self) -> impl Iterator<Item = (f64, String)> {
        let decimals = (-self.step.log10().floor()).max(0.0) as usize;
        let first = (self.lo / self.step - 1e-9).ceil() as i64;
        let last = (self.hi / self.step + 1e-9).floor() as i64;
        let show = if self.log { ten_to } else { minus };
        (first..=last)
            .map(|number| number as f64 * self.step)
            .map(move |value| (value, show(&format!("{value:.decimals$}"))))
    }
}

/// Ten with a power, raised.
fn ten_to(power: &str) -> String {
    const RAISED: &str =
        "\u{2070}\u{b9}\u{b2}\u{b3}\u{2074}\u{2075}\u{2076}\u{2077}\u{2078}\u{2079}";
    let digit = |it: char| RAISED.chars().nth(it.to_digit(10)? as usize);
    let raised = power.chars().map(|it| digit(it).unwrap_or('\u{207b}'));
    "10".chars().chain(raised).collect()
}

/// A part of the width.
pub fn percent(fraction: f64) -> String {
    format!("{:.2}%", 100.0 * fraction)
}

/// With a true minus sign.
pub fn minus(text: &str) -> String {
    text.replace('-', "\u{2212}")
}

/// A coordinate with one decimal.
pub fn coordinate(value: f64) -> String {
    let text = format!("{value:.1}");
    let text = text.strip_suffix(".0").unwrap_or(&text);
    if text == "-0" { "0" } else { text }.to_owned()
}

/// Curves over two axes, as SVG path data in the drawing units of the chart.
pub struct Pen<'a> {
    chart: &'a Chart<'a>,
    path: String,
    last: Option<(f64, f64)>,
}

impl Pen<'_> {
    fn place(&self, x: f64, y: f64) -> Option<(f64, f64)> {
        let axes = self.chart;
        let (x, y) = (axes.x.fraction(x), 1.0 - axes.y.fraction(y));
        let near = x.abs() < 3.0 && y.abs() < 3.0;
        near.then_some((x * WIDTH, y * axes.height))
    }

    /// Goes on to a point; where it is not finite or far outside, the curve breaks.
    pub fn line_to(&mut self, x: f64, y: f64) {
        let Some(to) = self.place(x, y) else {
            return self.lift();
        };
        match self.last {
            Some(from) if f64::hypot(to.0 - from.0, to.1 - from.1) < RESOLUTION => return,
            Some(_) => self.push('L', to),
            None => self.push('M', to),
        }
        self.last = Some(to);
    }

    /// A dot, to be stroked with round caps.
    pub fn dot(&mut self, x: f64, y: f64) {
        self.lift();
        if let Some(at) = self.place(x, y) {
            self.push('M', at);
            self.path += "h0";
        }
    }

    /// A filled rectangle between these ends.
    pub fn rectangle(&mut self, x: [f64; 2], y: [f64; 2]) {
        let corners = (self.place(x[0], y[0]), self.place(x[1], y[1]));
        if let (Some((left, low)), Some((right, high))) = corners {
            let [left, low, right, high] = [left, low, right, high].map(coordinate);
            self.path += &format!("M{left} {low}H{right}V{high}H{left}");
        }
    }

    /// Breaks the curve.
    pub fn lift(&mut self) {
        self.last = None;
    }

    fn push(&mut self, command: char, (x, y): (f64, f64)) {
        let _ = write!(self.path, "{command}{} {}", coordinate(x), coordinate(y));
    }

    /// The area inside, styled by its class.
    pub fn fill(mut self, class: &str) -> Markup {
        self.path.push('Z');
        html! { path class={ "region " (class) } d=(self.path) {} }
    }

    /// The path element, styled by its class.
    pub fn finish(self, class: &str) -> Markup {
        html! {
            @if !self.path.is_empty() {
                path class={ "curve " (class) } d=(self.path) {}
            }
        }
    }
}

/// A chart.
pub struct Chart<'a> {
    /// Short name, for screen readers.
    pub title: &'a str,
    /// What it shows, for screen readers.
    pub description: &'a str,
    /// Horizontal axis.
    pub x: &'a Axis,
    /// Vertical axis.
    pub y: &'a Axis,
    /// Height of the plot area, px.
    pub height: f64,
}

impl Chart<'_> {
    /// A pen for this chart.
    pub fn pen(&self) -> Pen<'_> {
        Pen {
            chart: self,
            path: String::new(),
            last: None,
        }
    }

    /// Lines across at a value and its opposite.
    pub fn walls(&self, at: f64) -> Markup {
        let mut pen = self.pen();
        for side in [-1.0, 1.0] {
            pen.lift();
            for end in self.x.ends() {
                pen.line_to(end, side * at);
            }
        }
        pen.finish("wall")
    }

    /// A curve through these points, styled by its class.
    pub fn curve(&self, class: &str, points: impl IntoIterator<Item = (f64, f64)>) -> Markup {
        let mut pen = self.pen();
        for (x, y) in points {
            pen.line_to(x, y);
        }
        pen.finish(class)
    }

    /// Draws it with nothing but curves.
    pub fn plain(&self, curves: &Markup) -> Markup {
        self.draw(&html! {}, curves, &html! {})
    }

    /// Draws it: `behind` under the grid and `front` over the curves, both with x as percentages.
    pub fn draw(&self, behind: &Markup, curves: &Markup, front: &Markup) -> Markup {
        html! {
            p.unit { (self.y.label) }
            div.chart data-x=(self.x.range()) data-y=(self.y.range()) data-height=(self.height) {
                svg role="img" width="100%" height=(self.height + 40.0) {
                    title { (self.title) }
                    desc { (self.description) }
                    (self.inside(behind, curves, front))
                }
            }
        }
    }

    /// The same as a file of its own, `width` px wide.
    pub fn file(&self, width: f64, curves: &Markup, front: &Markup) -> Markup {
        let (left, above, below) = (64.0, 40.0, 48.0);
        html! {
            svg xmlns="http://www.w3.org/2000/svg" role="img" width=(width)
                height=(self.height + above + below) {
                title { (self.title) }
                desc { (self.description) }
                style { (PreEscaped(include_str!("style.css"))) }
                rect.paper width="100%" height="100%" {}
                text.unit x="8" y="24" { (self.y.label) }
                svg x=(left) y=(above) width=(width - left - 32.0) height=(self.height + below)
                    overflow="visible" {
                    (self.inside(&html! {}, curves, front))
                }
            }
        }
    }

    fn inside(&self, behind: &Markup, curves: &Markup, front: &Markup) -> Markup {
        let viewbox = format!("0 0 {WIDTH} {}", self.height);
        html! {
            (behind)
            @for (value, text) in self.y.ticks() {
                @let y = coordinate((1.0 - self.y.part(value)) * self.height);
                line.grid x1="0" x2="100%" y1=(y) y2=(y) {}
                text.tick x="-6" y=(y) dy="4" text-anchor="end" { (text) }
            }
            (columns(self.x, self.height))
            svg x="0" y="0" width="100%" height=(self.height) viewBox=(viewbox)
                preserveAspectRatio="none" { (curves) }
            (front)
        }
    }
}

/// What a curve of this class is, as an entry of a legend.
pub fn key(class: &str, name: &str) -> Markup {
    html! {
        li { svg width="34" height="12" aria-hidden="true" { path class={ "curve " (class) } d="M1 6H33" {} } (name) }
    }
}

/// The vertical grid lines, ticks and label of a horizontal axis below `height` px.
pub fn columns(x: &Axis, height: f64) -> Markup {
    html! {
        @for (value, text) in x.ticks() {
            @let at = percent(x.part(value).clamp(0.0, 1.0));
            line.grid x1=(at) x2=(at) y1="0" y2=(height) {}
            text.tick x=(at) y=(height + 15.0) text-anchor="middle" { (text) }
        }
        text.unit x="50%" y=(height + 33.0) text-anchor="middle" { (x.label) }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ticks_are_round_and_inside() {
        let texts = |lo, hi| -> Vec<String> {
            let axis = Axis::new(lo, hi, "t", 5.0);
            axis.ticks().map(|(_, text)| text).collect()
        };
        assert_eq!(texts(0.0, 1.0), ["0.0", "0.2", "0.4", "0.6", "0.8", "1.0"]);
        assert_eq!(texts(-0.5, 85.0), ["0", "20", "40", "60", "80"]);
        assert_eq!(texts(-310.0, 310.0), ["\u{2212}200", "0", "200"]);
        assert_eq!(texts(3.0, 3.0).len(), 6, "an empty range still has an axis");
    }

    #[test]
    fn curves_skip_what_cannot_be_seen_or_drawn() {
        let axis = Axis::new(0.0, 1.0, "", 5.0);
        let chart = Chart {
            title: "",
            description: "",
            x: &axis,
            y: &axis,
            height: 100.0,
        };
        let mut pen = chart.pen();
        pen.line_to(0.0, 0.0);
        pen.line_to(1e-6, 1e-6);
        pen.line_to(0.5, 0.25);
        pen.line_to(f64::NAN, 0.5);
        pen.line_to(1.0, 1.0);
        assert_eq!(pen.path, "M0 100L500 75M1000 0");
    }
}
