//! What a drop of a sweep came to, and its row.

use std::f64::consts::TAU;
use std::io;

use csv::StringRecord;
use serde::Deserialize;

use super::draw::Drawn;
use super::parameter::text;
use super::plan::Plan;
use touchdown_base::failure::Failure;
use touchdown_base::history::{History, Regime};
use touchdown_base::output::Output;
use touchdown_scene::Scene;

/// One drop, SI: the first and the last columns of its row.
#[derive(Clone, Copy, Debug, Deserialize)]
pub(super) struct Record {
    /// Number of the drop.
    pub index: u64,
    /// At the end of the run.
    pub regime: Regime,
    pub impacts: u32,
    /// Start of the first permanent contact, s.
    pub contact_start: Option<f64>,
    /// Start of the contact in which the rotor whirls, s.
    pub whirl_start: Option<f64>,
    /// Greatest speed into the wall, m/s.
    pub impact_speed: Option<f64>,
    /// Greatest normal impulse, N s.
    pub impulse: Option<f64>,
    /// Normal force at the end of the run, in permanent contact, N.
    pub end_load: Option<f64>,
    /// Frequency of the whirl at the end of the run, counter-clockwise positive, 1/s.
    pub whirl_frequency: Option<f64>,
}

impl Record {
    /// What `history` came to.
    pub fn of(index: u64, scene: &Scene, history: &History) -> Self {
        let impacts = history.impacts.iter();
        let whirls = matches!(history.regime, Regime::ForwardWhirl | Regime::BackwardWhirl);
        let last_contact = history.contact_starts.last().copied();
        let end = &history.end;
        let ([x, y], [u, v]) = (end.position, end.velocity);
        let radius = x.hypot(y);
        let along = (x * v - y * u) / radius;
        let in_contact = history.regime != Regime::Bouncing
            && last_contact
                .is_some_and(|start| history.lift_offs.iter().all(|lift| *lift <= start));
        let pressing = along * along / radius - scene.run.gravity * y / radius;
        Self {
            index,
            regime: history.regime,
            impacts: history.impacts.len() as u32,
            contact_start: history.contact_starts.first().copied(),
            whirl_start: last_contact.filter(|_| whirls),
            impact_speed: impacts.clone().map(|it| it.normal_speed).reduce(f64::max),
            impulse: impacts.map(|it| it.normal_impulse).reduce(f64::max),
            end_load: in_contact.then_some(scene.rotor.mass * pressing),
            whirl_frequency: whirls.then_some(along / radius / TAU),
        }
    }

    /// From a row of the table; `None` where that is none of it.
    pub fn of_row(row: &StringRecord) -> Option<Self> {
        let last = row.iter().skip(row.len().checked_sub(MEASURED.len())?);
        let own: StringRecord = row.iter().take(1).chain(last).collect();
        own.deserialize(None).ok()
    }
}

/// Columns of the start, where it is drawn.
const START: [&str; 4] = ["start_x_rel", "start_y_rel", "start_vx_m_s", "start_vy_m_s"];

/// Name of a column, and what a row has there.
pub(super) type NamedCell<R> = (&'static str, fn(&R) -> String);

/// The last columns, in the order of a record's fields.
const MEASURED: [NamedCell<Record>; 8] = [
    ("regime", |it| <&str>::from(it.regime).to_owned()),
    ("impacts", |it| it.impacts.to_string()),
    ("contact_start_s", |it| cell(it.contact_start)),
    ("whirl_start_s", |it| cell(it.whirl_start)),
    ("impact_speed_max_m_s", |it| cell(it.impact_speed)),
    ("impulse_max_n_s", |it| cell(it.impulse)),
    ("end_load_n", |it| cell(it.end_load)),
    ("whirl_frequency_hz", |it| cell(it.whirl_frequency)),
];

/// Names of a row's columns.
pub(super) fn columns(plan: &Plan) -> Vec<&str> {
    let mut columns = vec!["drop", "point"];
    columns.extend(plan.keys());
    if plan.start.is_some() {
        columns.extend(START);
    }
    columns.extend(MEASURED.map(|(name, _)| name));
    columns
}

/// The row of a drop.
pub(super) fn cells(plan: &Plan, drawn: &Drawn, record: &Record) -> Vec<String> {
    let mut cells = vec![record.index.to_string(), drawn.point.to_string()];
    cells.extend(plan.values(drawn.point).into_iter().map(text));
    cells.extend(drawn.values.iter().map(f64::to_string));
    if let Some(([x, y], [u, v])) = drawn.start {
        cells.extend([x, y, u, v].map(|it| it.to_string()));
    }
    cells.extend(MEASURED.map(|(_, cell)| cell(record)));
    cells
}

/// Writes rows of a table to `out`, as CSV.
pub(super) fn put_rows<R: IntoIterator<Item: AsRef<[u8]>>>(
    out: &mut Output,
    rows: impl IntoIterator<Item = R>,
) -> Result<(), Failure> {
    let name = out.name().to_owned();
    let mut table = csv::Writer::from_writer(out);
    let mut rows = rows.into_iter();
    let written = rows.try_for_each(|row| table.write_record(row));
    (written.map_err(io::Error::from))
        .and_then(|()| table.flush())
        .map_err(Failure::output(&name))
}

/// Empty where there is no value.
pub(super) fn cell(value: Option<f64>) -> String {
    value.map_or(String::new(), |it| it.to_string())
}
