//! The table and its drawing as one page.

use maud::{Markup, html};

use super::drawing::{HERE, TARGET, drawing, legend};
use super::parts::{Effect, drawing as parts_drawing};
use super::{Row, Trade};
use touchdown_chart::shell::page as shell;
use touchdown_chart::table::table;
use touchdown_chart::text::si;

/// Writes the page.
pub fn page(trade: &Trade) -> String {
    let all = || trade.rows.iter();
    let counted = all().any(|row| row.pace.mcu_instructions_per_step.is_some());
    let body = html! {
        header {
            p.kind { "Accuracy against cost" }
            h1 { (trade.scene) }
            p.note {
                "Measured over the first " (si(trade.measured, "s")) ". Errors against the independent \
                 reference: the greatest of time in T, position in clearances and velocity in V just \
                 after an impact. Cost: the quickest of the runs that 10 ms were enough for, one at least, on the \
                 machine that wrote this page, with the rotor's place after each step. Instructions: counted in the emulator, mean of \
                 the run."
            }
        }
        @if !trade.parts.without.is_empty() {
            section {
                h2 { "What each part is worth" }
                p.note {
                    (trade.parts.drops) " drops with the whole machine, and the same without the part. Starts within \
                     half of the clearance and 20 mm/s; friction and mounts known to a factor of 2, restitution to 0.1."
                }
                (parts_drawing(&trade.parts))
                details { summary { "All numbers" } (worth(trade)) }
            }
        }
        section {
            h2 { "Error against cost" }
            p.note {
                "Rung rigid solves from change to change, so its error does not depend on the step. Rung \
                 moreau is of first order. Rung hertz is another law, whose contacts last: it does not \
                 converge to the rigid laws, and gives force and contact time, which they do not. s/s: \
                 seconds per simulated second. Errors at or above 10, and missed impacts, are drawn at 10."
            }
            (legend(&trade.rows))
            h3 { "Here" }
            (drawing(trade, HERE))
            @if counted {
                h3 { "On the target" }
                (drawing(trade, TARGET))
            }
        }
        section { h2 { "Front" } (rows("Front", all().filter(|row| row.pareto))) }
        section { h2 { "All combinations" } (rows("All combinations", all())) }
    };
    shell("Accuracy against cost \u{2013} touchdown", &body).into_string()
}

fn worth(trade: &Trade) -> Markup {
    let without = trade.parts.without.iter();
    let all: Vec<(&str, &Effect)> = without
        .flat_map(|it| it.changes.iter().map(|change| (it.part, change)))
        .collect();
    table("What each part is worth", &all)
        .words("Without", |it| it.0)
        .words("Quantity", |it| it.1.quantity)
        .number("Whole", |it| it.1.shown(it.1.whole))
        .number("Without it", |it| it.1.shown(it.1.without))
        .number("Effect, from", |it| it.1.shown(it.1.interval[0]))
        .number("to (95 %)", |it| it.1.shown(it.1.interval[1]))
        .words("Seen", |it| if it.1.is_seen() { "yes" } else { "no" })
        .draw()
}

fn rows<'a>(name: &str, rows: impl Iterator<Item = &'a Row>) -> Markup {
    let rows: Vec<&Row> = rows.collect();
    let error = |value: Option<f64>| value.map_or("\u{2013}".to_owned(), |it| format!("{it:.1e}"));
    table(name, &rows)
        .words("Combination", |it| it.name())
        .number("Step", |it| si(it.step_s, "s"))
        .number("Impact 1", |it| error(it.accuracy.error_impact_1))
        .number("Impact 3", |it| error(it.accuracy.error_impact_3))
        .number("Impact 10", |it| error(it.accuracy.error_impact_10))
        .number("Contact, T", |it| error(it.accuracy.contact_error))
        .words("Regime", |it| {
            if it.accuracy.regime_ok {
                "right"
            } else {
                "wrong"
            }
        })
        .number("Energy", |it| error(Some(it.accuracy.energy_drift)))
        .number("ns a step", |it| format!("{:.1}", it.pace.ns_per_step))
        .number("s/s", |it| {
            error(Some(it.pace.seconds_per_simulated_second))
        })
        .number("Instr. a step", |it| {
            let count = it.pace.mcu_instructions_per_step;
            count.map_or("\u{2013}".to_owned(), |it| format!("{it:.0}"))
        })
        .draw()
}
