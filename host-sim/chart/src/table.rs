//! A table of a page.

use maud::{Markup, html};

/// Rows that are shown unfolded.
pub const OPEN: usize = 10;

/// Rows beyond this are left to the JSON output.
const MOST: usize = 500;

/// A table whose container scrolls; rows after the first few are folded away.
pub fn table(name: &str, head: &Markup, rows: impl ExactSizeIterator<Item = Markup>) -> Markup {
    let left_out = rows.len().saturating_sub(MOST);
    let rows: Vec<Markup> = rows.take(MOST).collect();
    let part = |rows: &[Markup]| {
        html! {
            div.scroll tabindex="0" role="region" aria-label=(name) {
                table { thead { tr { (head) } } tbody { @for row in rows { tr { (row) } } } }
            }
        }
    };
    let open = if rows.len() > OPEN + 2 {
        OPEN
    } else {
        rows.len()
    };
    let folded = &rows[open..];
    html! {
        (part(&rows[..open]))
        @if !folded.is_empty() {
            details { summary { (folded.len()) " more rows" } (part(folded)) }
        }
        @if left_out > 0 { p.note { (left_out) " further rows are in the JSON output only." } }
    }
}
