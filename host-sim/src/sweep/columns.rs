//! What a drop is written as: its columns, for every format.

use toml::Value;

use super::draw::Drawn;
use super::plan::Plan;
use super::record::{REGIMES, Record, number};

/// Kind of a column.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Kind {
    Whole,
    Number,
    Text,
}

/// A value of a column.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum Cell {
    Whole(i64),
    /// NaN where there is none.
    Number(f64),
    Text(String),
}

/// Names and kinds of the columns.
pub(super) fn columns(plan: &Plan) -> Vec<(String, Kind)> {
    let mut columns = vec![
        ("drop".to_owned(), Kind::Whole),
        ("point".to_owned(), Kind::Whole),
    ];
    for (key, values) in &plan.listed {
        columns.push((key.clone(), kind(values)));
    }
    for (key, _) in &plan.drawn {
        columns.push((key.clone(), Kind::Number));
    }
    let starts = ["start_x_rel", "start_y_rel", "start_vx_m_s", "start_vy_m_s"];
    if plan.start.is_some() {
        columns.extend(starts.map(|name| (name.to_owned(), Kind::Number)));
    }
    columns.push(("regime".to_owned(), Kind::Text));
    columns.push(("impacts".to_owned(), Kind::Whole));
    let measured = [
        "contact_start_s",
        "whirl_start_s",
        "impact_speed_max_m_s",
        "impulse_max_n_s",
        "end_load_n",
        "whirl_frequency_hz",
    ];
    columns.extend(measured.map(|name| (name.to_owned(), Kind::Number)));
    columns
}

/// The values of one drop.
pub(super) fn cells(plan: &Plan, drawn: &Drawn, record: &Record) -> Vec<Cell> {
    let mut cells = vec![
        Cell::Whole(record.index as i64),
        Cell::Whole(drawn.point as i64),
    ];
    for ((_, values), value) in plan.listed.iter().zip(plan.values(drawn.point)) {
        cells.push(cell(kind(values), value));
    }
    cells.extend(drawn.values.iter().map(|value| Cell::Number(*value)));
    if let Some(([x, y], [u, v])) = drawn.start {
        cells.extend([x, y, u, v].map(Cell::Number));
    }
    cells.push(Cell::Text(REGIMES[number(record.regime)].1.to_owned()));
    cells.push(Cell::Whole(i64::from(record.impacts)));
    cells.extend(record.values().map(Cell::Number));
    cells
}

fn kind(values: &[Value]) -> Kind {
    if values.iter().all(Value::is_integer) {
        Kind::Whole
    } else if values.iter().all(|it| as_number(it).is_some()) {
        Kind::Number
    } else {
        Kind::Text
    }
}

fn cell(kind: Kind, value: &Value) -> Cell {
    match (kind, value) {
        (Kind::Whole, Value::Integer(whole)) => Cell::Whole(*whole),
        (Kind::Number, value) => Cell::Number(as_number(value).unwrap_or(f64::NAN)),
        (_, value) => Cell::Text(text(value)),
    }
}

/// Of a whole or decimal number.
pub(super) fn as_number(value: &Value) -> Option<f64> {
    match value {
        Value::Integer(whole) => Some(*whole as f64),
        Value::Float(number) => Some(*number),
        _ => None,
    }
}

/// For people and tables.
pub(super) fn text(value: &Value) -> String {
    match value {
        Value::String(text) => text.clone(),
        Value::Float(number) => format!("{number}"),
        other => other.to_string(),
    }
}
