//! Probability of whirl over the parameters, as pictures.

use maud::{Markup, html};
use toml::Value;

use super::parameter::{as_number, short, text};
use super::plan::{Listed, Plan};
use super::summary::Point;
use touchdown_chart::plot::{Axis, Chart};

const HEIGHT: f64 = 320.0;
/// Maps of a page; each is of the two parameters that change fastest, at values of the others.
const MAPS: usize = 24;

/// The picture for as many parameters as there are.
pub(super) fn drawn(plan: &Plan, points: &[Point]) -> Markup {
    match plan.listed.as_slice() {
        [] => html! {},
        [(key, values)] if values.iter().all(|it| as_number(it).is_some()) => {
            curve(key, values, points)
        }
        [column] => map(None, column, points),
        [others @ .., row, column] => {
            let size = row.1.len() * column.1.len();
            let maps = points.chunks_exact(size);
            html! {
                @for part in maps.take(MAPS) {
                    @if !others.is_empty() { h3 { (at(plan, part, others.len())) } }
                    (map(Some(row), column, part))
                }
                @if points.len() > MAPS * size {
                    p.note { "The others are in points.csv." }
                }
            }
        }
    }
}

fn at(plan: &Plan, part: &[Point], others: usize) -> String {
    let values = part.first().map(|first| plan.values(first.point));
    let pairs: Vec<_> = (plan.listed.iter().zip(values.unwrap_or_default()))
        .take(others)
        .map(|((key, _), value)| format!("{key} = {}", short(&text(value))))
        .collect();
    pairs.join(", ")
}

fn curve(key: &str, values: &[Value], points: &[Point]) -> Markup {
    let places = values.iter().filter_map(as_number);
    let mut order: Vec<_> = places.zip(points).collect();
    order.sort_by(|a, b| a.0.total_cmp(&b.0));
    let [low, high] = [order.first(), order.last()].map(|it| it.map_or(0.0, |it| it.0));
    let x = Axis::new(low, high, key, 8.0);
    let y = Axis::new(
        0.0,
        100.0,
        "probability of whirl, %, with its 95 % interval",
        6.0,
    );
    let title = format!("Whirl over {key}");
    let chart = Chart {
        title: &title,
        description: &title,
        x: &x,
        y: &y,
        height: HEIGHT,
    };
    let values = |it: &Point| [it.whirl_low, it.whirl_high, it.whirl_probability];
    let curves = html! {
        @for (which, class) in ["limit", "limit", "impact"].into_iter().enumerate() {
            (chart.curve(class, order.iter().map(|it| (it.0, 100.0 * values(it.1)[which]))))
        }
    };
    chart.plain(&curves)
}

/// A table whose cells are the deeper in colour the more probable whirl is.
fn map(row: Option<&Listed>, (column, columns): &Listed, points: &[Point]) -> Markup {
    let name = |index: usize| row.and_then(|(_, rows)| Some(short(&text(rows.get(index)?))));
    let lines = points.chunks(columns.len().max(1));
    html! {
        div.scroll {
            table.map {
                caption {
                    "Probability of whirl, %: "
                    @if let Some((row, _)) = row { "down " (row) ", " }
                    "across " (column)
                }
                thead {
                    tr {
                        th {}
                        @for value in columns { th.number scope="col" { (short(&text(value))) } }
                    }
                }
                tbody {
                    @for (index, line) in lines.enumerate() {
                        tr {
                            th scope="row" { (name(index).unwrap_or_default()) }
                            @for point in line { (cell(point)) }
                        }
                    }
                }
            }
        }
    }
}

fn cell(point: &Point) -> Markup {
    let percent = 100.0 * point.whirl_probability;
    let hint = format!(
        "{percent:.2} % of {} drops, {:.2} to {:.2} %",
        point.drops,
        100.0 * point.whirl_low,
        100.0 * point.whirl_high
    );
    let shade = format!(
        "background: rgb(213 94 0 / {:.3})",
        0.85 * point.whirl_probability
    );
    html! { td.number title=(hint) style=(shade) { (format!("{percent:.0}")) } }
}
