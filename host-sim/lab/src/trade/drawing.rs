//! Error against cost, both logarithmic.

use itertools::Itertools;
use maud::{Markup, html};

use super::{Row, Trade};
use touchdown_chart::plot::{Axis, Chart};
use touchdown_chart::text::si;
use touchdown_scene::{Fidelity, Precision};

/// Errors below it are drawn on it.
const LEAST_ERROR: f64 = 1e-17;
/// Errors above it are drawn on it.
const MOST_ERROR: f64 = 10.0;
const HEIGHT: f64 = 440.0;
const WIDTH: f64 = 960.0;

/// Whose cost is drawn.
#[derive(Clone, Copy)]
pub(super) struct Cost {
    label: &'static str,
    /// None where it is not known.
    of: fn(&Row) -> Option<f64>,
    /// Whether the front is about it.
    has_front: bool,
}

/// On this machine.
pub(super) const HERE: Cost = Cost {
    label: "cost here, seconds per simulated second",
    of: |row| Some(row.pace.seconds_per_simulated_second),
    has_front: true,
};

/// On the target.
pub(super) const TARGET: Cost = Cost {
    label: "cost on the target, instructions per simulated second",
    of: |row| Some(row.pace.mcu_instructions_per_step? / row.step_s),
    has_front: false,
};

/// The drawing as a part of a page.
pub(super) fn drawing(trade: &Trade, cost: Cost) -> Markup {
    let plot = Plot::of(&trade.rows, cost);
    plot.chart().draw(&html! {}, &plot.front(), &plot.circles())
}

/// The drawing for this machine as a file of its own.
pub fn svg(trade: &Trade) -> String {
    let plot = Plot::of(&trade.rows, HERE);
    let points = html! { (plot.circles()) (key(&trade.rows)) };
    let file = plot.chart().file(WIDTH, &plot.front(), &points);
    file.into_string()
}

/// What the points mean, inside the drawing.
fn key(rows: &[Row]) -> Markup {
    html! {
        @for (index, (class, name)) in meanings(rows).iter().enumerate() {
            @let y = 0.5 * HEIGHT + 20.0 * index as f64;
            circle class=(class) cx="86%" cy=(y) r="4" {}
            text x="87.5%" y=(y) dy="4" { (name) }
        }
    }
}

/// Style classes of the points, and what they stand for: the rungs of the table, and the number formats.
fn meanings(rows: &[Row]) -> Vec<(String, String)> {
    let shown = |rung: &Fidelity| rows.iter().any(|row| row.rung == *rung);
    let rungs = Fidelity::ALL.iter().copied().filter(shown);
    let rungs = rungs.map(|rung| (format!("rung-{rung} f32"), format!("rung {rung}")));
    let formats = Precision::ALL.map(|it| (format!("levitated {it}"), it.to_string()));
    rungs.chain(formats).collect()
}

struct Plot<'a> {
    rows: &'a [Row],
    of: Cost,
    cost: Axis,
    error: Axis,
}

impl<'a> Plot<'a> {
    fn of(rows: &'a [Row], of: Cost) -> Self {
        let costs = rows.iter().filter_map(|row| (of.of)(row));
        let least = costs.clone().fold(f64::INFINITY, f64::min);
        let most = costs.fold(0.0, f64::max);
        let errors = rows.iter().map(|row| height(row.accuracy.worst));
        let (low, high) = errors.fold((MOST_ERROR, LEAST_ERROR), |(low, high), error| {
            (f64::min(low, error), f64::max(high, error))
        });
        Self {
            rows,
            of,
            cost: Axis::decades(least.min(1e12), most.max(1e-9), of.label, 8.0),
            error: Axis::decades(low, high, "greatest error at impacts 1, 3 and 10", 10.0),
        }
    }

    fn chart(&self) -> Chart<'_> {
        Chart {
            title: "Error against cost",
            description: "Each combination of rung, scheme, numbers, functions and step: its \
                          greatest error at impacts 1, 3 and 10 over its cost; the front is joined.",
            x: &self.cost,
            y: &self.error,
            height: HEIGHT,
        }
    }

    /// Joins the front.
    fn front(&self) -> Markup {
        let front = self.points().filter(|(row, _)| self.is_front(row));
        let places = front.map(|(row, cost)| (cost, height(row.accuracy.worst)));
        let places = places.sorted_by(|a, b| a.0.total_cmp(&b.0));
        self.chart().curve("front", places)
    }

    fn is_front(&self, row: &Row) -> bool {
        row.pareto && self.of.has_front
    }

    /// Those whose cost is known.
    fn points(&self) -> impl Iterator<Item = (&Row, f64)> {
        let rows = self.rows.iter();
        rows.filter_map(|row| Some((row, (self.of.of)(row)?)))
    }

    fn circles(&self) -> Markup {
        html! {
            @for (row, cost) in self.points() {
                @let y = (1.0 - self.error.fraction(height(row.accuracy.worst))) * HEIGHT;
                @let class = format!("rung-{} {}", row.rung, row.precision);
                circle class=(class) cx=(self.cost.percent(cost)) cy=(format!("{y:.1}"))
                    r=(if self.is_front(row) { "6" } else { "3.5" }) {
                    title { (caption(row)) }
                }
            }
        }
    }
}

/// Where an error is drawn.
fn height(error: f64) -> f64 {
    error.clamp(LEAST_ERROR, MOST_ERROR)
}

fn caption(row: &Row) -> String {
    format!(
        "{}, step {}: error {:.1e}, {:.1} ns a step",
        row.name(),
        si(row.step_s, "s"),
        row.accuracy.worst,
        row.pace.ns_per_step
    )
}

/// What the points mean.
pub(super) fn legend(rows: &[Row]) -> Markup {
    html! {
        ul.legend {
            @for (class, name) in meanings(rows) {
                li {
                    svg width="12" height="12" aria-hidden="true" { circle class=(class) cx="6" cy="6" r="4" {} }
                    (name)
                }
            }
            li { "large and joined: the front" }
        }
    }
}
