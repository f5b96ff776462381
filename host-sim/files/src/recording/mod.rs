//! Recordings as they come: CSV of any style or COMTRADE, as rows of a stream. `docs/use/recordings.md`.

mod comtrade;
mod doubt;
mod layout;
mod mapping;
mod pick;
mod remarks;
mod resample;
mod text;
mod unit;

use std::fs::File;
use std::io::{BufReader, Read};
use std::path::Path;

pub use comtrade::{Cfg, DEVICE, STATION, combined};
pub use mapping::Mapping;

use comtrade::{ComtradeRows, is_comtrade};
use doubt::Doubt;
use layout::Layout;
use remarks::Remarks;
use resample::Resampled;
use text::{Head, TextRows};

use touchdown_core::learnt::Learnt;

use crate::stream::{Before, Columns, Even, Meter, Records, Row, Stamped, is_rate, of_own_axes};
use touchdown_base::input_error::{InputError, UTF_16, reason};
use touchdown_base::plain::Number;
use touchdown_scene::Scene;

/// How a recording is to be read.
#[derive(Clone, Debug, Default)]
pub struct Reading {
    /// Which column is what; without it the file is a stream, or COMTRADE with a stream's names.
    pub mapping: Option<Mapping>,
    /// Rate to resample it to, Hz.
    pub resample: Option<f64>,
}

type Rows = Box<dyn Iterator<Item = Result<Row, InputError>>>;
type StampedRows = Box<dyn Iterator<Item = Result<Stamped, InputError>>>;

/// A recording being read, in constant memory.
pub struct Recording {
    /// What a stream of it has.
    pub columns: Columns,
    /// Samples per second, Hz.
    pub rate: f64,
    /// Time of the first sample, s.
    pub start: f64,
    /// What it is, for people; none for a stream.
    pub format: Option<String>,
    /// What the detector had learnt before the first sample, where the stream says.
    pub learnt: Option<Box<Learnt>>,
    /// Whether it is the export of an episode, displacements with the record of a commissioning check.
    pub is_episode: bool,
    /// Bytes of the file.
    pub size: u64,
    rows: Rows,
    meter: Meter,
    remarks: Remarks,
    doubt: Doubt,
}

/// What is known before the rate.
struct Opened {
    columns: Columns,
    rows: StampedRows,
    meter: Meter,
    /// Where no stamp can tell another.
    rate: Option<f64>,
    /// Line of the header.
    header: u64,
    format: Option<String>,
    learnt: Before,
    is_episode: bool,
    size: u64,
}

impl Recording {
    /// Opens the recording at `path`; `scene` has the sensors and what can be expected.
    pub fn open(path: &Path, reading: &Reading, scene: &Scene) -> Result<Self, InputError> {
        let file = path.display().to_string();
        if is_comtrade(path) {
            let remarks = Remarks::default();
            let (dat, size) = comtrade::open(path)?;
            let opened = of_comtrade(dat, size, reading, scene, &remarks)?;
            return Self::paced(&file, opened, reading, scene, remarks);
        }
        let (bytes, size) = opened(path)?;
        Self::of_text(&file, bytes, size, reading, scene)
    }

    /// Reads the text `bytes`, `size` of them; errors name it `file`.
    pub fn of_text(
        file: &str,
        bytes: impl Read + 'static,
        size: u64,
        reading: &Reading,
        scene: &Scene,
    ) -> Result<Self, InputError> {
        let remarks = Remarks::default();
        let head = Head::read(file, bytes)?;
        if head.is_utf_16() {
            return Err(InputError::at_line(file, 1, UTF_16));
        }
        let opened = match &reading.mapping {
            Some(mapping) => {
                let rows = TextRows::new(file, head, mapping, &scene.sensors, &remarks)?;
                let layout = rows.layout();
                Opened {
                    columns: rows.pick().columns(),
                    meter: rows.meter(),
                    rate: rows.rate(),
                    header: layout.before.1.max(1),
                    format: Some(format_of(layout)),
                    learnt: Before::default(),
                    is_episode: false,
                    size,
                    rows: Box::new(rows),
                }
            }
            None => {
                let found = head.layout(&Default::default());
                let records = Records::new(file, head.whole(0));
                let records = records.map_err(|error| match &found {
                    Ok(layout) => error.and(format!(
                        "; --columns FILE.toml says which column is what; {}",
                        pick::list(&layout.columns)
                    )),
                    Err(_) => error,
                })?;
                Opened {
                    columns: records.columns(),
                    meter: records.meter(),
                    rate: None,
                    header: 1,
                    format: None,
                    learnt: records.learnt(),
                    is_episode: false,
                    size,
                    rows: Box::new(records),
                }
            }
        };
        Self::paced(file, opened, reading, scene, remarks)
    }

    /// Reads the COMTRADE recording `bytes`, a .cff file; errors name it `file`.
    pub fn of_cff(
        file: &str,
        bytes: impl Read + 'static,
        reading: &Reading,
        scene: &Scene,
    ) -> Result<Self, InputError> {
        let remarks = Remarks::default();
        let dat = combined(file, Box::new(BufReader::new(bytes)))?;
        let opened = of_comtrade(dat, 0, reading, scene, &remarks)?;
        Self::paced(file, opened, reading, scene, remarks)
    }

    fn paced(
        file: &str,
        opened: Opened,
        reading: &Reading,
        scene: &Scene,
        remarks: Remarks,
    ) -> Result<Self, InputError> {
        let (rows, rate, start): (Rows, f64, f64);
        if let Some(wanted) = reading.resample {
            if opened.columns.edges != [false; 2] {
                let rule = "counted edges cannot be resampled";
                return Err(InputError::of_file(file, rule));
            }
            let resampled = Resampled::new(file, opened.rows, wanted, &remarks)?;
            (rate, start) = (wanted, resampled.start());
            rows = Box::new(resampled);
        } else if let Some(given) = opened.rate {
            if !is_rate(given) {
                let rule = format!(
                    "the sample rate must be 100 to 200000 Hz, is {} Hz; --resample RATE makes another \
                     of it and says so",
                    Number(given)
                );
                return Err(InputError::of_file(file, rule));
            }
            let mut stamped = opened.rows.peekable();
            start = match stamped.peek() {
                Some(Ok(first)) => first.stamp.time,
                _ => 0.0,
            };
            rate = given;
            rows = Box::new(stamped.map(|it| it.map(|it| it.row)));
        } else {
            let even = Even::of_rows(file, opened.rows, opened.header)?;
            (rate, start) = (even.rate(), even.start());
            rows = Box::new(even);
        }
        // Another rate would make something else of it.
        let learnt = (opened.learnt.take()).filter(|_| reading.resample.is_none());
        Ok(Self {
            columns: opened.columns,
            rate,
            start,
            format: opened.format,
            is_episode: opened.is_episode || learnt.is_some(),
            learnt,
            size: opened.size,
            rows,
            meter: opened.meter,
            remarks,
            doubt: Doubt::new(file, scene),
        })
    }

    /// Bytes read so far.
    pub fn bytes_read(&self) -> u64 {
        self.meter.bytes()
    }

    /// What is worth a warning so far; after the last row, also what makes one doubt.
    pub fn warnings(&self) -> Vec<String> {
        let mut warnings = self.remarks.take();
        warnings.extend(self.doubt.warnings());
        warnings
    }
}

impl Iterator for Recording {
    type Item = Result<Row, InputError>;

    fn next(&mut self) -> Option<Self::Item> {
        let row = self.rows.next()?;
        if let Ok(row) = &row {
            self.doubt.take(row);
        }
        Some(row)
    }
}

/// Opens a file; also how many bytes it has.
fn opened(path: &Path) -> Result<(BufReader<File>, u64), InputError> {
    let name = path.display().to_string();
    let fail = |error: std::io::Error| InputError::of_file(&name, reason(&error));
    if path.is_dir() {
        return Err(InputError::of_file(&name, "is a folder, not a file"));
    }
    let file = File::open(path).map_err(fail)?;
    let size = file.metadata().map_err(fail)?.len();
    Ok((BufReader::with_capacity(1 << 16, file), size))
}

fn of_comtrade<R: Read + 'static>(
    dat: comtrade::Dat<R>,
    size: u64,
    reading: &Reading,
    scene: &Scene,
    remarks: &Remarks,
) -> Result<Opened, InputError> {
    let meter = dat.meter();
    let rows = ComtradeRows::new(dat, reading.mapping.as_ref(), &scene.sensors, remarks)?;
    let cfg = rows.dat().cfg();
    if let (false, None, None) = (cfg.rates.is_empty(), cfg.rate(), reading.resample) {
        let rates: Vec<_> = cfg
            .rates
            .iter()
            .map(|(rate, last)| format!("{rate} Hz up to sample {last}"))
            .collect();
        let rule = format!(
            "the sample rate changes: {}; --resample RATE makes one of them and says so",
            rates.join(", ")
        );
        return Err(InputError::of_file(rows.dat().file(), rule));
    }
    let is_episode = cfg.is_episode && reading.mapping.is_none();
    let sensors = scene.sensors;
    Ok(Opened {
        columns: rows.pick().columns(),
        meter,
        rate: cfg.rate(),
        header: 1,
        format: Some(format!("COMTRADE {}, {} data", cfg.year, cfg.data)),
        learnt: Before::default(),
        is_episode,
        size,
        rows: Box::new(rows.map(move |it| {
            let mut stamped = it?;
            if is_episode {
                let positions = &mut stamped.row.positions;
                *positions = of_own_axes(positions, &sensors);
            }
            Ok(stamped)
        })),
    })
}

fn format_of(layout: &Layout) -> String {
    let decimal = match layout.decimal {
        mapping::Decimal::Point => "",
        mapping::Decimal::Comma => " and decimal commas",
    };
    let before = match layout.before.1 {
        0 => String::new(),
        lines => format!(", rows from line {}", lines + 1),
    };
    format!(
        "text, {} columns with {} between{decimal}{before}",
        layout.columns.len(),
        layout.delimiter
    )
}
