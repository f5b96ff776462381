//! Reads recordings and calibrations: CSV, strictly.

use std::path::Path;

use super::recording::{Axis, Hit, Hits, Recording};
use touchdown_base::input_error::InputError;
use touchdown_base::plain::Number;
use touchdown_files::stream::{Clock, Stamp};

/// Hz.
const RATES: std::ops::RangeInclusive<f64> = 5e3..=1e6;
/// Rates that are taken as one, part of the rate.
const SAME_RATE: f64 = 1e-4;

/// Of a file, bytes: 13 s at the highest rate. All of it is held in memory.
const LARGEST: u64 = 256 << 20;

/// Reads a recording, header `time_s,ax_m_s2[,ay_m_s2]`.
pub fn recording(path: &Path) -> Result<Recording, InputError> {
    let table = Table::read(path, "time_s,ax_m_s2[,ay_m_s2]", |names| {
        names.strip_suffix(&["ay_m_s2"]).unwrap_or(names) == ["time_s", "ax_m_s2"]
    })?;
    let rows = &table.rows;
    let (start, rate) = table.clock(rows)?;
    let axes = 1..table.names.len();
    Ok(Recording {
        rate,
        start,
        acceleration: axes.map(|column| columns(rows, column)).collect(),
        file: table.file,
    })
}

/// Reads known hits, header `[hit,]time_s,force_n,ax_m_s2`, or `ay_m_s2` for the other axis. A new
/// value of `hit` begins the next one, with a time of its own.
pub fn calibration(path: &Path) -> Result<Hits, InputError> {
    let header = "[hit,]time_s,force_n,ax_m_s2 (or ay_m_s2)";
    let table = Table::read(path, header, |names| {
        let names = names.strip_prefix(&["hit"]).unwrap_or(names);
        matches!(names, ["time_s", "force_n", "ax_m_s2" | "ay_m_s2"])
    })?;
    let axis = match table.names.last().map(String::as_str) {
        Some("ay_m_s2") => Axis::Y,
        _ => Axis::X,
    };
    let numbered = table.names[0] == "hit";
    let first = usize::from(numbered);
    let same = |a: &Row, b: &Row| !numbered || a.values[0] == b.values[0];
    let mut rate: Option<f64> = None;
    let mut hits = Vec::new();
    for rows in table.rows.chunk_by(same) {
        let (_, own) = table.clock(rows)?;
        let common = *rate.get_or_insert(own);
        if (own / common - 1.0).abs() > SAME_RATE {
            let [own, common] = [own, common].map(Number);
            let rule = format!(
                "the sample rate is {own} Hz, that of the first hit {common} Hz: all hits need one rate"
            );
            return Err(InputError::at_line(&table.file, rows[0].line, rule));
        }
        hits.push(Hit {
            line: rows[0].line,
            force: columns(rows, first + 1),
            acceleration: columns(rows, first + 2),
        });
    }
    Ok(Hits {
        file: table.file,
        axis,
        rate: rate.unwrap_or_default(),
        hits,
    })
}

/// One and the same rate, or an error that names the recording.
pub fn same_rate(recording: &Recording, hits: &Hits) -> Result<(), InputError> {
    if (recording.rate / hits.rate - 1.0).abs() <= SAME_RATE {
        return Ok(());
    }
    let ([own, other], file) = ([recording.rate, hits.rate].map(Number), &hits.file);
    let rule =
        format!("the sample rate is {own} Hz, that of {file} {other} Hz: both need one rate");
    Err(InputError::at_line(&recording.file, 3, rule))
}

fn columns(rows: &[Row], column: usize) -> Vec<f64> {
    rows.iter().map(|row| row.values[column]).collect()
}

struct Table {
    file: String,
    names: Vec<String>,
    rows: Vec<Row>,
}

struct Row {
    line: u64,
    stamp: Stamp,
    values: Vec<f64>,
}

impl Table {
    fn read(
        path: &Path,
        shape: &str,
        allowed: impl Fn(&[&str]) -> bool,
    ) -> Result<Self, InputError> {
        let file = path.display().to_string();
        let text = InputError::read(path, LARGEST)?;
        let mut lines = text.lines().zip(1..);
        let (header, _) = lines.next().unwrap_or(("", 1));
        let names: Vec<&str> = header.split(',').map(str::trim).collect();
        if !allowed(&names) {
            let rule = format!("the header must be {shape}, is {header:?}");
            return Err(InputError::at_line(&file, 1, rule));
        }
        let mut rows = Vec::new();
        for (text, line) in lines.filter(|(text, _)| !text.trim().is_empty()) {
            let row = Row::parse(text, line, &names);
            rows.push(row.map_err(|rule| InputError::at_line(&file, line, rule))?);
        }
        let fail = |line, rule| Err(InputError::at_line(&file, line, rule));
        if rows.is_empty() {
            return fail(1, "there are no rows after the header");
        }
        if !text.ends_with('\n') {
            let rule = "the last line is cut off: it does not end with a newline";
            return fail(text.lines().count() as u64, rule);
        }
        let names = names.into_iter().map(str::to_owned).collect();
        Ok(Self { file, names, rows })
    }

    /// Time of the first of `rows`, of which there is one at least, s, and their rate, Hz.
    fn clock(&self, rows: &[Row]) -> Result<(f64, f64), InputError> {
        let mut clock = Clock::new(rows[0].stamp);
        rows.iter().for_each(|row| clock.learn(row.stamp));
        for row in &rows[1..] {
            let taken = clock.take(row.stamp);
            taken.map_err(|rule| InputError::at_line(&self.file, row.line, rule))?;
        }
        if rows.len() < 2 {
            let rule = "one row alone has no sample rate";
            return Err(InputError::at_line(&self.file, rows[0].line, rule));
        }
        let rate = clock.rate().unwrap_or_default();
        if RATES.contains(&rate) {
            return Ok((clock.first, rate));
        }
        let (least, most, rate) = (RATES.start(), RATES.end(), Number(rate));
        let rule = format!("the sample rate must be {least} to {most} Hz, is {rate} Hz");
        Err(InputError::at_line(&self.file, 3, rule))
    }
}

impl Row {
    fn parse(text: &str, line: u64, names: &[&str]) -> Result<Self, String> {
        let fields: Vec<&str> = text.split(',').map(str::trim).collect();
        let (needed, there) = (names.len(), fields.len());
        if there != needed {
            return Err(format!("a row needs {needed} fields, this one has {there}"));
        }
        let mut stamp = None;
        let mut values = Vec::with_capacity(fields.len());
        for (name, field) in names.iter().zip(&fields) {
            let fail = || format!("{name} must be a finite number, is {field:?}");
            let value: Option<f64> = field.parse().ok();
            values.push(value.filter(|it| it.is_finite()).ok_or_else(fail)?);
            if *name == "time_s" {
                stamp = Some(Stamp::parse(field).ok_or_else(fail)?);
            }
        }
        let stamp = stamp.ok_or("time_s is missing")?;
        Ok(Self {
            line,
            stamp,
            values,
        })
    }
}
