//! Small inline SVG charts with linear axes.
//!
//! A chart has a fixed height and the width of its container: positions along x are percentages, curves
//! are stretched by a nested viewBox, and text keeps its size, so the same drawing is legible on a phone
//! and on paper.

use maud::{Markup, html};
use std::fmt::Write;

/// Drawing units across a curve's width.
const WIDTH: f64 = 1000.0;

/// Points nearer than this to the last one drawn are left out, in drawing units.
const RESOLUTION: f64 = 0.35;

/// A linear axis, in the unit that its label names.
#[derive(Clone, Debug)]
pub struct Axis {
    /// Value at the left or lower end.
    pub lo: f64,
    /// Value at the right or upper end.
    pub hi: f64,
    /// Quantity and unit.
    pub label: String,
    /// Distance of the ticks.
    pub step: f64,
}

impl Axis {
    /// An axis with about `ticks` ticks at multiples of 1, 2 or 5.
    pub fn new(lo: f64, hi: f64, label: &str, ticks: f64) -> Self {
        let hi = if hi > lo { hi } else { lo + 1.0 };
        let raw = (hi - lo) / ticks;
        let power = 10f64.powf(raw.log10().floor());
        let nice = [1.0, 2.0, 5.0].into_iter().find(|it| it * power >= raw);
        Self {
            lo,
            hi,
            label: label.to_owned(),
            step: nice.unwrap_or(10.0) * power,
        }
    }

    /// 0 at `lo`, 1 at `hi`.
    pub fn fraction(&self, value: f64) -> f64 {
        (value - self.lo) / (self.hi - self.lo)
    }

    /// Position along x as an SVG percentage, kept within the chart.
    pub fn percent(&self, value: f64) -> String {
        format!("{:.2}%", 100.0 * self.fraction(value).clamp(0.0, 1.0))
    }

    /// Whether the value lies on the axis.
    pub fn shows(&self, value: f64) -> bool {
        (self.lo..=self.hi).contains(&value)
    }

    /// Values and texts of the ticks.
    pub fn ticks(&self) -> Vec<(f64, String)> {
        let decimals = (-self.step.log10().floor()).max(0.0) as usize;
        let first = (self.lo / self.step - 1e-9).ceil() as i64;
        let last = (self.hi / self.step + 1e-9).floor() as i64;
        (first..=last)
            .map(|number| number as f64 * self.step)
            .map(|value| (value, minus(&format!("{value:.decimals$}"))))
            .collect()
    }
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
    x: &'a Axis,
    y: &'a Axis,
    height: f64,
    path: String,
    last: Option<(f64, f64)>,
}

impl<'a> Pen<'a> {
    /// A pen for a chart of that height, px.
    pub fn new(x: &'a Axis, y: &'a Axis, height: f64) -> Self {
        Self {
            x,
            y,
            height,
            path: String::new(),
            last: None,
        }
    }

    fn place(&self, x: f64, y: f64) -> Option<(f64, f64)> {
        let at = (self.x.fraction(x), 1.0 - self.y.fraction(y));
        let near = at.0.abs() < 3.0 && at.1.abs() < 3.0;
        near.then_some((at.0 * WIDTH, at.1 * self.height))
    }

    /// Goes on to a point; where it is not finite or far outside, the curve breaks.
    pub fn line_to(&mut self, x: f64, y: f64) {
        let Some(to) = self.place(x, y) else {
            return self.lift();
        };
        match self.last {
            Some(from) if f64::hypot(to.0 - from.0, to.1 - from.1) < RESOLUTION => return,
            Some(_) => self.path.push('L'),
            None => self.path.push('M'),
        }
        self.push(to);
        self.last = Some(to);
    }

    /// A dot, to be stroked with round caps.
    pub fn dot(&mut self, x: f64, y: f64) {
        self.lift();
        if let Some(at) = self.place(x, y) {
            self.path.push('M');
            self.push(at);
            self.path.push_str("h0");
        }
    }

    /// Breaks the curve.
    pub fn lift(&mut self) {
        self.last = None;
    }

    fn push(&mut self, (x, y): (f64, f64)) {
        let _ = write!(self.path, "{} {}", coordinate(x), coordinate(y));
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
        Pen::new(self.x, self.y, self.height)
    }

    /// Draws it: `behind` under the grid and `front` over the curves, both with x as percentages.
    pub fn draw(&self, behind: &Markup, curves: &Markup, front: &Markup) -> Markup {
        let viewbox = format!("0 0 {WIDTH} {}", self.height);
        html! {
            div.chart {
                p.unit { (self.y.label) }
                svg role="img" width="100%" height=(self.height + 40.0) {
                    title { (self.title) }
                    desc { (self.description) }
                    (behind)
                    (self.rows())
                    (columns(self.x, self.height))
                    svg x="0" y="0" width="100%" height=(self.height) viewBox=(viewbox)
                        preserveAspectRatio="none" { (curves) }
                    (front)
                }
            }
        }
    }

    fn rows(&self) -> Markup {
        html! {
            @for (value, text) in self.y.ticks() {
                @let y = coordinate((1.0 - self.y.fraction(value)) * self.height);
                line.grid x1="0" x2="100%" y1=(y) y2=(y) {}
                text.tick x="-6" y=(y) dy="4" text-anchor="end" { (text) }
            }
        }
    }
}

/// The vertical grid lines, ticks and label of a horizontal axis below `height` px.
pub fn columns(x: &Axis, height: f64) -> Markup {
    html! {
        @for (value, text) in x.ticks() {
            @let at = x.percent(value);
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
            axis.ticks().into_iter().map(|(_, text)| text).collect()
        };
        assert_eq!(texts(0.0, 1.0), ["0.0", "0.2", "0.4", "0.6", "0.8", "1.0"]);
        assert_eq!(texts(-0.5, 85.0), ["0", "20", "40", "60", "80"]);
        assert_eq!(texts(-310.0, 310.0), ["\u{2212}200", "0", "200"]);
        assert_eq!(texts(3.0, 3.0).len(), 6, "an empty range still has an axis");
    }

    #[test]
    fn curves_skip_what_cannot_be_seen_or_drawn() {
        let axis = Axis::new(0.0, 1.0, "", 5.0);
        let mut pen = Pen::new(&axis, &axis, 100.0);
        pen.line_to(0.0, 0.0);
        pen.line_to(1e-6, 1e-6);
        pen.line_to(0.5, 0.25);
        pen.line_to(f64::NAN, 0.5);
        pen.line_to(1.0, 1.0);
        assert_eq!(pen.path, "M0 100L500 75M1000 0");
    }
}
