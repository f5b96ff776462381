//! Where the energy is, and where it went.

use maud::{Markup, html};
use touchdown_base::ledger::Ledger;
use touchdown_chart::table::table;
use touchdown_chart::text::si;

/// The ledger as a table, each amount with its part of what there was.
pub fn energy(ledger: &Ledger) -> Markup {
    let stored = ledger.stored.iter().map(|it| ("in", it));
    let gone = ledger.gone.iter().map(|it| ("gone:", it));
    let rows: Vec<_> = stored.chain(gone).collect();
    let table = table("Energy of the model", &rows)
        .words("Energy", |it| format!("{} {}", it.0, it.1.name))
        .number("at the end", |it| si(it.1.energy_j, "J"))
        .number("part of the start", |it| {
            format!("{:.3e}", it.1.energy_j / ledger.start_j)
        });
    html! {
        p { "At the release " (si(ledger.start_j, "J")) " were stored. Not accounted for: " (si(ledger.imbalance_j(), "J")) ", which is rounding." }
        (table.draw())
    }
}
