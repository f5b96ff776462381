//! Rows and pictures as one page.

use maud::{Markup, html};

use super::table::short;
use super::{Findings, Row, Score};
use touchdown_chart::shell::page as shell;
use touchdown_chart::table::table;

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
                @for figure in figures { (figure.draw()) }
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
