//! Recordings as Parquet files, as pandas, DuckDB, MATLAB and asammdf write them.
//!
//! Read a page of each column at a time, so that a recording of any size fits.

mod column;
mod guard;

use std::fs::File;
use std::path::Path;

use parquet::errors::ParquetError;
use parquet::file::reader::{FileReader, SerializedFileReader};

use super::mapping::{Column, Mapping, TimeColumn};
use super::pick::{Heading, Pick, by_name, list};
use super::remarks::Remarks;
use crate::input_error::{InputError, reason};
use crate::sensors::SensorsConfig;
use crate::stream::{Meter, Stamp, Stamped};
use column::{Used, heading};
use guard::guarded;

/// Whether the name of `path` is that of a Parquet file.
pub fn is_parquet(path: &Path) -> bool {
    let ending = path.extension();
    ending.is_some_and(|it| it.eq_ignore_ascii_case("parquet") || it.eq_ignore_ascii_case("pq"))
}

/// Rows of a Parquet file, its columns as a mapping has them.
pub struct ParquetRows {
    file: String,
    reader: SerializedFileReader<File>,
    pick: Pick,
    rate: Option<f64>,
    used: Vec<Used>,
    values: Vec<f64>,
    /// The next group of rows, bytes of the open one and its rows.
    group: usize,
    open: (u64, u64),
    rows: u64,
    meter: Meter,
    finished: bool,
}

impl ParquetRows {
    /// Opens `path` and finds the columns of `mapping`, or without one those that are named as in a
    /// stream; also its size in bytes.
    pub fn new(
        path: &Path,
        mapping: Option<&Mapping>,
        sensors: &SensorsConfig,
        remarks: &Remarks,
    ) -> Result<(Self, u64), InputError> {
        let name = path.display().to_string();
        let fail = |rule: String| InputError::of_file(&name, rule);
        let bytes = File::open(path).map_err(|error| fail(reason(&error)))?;
        let there = bytes.metadata().map_err(|error| fail(reason(&error)))?;
        if there.is_dir() {
            return Err(fail("is a folder, not a file".to_owned()));
        }
        let reader =
            guarded(|| SerializedFileReader::new(bytes)).map_err(|error| fail(damaged(&error)))?;
        let schema = reader.metadata().file_metadata().schema_descr();
        let found: Vec<Heading> = schema.columns().iter().map(|it| heading(it)).collect();
        let named;
        let mapping = match mapping {
            Some(mapping) => mapping,
            None => {
                named = of_stream(&found).ok_or_else(|| {
                    fail(format!(
                        "no columns are named time, ax and ay: --columns says which they are; {}",
                        list(&found)
                    ))
                })?;
                &named
            }
        };
        let pick = Pick::new(mapping, &found, sensors, remarks).map_err(fail)?;
        let rate = mapping.time.as_ref().and_then(|it| it.get_ref().rate_hz);
        if pick.time.is_none() && rate.is_none() {
            return Err(fail(format!(
                "nothing says when its rows were sampled: [time] of --columns needs a column or rate_hz; {}",
                list(&found)
            )));
        }
        let mut indices = pick.used();
        indices.extend(pick.time.map(|it| it.0));
        indices.sort_unstable();
        indices.dedup();
        let mut used = Vec::new();
        for index in indices {
            let column = schema.column(index);
            let groups = reader.metadata().row_groups().iter();
            let parts = groups.filter_map(|it| it.columns().get(index));
            let opened = Used::new(index, &column, parts, there.len());
            used.push(
                opened
                    .map_err(|rule| fail(format!("column {:?} {rule}", column.path().string())))?,
            );
        }
        let rows = Self {
            values: vec![f64::NAN; found.len()],
            file: name,
            reader,
            pick,
            rate,
            used,
            group: 0,
            open: (0, 0),
            rows: 0,
            meter: Meter::default(),
            finished: false,
        };
        Ok((rows, there.len()))
    }

    /// What is taken of it.
    pub fn pick(&self) -> &Pick {
        &self.pick
    }

    /// The rate that the mapping gives, Hz.
    pub fn rate(&self) -> Option<f64> {
        self.rate
    }

    /// How far it is read.
    pub fn meter(&self) -> Meter {
        self.meter.clone()
    }

    fn flaw(&self, rule: String) -> InputError {
        InputError::at_line(&self.file, self.rows + 1, rule)
    }

    fn read(&mut self) -> Result<Option<Stamped>, InputError> {
        if self.used.iter().all(|it| it.is_empty()) && !self.fill()? {
            return Ok(None);
        }
        for column in &mut self.used {
            // Batches are filled together; a column that is shorter than others gave an error.
            self.values[column.index] = column.next().unwrap_or(f64::NAN);
        }
        let stamp = match self.pick.time {
            Some((column, power)) => {
                let counted = self.used.iter().any(|it| it.index == column && it.counts());
                let time = self.values[column];
                let scale = 10_f64.powi(power);
                let stamp = if counted {
                    Stamp::counted(time * scale, scale)
                } else {
                    Stamp::exact(time * scale)
                };
                let finite = Some(stamp).filter(|_| time.is_finite());
                finite.ok_or_else(|| self.flaw("the row has no time".to_owned()))?
            }
            None => Stamp::exact(self.rows as f64 / self.rate.unwrap_or(1.0)),
        };
        self.rows += 1;
        Ok(Some(Stamped {
            stamp,
            row: self.pick.row(stamp.time, &self.values),
            line: self.rows,
        }))
    }

    /// Takes the next rows of all columns; false at the end.
    fn fill(&mut self) -> Result<bool, InputError> {
        loop {
            let mut lengths = Vec::new();
            for at in 0..self.used.len() {
                let filled = guarded(|| self.used[at].fill());
                filled.map_err(|error| self.flaw(damaged(&error)))?;
                lengths.push(self.used[at].len());
            }
            let rows = lengths.first().copied().unwrap_or(0);
            if lengths.iter().any(|it| *it != rows) {
                return Err(self.flaw("columns end after different numbers of rows".to_owned()));
            }
            if rows > 0 {
                let (bytes, all) = self.open;
                self.meter.add(bytes * rows as u64 / all.max(rows as u64));
                return Ok(true);
            }
            if self.group == self.reader.num_row_groups() {
                return Ok(false);
            }
            guarded(|| self.next_group()).map_err(|error| self.flaw(damaged(&error)))?;
        }
    }

    fn next_group(&mut self) -> Result<(), ParquetError> {
        let group = self.reader.get_row_group(self.group)?;
        for column in &mut self.used {
            column.open(group.get_column_reader(column.index)?);
        }
        let told = group.metadata();
        let bytes = u64::try_from(told.compressed_size()).unwrap_or(0);
        self.open = (bytes, u64::try_from(told.num_rows()).unwrap_or(0));
        self.group += 1;
        Ok(())
    }
}

impl Iterator for ParquetRows {
    type Item = Result<Stamped, InputError>;

    fn next(&mut self) -> Option<Self::Item> {
        if self.finished {
            return None;
        }
        let row = self.read();
        self.finished = !matches!(row, Ok(Some(_)));
        row.transpose()
    }
}

fn damaged(error: &ParquetError) -> String {
    format!("is no Parquet file, or a damaged one: {error}")
}

/// Columns that are named as in a stream, and the time.
fn of_stream(found: &[Heading]) -> Option<Mapping> {
    let column = Column::Name("time".to_owned());
    let time = TimeColumn {
        column: Some(column),
        unit: None,
        rate_hz: None,
    };
    Some(Mapping {
        time: Some(toml::Spanned::new(0..0, time)),
        ..by_name(found)?
    })
}
