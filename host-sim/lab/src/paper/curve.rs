//! A curve of a figure.

use serde::Serialize;

use maud::Markup;
use touchdown_chart::plot::Chart;

/// A curve, in the units that it names.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Curve {
    /// Of the paper.
    pub figure: &'static str,
    /// What it shows.
    pub name: String,
    /// Quantity and unit of the first coordinate.
    pub x: &'static str,
    /// Of the second.
    pub y: &'static str,
    /// In order; null breaks the curve.
    pub points: Vec<Option<[f64; 2]>>,
    /// Style class.
    #[serde(skip)]
    pub class: &'static str,
}

impl Curve {
    /// Draws it in other units: both coordinates times a factor.
    pub fn draw(&self, chart: &Chart<'_>, [x, y]: [f64; 2]) -> Markup {
        let points = self.points.iter().map(|it| it.unwrap_or([f64::NAN; 2]));
        chart.curve(self.class, points.map(|it| (it[0] * x, it[1] * y)))
    }

    /// The greatest second coordinate, 0 or more.
    pub fn top(&self) -> f64 {
        self.points
            .iter()
            .flatten()
            .map(|it| it[1])
            .fold(0.0, f64::max)
    }
}
