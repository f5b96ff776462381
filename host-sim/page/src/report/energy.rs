//! Where the energy is, and where it went.

use maud::{Markup, html};
use touchdown_base::ledger::{Entry, Ledger};
use touchdown_chart::table::table;
use touchdown_chart::text::si;

/// The ledger as a table, each amount with its part of what there was.
pub fn energy(ledger: &Ledger) -> Markup {
    let head = html! {
        th { "Energy" }
        th.number { "at the end" }
        th.number { "part of the start" }
    };
    let row = |kind: &str, entry: &Entry| {
        html! {
            td { (kind) " " (entry.name) }
            td.number { (si(entry.energy_j, "J")) }
            td.number { (format!("{:.3e}", entry.energy_j / ledger.start_j)) }
        }
    };
    let stored = ledger.stored.iter().map(|entry| row("in", entry));
    let gone = ledger.gone.iter().map(|entry| row("gone:", entry));
    html! {
        p { "At the release " (si(ledger.start_j, "J")) " were stored. Not accounted for: " (si(ledger.imbalance_j(), "J")) ", which is rounding." }
        (table("Energy of the model", &head, stored.chain(gone).collect::<Vec<_>>().into_iter()))
    }
}
