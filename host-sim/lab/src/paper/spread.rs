//! Rows from random drops: what decides about whirl, and that the gap does not.

use super::drops::{Condition, Tally};
use super::rig::WIDE_GAP;
use super::row::Row;

/// Share by which model and reference may differ: they part where a start grazes.
const CLOSE: f64 = 0.01;

/// The rows of the tallies.
pub fn rows(tallies: &[Tally]) -> Vec<Row> {
    let mut rows: Vec<Row> = tallies.iter().map(whirl).collect();
    rows.extend(same_starts(tallies));
    rows.extend(tallies.iter().find(|it| it.cycle > 0).map(third_motion));
    rows
}

fn whirl(tally: &Tally) -> Row {
    Row::new(
        &format!("whirl, {}", name(tally)),
        "",
        share(tally.whirl_of_reference, tally),
    )
    .ours(share(tally.whirl, tally), CLOSE)
    .note(&format!(
        "{} of {} drops, 95 % interval {:.3} to {:.3}; right: reference, same starts",
        tally.whirl, tally.drops, tally.whirl_low, tally.whirl_high
    ))
}

/// Drops from the same scaled starts in both gaps that ended otherwise in the wider one.
fn same_starts(tallies: &[Tally]) -> Option<Row> {
    let of = |condition: Condition| tallies.iter().find(|it| it.condition == condition);
    let (narrow, wide) = tallies.iter().find_map(|narrow| {
        let wide = of(Condition {
            clearance_m: WIDE_GAP,
            ..narrow.condition
        })?;
        (wide.condition != narrow.condition).then_some((narrow, wide))
    })?;
    let differ = wide.ends.iter().zip(&narrow.ends).filter(|(a, b)| a != b);
    let row = Row::new("drops that end otherwise at 0.75 mm", "", 0.0)
        .ours(differ.count() as f64, CLOSE * f64::from(wide.drops))
        .note("of those at mu 0.3, same starts in units of rho0 and sqrt(g rho0) as at 0.3 mm; right: the scale law has no gap");
    Some(row)
}

fn third_motion(tally: &Tally) -> Row {
    Row::new(
        &format!("third motion, {}", name(tally)),
        "",
        share(tally.cycle_of_reference, tally),
    )
    .printed(0.0)
    .ours(share(tally.cycle, tally), CLOSE)
    .note("the paper names whirl and pendulum; this one slides, lifts off and bounces, four times or more; right: reference")
}

fn name(tally: &Tally) -> String {
    let it = &tally.condition;
    let gap = it.clearance_m * 1e3;
    let speed = if it.fastest > 0.0 { "" } else { ", at rest" };
    format!(
        "{gap} mm, mu {}, eps {}{speed}",
        it.friction, it.restitution
    )
}

fn share(count: u32, tally: &Tally) -> f64 {
    f64::from(count) / f64::from(tally.drops)
}
