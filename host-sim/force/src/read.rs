//! Reads recordings and calibrations: CSV, strictly.

use std::path::Path;

use super::recording::{Axis, COLUMNS, Hit, Hits, Recording};
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
    let headers = ["time_s,ax_m_s2", "time_s,ax_m_s2,ay_m_s2"];
    let table = Table::read(path, "time_s,ax_m_s2[,ay_m_s2]", &headers)?;
    let (start, rate) = table.clock(&table.rows)?;
    let axes = 1..table.rows[0].values.len();
    Ok(Recording {
        rate,
        start,
        acceleration: axes.map(|it| column(&table.rows, it)).collect(),
        file: table.file,
    })
}

/// Reads known hits, header `[hit,]time_s,force_n,ax_m_s2`, or `ay_m_s2` for the other axis. A new
/// value of `hit` begins the next one, with a time of its own.
pub fn calibration(path: &Path) -> Result<Hits, InputError> {
    let headers = [
        "time_s,force_n,ax_m_s2",
        "time_s,force_n,ay_m_s2",
        "hit,time_s,force_n,ax_m_s2",
        "hit,time_s,force_n,ay_m_s2",
    ];
    let table = Table::read(path, "[hit,]time_s,force_n,ax_m_s2 (or ay_m_s2)", &headers)?;
    let first = usize::from(table.header.starts_with("hit"));
    let same = |a: &Row, b: &Row| a.values[..first] == b.values[..first];
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
            force: column(rows, first + 1),
            acceleration: column(rows, first + 2),
        });
    }
    Ok(Hits {
        axis: if table.header.ends_with(COLUMNS[1]) {
            Axis::Y
        } else {
            Axis::X
        },
        file: table.file,
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

fn column(rows: &[Row], column: usize) -> Vec<f64> {
    rows.iter().map(|row| row.values[column]).collect()
}

struct Table {
    file: String,
    header: String,
    /// One or more.
    rows: Vec<Row>,
}

struct Row {
    line: u64,
    stamp: Stamp,
    /// All fields, the time included.
    values: Vec<f64>,
}

impl Table {
    /// Of one of these `headers`, which an error tells as `shape`.
    fn read(path: &Path, shape: &str, headers: &[&str]) -> Result<Self, InputError> {
        let file = path.display().to_string();
        let fail = |line, rule: String| InputError::at_line(&file, line, rule);
        let text = InputError::read(path, LARGEST)?;
        let mut lines = text.lines().zip(1..);
        let (first, _) = lines.next().unwrap_or(("", 1));
        let names: Vec<&str> = first.split(',').map(str::trim).collect();
        let header = names.join(",");
        if !headers.contains(&header.as_str()) {
            return Err(fail(1, format!("the header must be {shape}, is {first:?}")));
        }
        let lines = lines.filter(|(text, _)| !text.trim().is_empty());
        let rows = lines
            .map(|(text, line)| Row::parse(text, line, &names).map_err(|rule| fail(line, rule)));
        let rows = rows.collect::<Result<Vec<_>, _>>()?;
        if rows.is_empty() {
            return Err(fail(1, "there are no rows after the header".to_owned()));
        }
        if !text.ends_with('\n') {
            let rule = "the last line is cut off: it does not end with a newline";
            return Err(fail(text.lines().count() as u64, rule.to_owned()));
        }
        Ok(Self { file, header, rows })
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
        let broken = |at: usize| {
            let (name, field) = (names[at], fields[at]);
            format!("{name} must be a finite number, is {field:?}")
        };
        let number = |at: usize| {
            let number = fields[at].parse().ok().filter(|it: &f64| it.is_finite());
            number.ok_or_else(|| broken(at))
        };
        let time = usize::from(names[0] == "hit");
        Ok(Self {
            line,
            values: (0..needed).map(number).collect::<Result<_, _>>()?,
            stamp: Stamp::parse(fields[time]).ok_or_else(|| broken(time))?,
        })
    }
}
