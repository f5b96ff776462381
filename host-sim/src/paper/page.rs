//! Numbers and figures as one page.

use maud::{Markup, html};

use super::table::cell;
use super::{Paper, Row};
use crate::report::page as shell;

/// Writes the page.
pub fn page(paper: &Paper) -> String {
    let body = html! {
        header {
            p.kind { "Source paper" }
            h1 { "Impact dynamics of high speed rotors in retainer bearings" }
        }
        section { h2 { "Numbers" } (numbers(&paper.rows)) }
    };
    shell("The source paper \u{2013} touchdown", &body).into_string()
}

fn numbers(rows: &[Row]) -> Markup {
    html! {
        @for row in rows { p { (row.item) ": " (cell(row.ours)) } }
    }
}
