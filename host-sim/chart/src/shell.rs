//! The shell of a page.

use maud::{DOCTYPE, Markup, PreEscaped, html};
use touchdown_base::plain::shown;

/// What adds a cursor and a zoom to the charts.
pub const SCRIPT: &str = include_str!("cursor.js");

/// A page with style and script, complete without anything else.
pub fn page(title: &str, body: &Markup) -> Markup {
    let page = html! {
        (DOCTYPE)
        html lang="en" {
            head {
                meta charset="utf-8";
                meta name="viewport" content="width=device-width, initial-scale=1";
                meta name="color-scheme" content="light dark";
                title { (title) }
                style { (PreEscaped(include_str!("style.css"))) }
            }
            body {
                main { (body) }
                script { (PreEscaped(SCRIPT)) }
            }
        }
    };
    // Titles and names come from files: what a browser would obey is shown.
    PreEscaped(shown(&page.into_string()).into_owned())
}
