//! What a drop is written as: the columns of its row.

use super::draw::Drawn;
use super::parameter::text;
use super::plan::Plan;
use super::record::Record;

/// Names of the columns.
pub(super) fn columns(plan: &Plan) -> Vec<String> {
    let mut columns = vec!["drop".to_owned(), "point".to_owned()];
    columns.extend(plan.listed.iter().map(|(key, _)| key.clone()));
    columns.extend(plan.drawn.iter().map(|(key, _)| key.clone()));
    let starts = ["start_x_rel", "start_y_rel", "start_vx_m_s", "start_vy_m_s"];
    if plan.start.is_some() {
        columns.extend(starts.map(str::to_owned));
    }
    let measured = [
        "regime",
        "impacts",
        "contact_start_s",
        "whirl_start_s",
        "impact_speed_max_m_s",
        "impulse_max_n_s",
        "end_load_n",
        "whirl_frequency_hz",
    ];
    columns.extend(measured.map(str::to_owned));
    columns
}

/// The values of one drop.
pub(super) fn cells(plan: &Plan, drawn: &Drawn, record: &Record) -> Vec<String> {
    let mut cells = vec![record.index.to_string(), drawn.point.to_string()];
    cells.extend(plan.values(drawn.point).into_iter().map(text));
    cells.extend(drawn.values.iter().map(f64::to_string));
    if let Some(([x, y], [u, v])) = drawn.start {
        cells.extend([x, y, u, v].map(|it| it.to_string()));
    }
    cells.push(<&str>::from(record.regime).to_owned());
    cells.push(record.impacts.to_string());
    cells.extend(record.values().map(cell));
    cells
}

/// Empty where there is no value.
pub(super) fn cell(value: Option<f64>) -> String {
    value.map_or(String::new(), |it| it.to_string())
}
