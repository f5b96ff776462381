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
/// Style classes of measured curves, in turn.
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
    table(name, rows)
        .words("Case", |it| it.case.clone())
        .words("Quantity", |it| it.quantity)
        .number("Measured", |it| {
            it.measured().map_or("\u{2013}".to_owned(), short)
        })
        .number("Target", |it| {
            format!("{} {}", it.sense(), short(it.target))
        })
        .words("Verdict", |it| match (it.holds, it.undecided) {
            (true, _) => "holds",
            (_, true) => "undecided",
            _ => "does not hold",
        })
        .words("More", |it| it.note.clone())
        .draw()
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
                (chart.plain(&lines(&chart, curves)))
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
    if curves[index].limit {
        return "limit";
    }
    CLASSES[curves[..index].iter().filter(|it| !it.limit).count() % CLASSES.len()]
}

fn lines(chart: &Chart<'_>, curves: &[Curve]) -> Markup {
    html! {
        @for (index, curve) in curves.iter().enumerate() {
            (chart.curve(class(curves, index), curve.points.iter().map(|it| (it[0], it[1]))))
        }
    }
}

fn legend(curves: &[Curve]) -> Markup {
    html! {
        ul.legend {
            @for (index, curve) in curves.iter().enumerate() {
                li {
                    svg width="24" height="12" aria-hidden="true" {
                        path class={ "curve " (class(curves, index)) } d="M1 6H23" {}
                    }
                    " " (curve.name)
                }
            }
        }
    }
}

fn confusion(name: &str, truth: &[&'static str], told: &[&str], counts: &[Vec<u64>]) -> Markup {
    let rows: Vec<_> = truth.iter().zip(counts).collect();
    let all = |counts: &[u64]| counts.iter().sum::<u64>();
    let mut table = table(name, &rows).names("", |it| *it.0);
    for (index, name) in told.iter().enumerate() {
        table = table.number(name, move |it| match it.1[index] {
            0 => "\u{2013}".to_owned(),
            count => format!("{:.2}", 100.0 * count as f64 / all(it.1) as f64),
        });
    }
    table.number("all", |it| all(it.1)).draw()
}
