//! Error against cost, both logarithmic.

use maud::{Markup, html};

use super::Trade;
use super::row::Row;
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
#[derive(Clone, Copy, PartialEq, Eq)]
pub(super) enum Cost {
    /// Seconds per simulated second on this machine.
    Here,
    /// Instructions per simulated second on the target.
    Target,
}

impl Cost {
    /// None where it is not known.
    fn of(self, row: &Row) -> Option<f64> {
        match self {
            Self::Here => Some(row.pace.seconds_per_simulated_second),
            Self::Target => row
                .pace
                .mcu_instructions_per_step
                .map(|count| count / row.step_s),
        }
    }

    fn label(self) -> &'static str {
        match self {
            Self::Here => "cost here, seconds per simulated second",
            Self::Target => "cost on the target, instructions per simulated second",
        }
    }
}

/// The drawing as a part of a page.
pub(super) fn drawing(trade: &Trade, cost: Cost) -> Markup {
    let plot = Plot::of(&trade.rows, cost);
    plot.chart().draw(&html! {}, &plot.front(), &plot.points())
}

/// The drawing for this machine as a file of its own.
pub fn svg(trade: &Trade) -> String {
    let plot = Plot::of(&trade.rows, Cost::Here);
    let points = html! { (plot.points()) (key(&trade.rows)) };
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
        let costs = rows.iter().filter_map(|row| of.of(row));
        let least = costs.clone().fold(f64::INFINITY, f64::min);
        let most = costs.fold(0.0, f64::max);
        let errors = rows.iter().map(|row| height(row.accuracy.worst));
        let (low, high) = errors.fold((MOST_ERROR, LEAST_ERROR), |(low, high), error| {
            (f64::min(low, error), f64::max(high, error))
        });
        Self {
            rows,
            of,
            cost: Axis::decades(least.min(1e12), most.max(1e-9), of.label(), 8.0),
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

    /// Joins the front, which is about the cost here.
    fn front(&self) -> Markup {
        let mut front: Vec<&Row> = self.rows.iter().filter(|row| row.pareto).collect();
        front.sort_by(|a, b| {
            a.pace
                .seconds_per_simulated_second
                .total_cmp(&b.pace.seconds_per_simulated_second)
        });
        let chart = self.chart();
        let mut pen = chart.pen();
        for row in front.into_iter().filter(|_| self.of == Cost::Here) {
            pen.line_to(
                row.pace.seconds_per_simulated_second,
                height(row.accuracy.worst),
            );
        }
        pen.finish("front")
    }

    fn points(&self) -> Markup {
        let known = self
            .rows
            .iter()
            .filter_map(|row| Some((row, self.of.of(row)?)));
        html! {
            @for (row, cost) in known {
                @let y = (1.0 - self.error.fraction(height(row.accuracy.worst))) * HEIGHT;
                @let class = format!("rung-{} {}", row.rung, row.precision);
                @let large = row.pareto && self.of == Cost::Here;
                circle class=(class) cx=(self.cost.percent(cost)) cy=(format!("{y:.1}"))
                    r=(if large { "6" } else { "3.5" }) {
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
