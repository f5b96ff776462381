//! The rows as text: an extreme, what was measured of it in either precision, and how much of the limit
//! that uses up.

use crate::limits::row::Row;
use touchdown_base::paint::Paint;
use touchdown_scene::Precision;

/// Between an extreme and what is measured of it.
const MEASURE: &str = ": ";

/// The table and, below it, what does not hold.
pub fn table(rows: &[Row], paint: Paint) -> String {
    let mut text = paint.bold(&format!(
        "{:<50}{:>10} {:>9} {:>8}{:>11} {:>9} {:>8}  {}",
        "", "f64", "limit", "used", "f32", "limit", "used", "unit"
    ));
    text.push('\n');
    let mut extreme = "";
    for row in rows.iter().filter(|row| row.precision == Precision::F64) {
        let (name, measure) = row
            .extreme
            .rsplit_once(MEASURE)
            .unwrap_or((&row.extreme, ""));
        if name != extreme {
            text += &format!("{}\n", paint.bold(name));
            extreme = name;
        }
        let single = rows
            .iter()
            .find(|other| other.precision == Precision::F32 && other.extreme == row.extreme);
        let cells = cells(row, paint) + &single.map(|row| cells(row, paint)).unwrap_or_default();
        text += &format!("  {measure:<48}{cells}  {}\n", row.unit);
    }
    text + &summary(rows, paint)
}

/// Measured, limit and how much of it is used.
fn cells(row: &Row, paint: Paint) -> String {
    let used = if row.limit > 0.0 {
        format!("{:.2} %", 100.0 * row.measured / row.limit)
    } else {
        "-".to_owned()
    };
    let used = if !row.holds {
        paint.bad(&format!("{:>8}", "BROKEN"))
    } else {
        paint.good(&format!("{used:>8}"))
    };
    format!("{:>10} {:>9} {used}", short(row.measured), short(row.limit))
}

/// Few digits: whole numbers as they are.
fn short(value: f64) -> String {
    if value.fract() == 0.0 && value.abs() < 1e6 {
        format!("{value}")
    } else {
        format!("{value:.1e}")
    }
}

fn summary(rows: &[Row], paint: Paint) -> String {
    let broken: Vec<_> = rows.iter().filter(|row| !row.holds).collect();
    if broken.is_empty() {
        let verdict = paint.good("all hold");
        return format!("\n{} limits, {verdict}\n", rows.len());
    }
    let verdict = paint.bad(&format!("{} do not hold", broken.len()));
    let mut text = format!("\n{} limits, {verdict}:\n", rows.len());
    for row in broken {
        text += &format!(
            "  {} ({}): {:e} {}, limit {:e}\n",
            row.extreme, row.precision, row.measured, row.unit, row.limit
        );
    }
    text
}
