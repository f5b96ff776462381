//! What is drawn of a group.

use maud::{Markup, html};
use serde::Serialize;
use touchdown_chart::plot::{Axis, Chart};
use touchdown_chart::table::table;

const HEIGHT: f64 = 320.0;
/// Style classes of measured curves, in turn.
const CLASSES: [&str; 5] = ["free-fall", "rolling", "impact", "sliding", "motion"];

/// A picture's numbers.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[serde(tag = "kind", rename_all = "snake_case")]
pub enum Figure {
    /// How much.
    Curves(Curves),
    /// How often.
    Confusion(Confusion),
}

impl Figure {
    /// As a part of a page.
    pub fn draw(&self) -> Markup {
        match self {
            Self::Curves(it) => it.draw(),
            Self::Confusion(it) => it.draw(),
        }
    }
}

/// Curves over two axes.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Curves {
    /// Heading.
    pub title: &'static str,
    /// Quantity and unit along x.
    pub x: &'static str,
    /// Along y.
    pub y: &'static str,
    /// Whether both axes are logarithmic.
    pub decades: bool,
    /// All.
    pub curves: Vec<Curve>,
}

/// How often what is true (rows) was told as what (columns).
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Confusion {
    /// Heading.
    pub title: &'static str,
    /// What is counted.
    pub unit: &'static str,
    /// Names of the rows.
    pub truth: Vec<&'static str>,
    /// Names of the columns.
    pub told: Vec<&'static str>,
    /// By row, then column.
    pub counts: Vec<Vec<u64>>,
}

/// One curve.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Curve {
    /// For the legend.
    pub name: String,
    /// Whether it is a limit and not measured.
    pub limit: bool,
    /// x and y.
    pub points: Vec<[f64; 2]>,
}

impl Curve {
    /// Measured.
    pub fn new(name: impl Into<String>, points: Vec<[f64; 2]>) -> Self {
        Self {
            name: name.into(),
            limit: false,
            points,
        }
    }

    /// What it is held against.
    pub fn limit(name: impl Into<String>, points: Vec<[f64; 2]>) -> Self {
        Self {
            limit: true,
            ..Self::new(name, points)
        }
    }
}

impl Curves {
    fn draw(&self) -> Markup {
        let (x, y) = (self.axis(0, self.x), self.axis(1, self.y));
        let chart = Chart {
            title: self.title,
            description: self.title,
            x: &x,
            y: &y,
            height: HEIGHT,
        };
        let mut measured = CLASSES.into_iter().cycle();
        let class = |it: &Curve| match it.limit {
            true => Some("limit"),
            false => measured.next(),
        };
        let classes: Vec<_> = self.curves.iter().flat_map(class).collect();
        let curves = || self.curves.iter().zip(&classes);
        let lines = html! {
            @for (curve, class) in curves() {
                (chart.curve(class, curve.points.iter().map(|it| (it[0], it[1]))))
            }
        };
        html! {
            h3 { (self.title) }
            ul.legend {
                @for (curve, class) in curves() {
                    li {
                        svg width="24" height="12" aria-hidden="true" {
                            path class={ "curve " (class) } d="M1 6H23" {}
                        }
                        " " (curve.name)
                    }
                }
            }
            (chart.plain(&lines))
        }
    }

    fn axis(&self, part: usize, label: &str) -> Axis {
        let points = self.curves.iter().flat_map(|it| &it.points);
        let values = points.map(|it| it[part]);
        let values = values.filter(|it| it.is_finite() && (!self.decades || *it > 0.0));
        let (lo, hi) = values.fold((f64::INFINITY, 0.0), |(lo, hi), it| {
            (f64::min(lo, it), f64::max(hi, it))
        });
        if self.decades {
            let hi = if hi > 0.0 { hi } else { 1.0 };
            Axis::decades(lo.min(hi), hi, label, 8.0)
        } else {
            Axis::new(0.0, hi, label, 8.0)
        }
    }
}

impl Confusion {
    fn draw(&self) -> Markup {
        let rows: Vec<_> = self.truth.iter().zip(&self.counts).collect();
        let all = |counts: &[u64]| counts.iter().sum::<u64>();
        let mut table = table(self.title, &rows).names("", |it| *it.0);
        for (index, name) in self.told.iter().enumerate() {
            table = table.number(name, move |it| match it.1[index] {
                0 => "\u{2013}".to_owned(),
                count => format!("{:.2}", 100.0 * count as f64 / all(it.1) as f64),
            });
        }
        html! {
            h3 { (self.title) }
            p.note {
                "Rows: true. Columns: told. Share of the row in %; in the last column the " (self.unit) "."
            }
            (table.number("all", |it| all(it.1)).draw())
        }
    }
}

/// Share of `values` in steps of `width` from 0 on, as a staircase. What is beyond `most` counts but is
/// not drawn.
pub fn histogram(values: &[f64], width: f64, most: f64) -> Vec<[f64; 2]> {
    let whole = values.len().max(1) as f64;
    let step = |bin: usize| {
        let left = bin as f64 * width;
        let inside = |it: &&f64| (*it / width).floor() == bin as f64;
        let share = values.iter().filter(inside).count() as f64 / whole;
        [[left, share], [left + width, share]]
    };
    let bins = (most / width).round() as usize;
    (0..bins).flat_map(step).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_histogram_counts_what_it_does_not_draw() {
        let steps = histogram(&[0.1, 0.3, 0.3, f64::INFINITY], 0.25, 0.5);
        assert_eq!(steps, [[0.0, 0.25], [0.25, 0.25], [0.25, 0.5], [0.5, 0.5]]);
    }
}
