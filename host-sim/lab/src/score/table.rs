//! The rows as text.

use super::{Findings, Row, Score};
use touchdown_base::paint::Paint;

/// Cases beyond this are cut by the terminal anyway.
const CASE: usize = 62;

/// The table and, below it, how many rows do not hold.
pub fn table(score: &Score, paint: Paint) -> String {
    let mut text = String::new();
    for (group, Findings { rows, .. }) in &score.groups {
        text += &paint.bold(&format!("{}: {}\n", group.name, group.about));
        for row in rows {
            text += &line(row, paint);
        }
        text.push('\n');
    }
    text + &summary(score, paint)
}

fn line(row: &Row, paint: Paint) -> String {
    let verdict = if row.holds {
        paint.good("holds    ")
    } else if row.undecided {
        "undecided".to_owned()
    } else {
        paint.bad("BROKEN   ")
    };
    format!(
        "  {verdict} {:<CASE$} {:<24} {:>9} {} {:<7} {}\n",
        row.case,
        row.quantity,
        row.measured().map_or("-".to_owned(), short),
        row.sense(),
        short(row.target),
        row.note
    )
}

/// Few digits: whole numbers as they are.
pub fn short(value: f64) -> String {
    if value == 0.0 || (value.fract() == 0.0 && value.abs() < 1e6) {
        format!("{value}")
    } else if (1e-2..1e4).contains(&value.abs()) {
        let decimals = (3.0 - value.abs().log10().floor()).clamp(0.0, 5.0) as usize;
        format!("{value:.decimals$}")
    } else {
        format!("{value:.2e}")
    }
}

fn summary(score: &Score, paint: Paint) -> String {
    let all = score.rows().count();
    let broken = score.rows().filter(|row| row.fails()).count();
    let undecided = score.rows().filter(|row| row.undecided).count();
    let verdict = match (broken, undecided) {
        (0, 0) => paint.good("all hold"),
        (0, _) => paint.good("none fails"),
        _ => paint.bad(&format!("{broken} do not hold")),
    };
    let open = match undecided {
        0 => String::new(),
        some => format!(", {some} undecided with so few trials"),
    };
    format!("{all} rows, {verdict}{open}; {}\n", score.extent())
}
