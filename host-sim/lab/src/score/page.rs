//! Rows and pictures as one page.

use maud::{Markup, html};

use super::figure::{Curve, Figure};
use super::row::Row;
use super::table::short;
use super::{Findings, Score};
use touchdown_chart::plot::{Axis, Chart};
use touchdown_chart::shell::page as shell;
use touchdown_chart::table::table;

const HEIGHT: f64 = 320.0;
/// Style classes of measured curves, in turn; a limit has that of the curve before it.
const CLASSES: [&str; 5] = ["free-fall", "rolling", "impact", "sliding", "motion"];

/// Writes the page.
pub fn page(score: &Score) -> String {
    let held = score.rows().filter(|row| row.holds).count();
    let undecided = score.rows().filter(|row| row.undecided).count();
    let body = html! {
        header {
            p.kind { "Detector" }
            h1 {
                (held) " of " (score.rows().count()) " targets hold"
                @if undecided > 0 { ", " (undecided) " undecided" }
            }
            p.note {
                (score.extent()) ". Truth: the independent reference, and what was put in. Bound: "
                "sequential test of the known signature at one false alarm in 10\u{2079} samples."
            }
        }
        @for (group, Findings { rows, figures }) in &score.groups {
            section {
                h2 { (group.name) }
                p.note { (group.about) }
                @for figure in figures { (drawn(figure)) }
                (rows_of(group.name, rows))
            }
        }
    };
    shell("Score of the detector \u{2013} touchdown", &body).into_string()
}

fn rows_of(name: &str, rows: &[Row]) -> Markup {
    let head = html! {
        th { "Case" }
        th { "Quantity" }
        th.number { "Measured" }
        th.number { "Target" }
        th { "Verdict" }
        th { "More" }
    };
    let cells = |row: &Row| {
        html! {
            td { (row.case) }
            td { (row.quantity) }
            td.number { (row.measured().map_or("\u{2013}".to_owned(), short)) }
            td.number { (if row.at_least { "\u{2265} " } else { "\u{2264} " }) (short(row.target)) }
            td { (if row.holds { "holds" } else if row.undecided { "undecided" } else { "does not hold" }) }
            td { (row.note) }
        }
    };
    table(name, &head, rows.iter().map(cells))
}

fn drawn(figure: &Figure) -> Markup {
    match figure {
        Figure::Curves {
            title,
            x,
            y,
            decades,
            curves,
        } => {
            let [x, y] = [(0, x), (1, y)].map(|(part, label)| axis(curves, part, label, *decades));
            let chart = Chart {
                title,
                description: title,
                x: &x,
                y: &y,
                height: HEIGHT,
            };
            html! {
                h3 { (title) }
                (legend(curves))
                (chart.draw(&html! {}, &lines(&chart, curves), &html! {}))
            }
        }
        Figure::Confusion {
            title,
            unit,
            truth,
            told,
            counts,
        } => html! {
            h3 { (title) }
            p.note { "Rows: true. Columns: told. Share of the row in %; in the last column the " (unit) "." }
            (confusion(title, truth, told, counts))
        },
    }
}

fn axis(curves: &[Curve], part: usize, label: &str, decades: bool) -> Axis {
    let values = curves.iter().flat_map(|it| &it.points).map(|it| it[part]);
    let values = values.filter(|it| it.is_finite() && (!decades || *it > 0.0));
    let (lo, hi) = values.fold((f64::INFINITY, 0.0), |(lo, hi), it| {
        (f64::min(lo, it), f64::max(hi, it))
    });
    if decades {
        let hi = if hi > 0.0 { hi } else { 1.0 };
        Axis::decades(lo.min(hi), hi, label, 8.0)
    } else {
        Axis::new(0.0, hi, label, 8.0)
    }
}

fn class(curves: &[Curve], index: usize) -> &'static str {
    let before = curves[..=index].iter().filter(|it| !it.limit).count();
    CLASSES[before.saturating_sub(1) % CLASSES.len()]
}

fn lines(chart: &Chart<'_>, curves: &[Curve]) -> Markup {
    html! {
        @for (index, curve) in curves.iter().enumerate() {
            @let mut pen = chart.pen();
            @for [x, y] in &curve.points { ({ pen.line_to(*x, *y); "" }) }
            (pen.finish(if curve.limit { "limit" } else { class(curves, index) }))
        }
    }
}

fn legend(curves: &[Curve]) -> Markup {
    html! {
        ul.legend {
            @for (index, curve) in curves.iter().enumerate() {
                @let style = if curve.limit { "limit" } else { class(curves, index) };
                li {
                    svg width="24" height="12" aria-hidden="true" {
                        path class={ "curve " (style) } d="M1 6H23" {}
                    }
                    " " (curve.name)
                }
            }
        }
    }
}

fn confusion(name: &str, truth: &[&str], told: &[&str], counts: &[Vec<u64>]) -> Markup {
    let head = html! {
        th { "" }
        @for name in told { th.number { (name) } }
        th.number { "all" }
    };
    let rows: Vec<_> = truth.iter().zip(counts).collect();
    let cells = |(name, counts): &(&&str, &Vec<u64>)| {
        let all: u64 = counts.iter().sum();
        html! {
            th { (name) }
            @for count in *counts {
                td.number {
                    (if *count == 0 { "\u{2013}".to_owned() } else {
                        format!("{:.2}", 100.0 * *count as f64 / all as f64)
                    })
                }
            }
            td.number { (all) }
        }
    };
    table(name, &head, rows.iter().map(cells))
}
