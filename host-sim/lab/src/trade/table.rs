//! The table as text, in 80 columns.

use super::parts;
use super::{Row, Trade};
use touchdown_base::paint::Paint;

/// Steps that have a column, us.
const COLUMNS: [u32; 4] = [1, 10, 100, 1000];

/// What each part is worth, worst errors by combination and step, then the front.
pub fn table(trade: &Trade, paint: Paint) -> String {
    let mut text = paint.bold(&trade.scene) + "\n\n";
    text += &parts::text(&trade.parts, paint);
    text += &paint.bold("Every combination of scheme, numbers, math and step");
    text += &format!(
        "\nthe first {} s; error: greatest of time/T, position/rho0 and velocity/V at\n\
         impacts 1, 3 and 10 against the reference; -: refused, or an impact missing\n\n",
        trade.measured
    );
    let head = format!(
        "{:<31}{:>8}{:>8}{:>8}{:>8}{:>8}{:>7}",
        "rung, scheme, numbers, math", "1 us", "10 us", "100 us", "1 ms", "ns/step", "instr."
    );
    text += &(paint.bold(&head) + "\n");
    for group in trade.rows.chunk_by(|a, b| a.name() == b.name()) {
        text += &line(group);
    }
    text += "ns/step and instructions a step on the target: at a step of 10 us\n\n";
    text += &(paint.bold("nothing is both quicker here and closer than") + "\n");
    let mut front: Vec<&Row> = trade.rows.iter().filter(|row| row.pareto).collect();
    front.sort_by(|a, b| a.accuracy.worst.total_cmp(&b.accuracy.worst));
    for row in front {
        let step_us = (row.step_s * 1e6 * 1e3).round() / 1e3;
        text += &format!(
            "{:<32} step {step_us:>5} us{:>9.1e}{:>10.1e} s a simulated s\n",
            row.name(),
            row.accuracy.worst,
            row.pace.seconds_per_simulated_second,
        );
    }
    text
}

fn line(group: &[Row]) -> String {
    let at = |step: u32| {
        group
            .iter()
            .find(|row| (row.step_s * 1e6 - f64::from(step)).abs() < 0.5)
    };
    let errors: String = COLUMNS
        .into_iter()
        .map(|step| match at(step) {
            Some(row) if row.accuracy.worst.is_finite() => format!("{:>8.1e}", row.accuracy.worst),
            _ => format!("{:>8}", "-"),
        })
        .collect();
    let middle = at(10);
    let pace = middle.map_or("-".to_owned(), |row| format!("{:.1}", row.pace.ns_per_step));
    let target = middle
        .and_then(|row| row.pace.mcu_instructions_per_step)
        .map_or("-".to_owned(), |count| format!("{count:.0}"));
    let name = group.first().map(Row::name).unwrap_or_default();
    format!("{name:<31}{errors}{pace:>8}{target:>7}\n")
}
