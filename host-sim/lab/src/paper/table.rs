//! The numbers as text, in 80 columns.

use super::{Paper, Row};
use touchdown_base::paint::Paint;

/// Digits of a number.
const DIGITS: i32 = 5;

/// One line a number, and how many agree.
pub fn table(paper: &Paper, paint: Paint) -> String {
    let head = format!(
        "{:<40}{:>10}{:>10}{:>10} {}",
        "", "printed", "right", "ours", "unit"
    );
    let mut text = paint.bold(head.trim_end()) + "\n";
    for row in &paper.rows {
        text += &line(row, paint);
    }
    let count = |wanted| paper.rows.iter().filter(|row| row.agrees == wanted).count();
    text += &format!(
        "\n{} numbers: ours agrees in {}, differs in {}; {} have no run of ours\n",
        paper.rows.len(),
        count(Some(true)),
        count(Some(false)),
        count(None)
    );
    text
}

fn line(row: &Row, paint: Paint) -> String {
    let ours = format!("{:>10}", cell(row.ours));
    let (ours, mark) = match row.agrees {
        Some(true) => (paint.good(&ours), ' '),
        Some(false) => (paint.bad(&ours), '!'),
        None => (ours, ' '),
    };
    let line = format!(
        "{:<40}{:>10}{:>10}{ours}{mark}{}",
        row.item,
        cell(row.printed),
        cell(Some(row.right)),
        row.unit
    );
    line.trim_end().to_owned() + "\n"
}

/// A number to five digits, or a dash.
pub fn cell(value: Option<f64>) -> String {
    let Some(value) = value else {
        return "-".to_owned();
    };
    let magnitude = value.abs().log10().floor() as i32;
    match value {
        0.0 => "0".to_owned(),
        _ if !(-3..6).contains(&magnitude) => format!("{value:.3e}"),
        _ => {
            let text = format!("{value:.*}", (DIGITS - 1 - magnitude).max(0) as usize);
            match text.contains('.') {
                true => text.trim_end_matches('0').trim_end_matches('.').to_owned(),
                false => text,
            }
        }
    }
}
