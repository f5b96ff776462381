//! Recordings as they come: CSV of any style or COMTRADE, as rows of a stream. `docs/use/recordings.md`.

mod comtrade;
mod doubt;
mod layout;
mod mapping;
mod pick;
mod resample;
mod text;
mod unit;

use std::io::{BufReader, Read};
use std::iter;
use std::path::Path;

pub use comtrade::{DEVICE, STATION, is_pair};
pub use mapping::Mapping;

use comtrade::{ComtradeRows, Dat, combined, is_combined};
use doubt::Doubt;
use layout::Layout;
use resample::Resampled;
use text::{Head, TextRows};

use touchdown_core::learnt::Learnt;

use crate::stream::{
    Account, Columns, Even, Records, Row, Stamped, is_rate, not_a_rate, of_own_axes,
};
use touchdown_base::input_error::InputError;
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
    account: Account,
    doubt: Doubt,
}

impl Recording {
    /// Opens the recording at `path`; `scene` has the sensors and what can be expected.
    pub fn open(path: &Path, reading: &Reading, scene: &Scene) -> Result<Self, InputError> {
        let account = Account::of(path.display().to_string());
        if !is_pair(path) {
            let (bytes, size) = InputError::open(path)?;
            return Self::of_bytes(&account.file, bytes, size, reading, scene);
        }
        let (dat, size) = comtrade::open(path, &account)?;
        let source = Source {
            account,
            size,
            reading,
            scene,
        };
        source.comtrade(dat)
    }

    /// Reads the `size` bytes of the file `file`: a text, or by its name both parts of COMTRADE in one.
    pub fn of_bytes(
        file: &str,
        bytes: impl Read + 'static,
        size: u64,
        reading: &Reading,
        scene: &Scene,
    ) -> Result<Self, InputError> {
        let source = Source {
            account: Account::of(file),
            size,
            reading,
            scene,
        };
        if is_combined(Path::new(file)) {
            let dat = combined(Box::new(BufReader::new(bytes)), &source.account)?;
            return source.comtrade(dat);
        }
        let head = Head::read(bytes, &source.account)?;
        match &reading.mapping {
            Some(mapping) => source.mapped(head, mapping),
            None => source.stream(head),
        }
    }

    /// Bytes read so far.
    pub fn bytes_read(&self) -> u64 {
        self.account.bytes()
    }

    /// What is worth a warning so far; after the last row, also what makes one doubt.
    pub fn warnings(&self) -> Vec<String> {
        let mut warnings = self.account.take_warnings();
        let doubts = self.doubt.warnings().into_iter();
        warnings.extend(doubts.map(|it| format!("{}: {it}", self.account.file)));
        warnings
    }
}

impl Iterator for Recording {
    type Item = Result<Row, InputError>;

    fn next(&mut self) -> Option<Self::Item> {
        let row = self.rows.next()?;
        match &row {
            Ok(row) => self.doubt.take(row),
            // Nothing comes after what is wrong.
            Err(_) => self.rows = Box::new(iter::empty()),
        }
        Some(row)
    }
}

/// What a recording of any kind is read with.
struct Source<'a> {
    account: Account,
    size: u64,
    reading: &'a Reading,
    scene: &'a Scene,
}

impl Source<'_> {
    fn mapped(
        self,
        head: Head<impl Read + 'static>,
        mapping: &Mapping,
    ) -> Result<Recording, InputError> {
        let mut rows = TextRows::new(head, mapping, &self.scene.sensors, &self.account)?;
        let (header, format) = (rows.layout.before.1.max(1), format_of(&rows.layout));
        let (columns, rate) = (rows.pick.columns(), rows.rate);
        let rows = iter::from_fn(move || rows.read().transpose());
        Ok(Recording {
            format: Some(format),
            ..self.paced(columns, rows, rate, header)?
        })
    }

    fn stream(self, head: Head<impl Read + 'static>) -> Result<Recording, InputError> {
        let found = head.layout(&Default::default());
        let records = Records::new(head.whole(0), &self.account);
        let records = records.map_err(|error| match &found {
            Ok(layout) => {
                let rule = "; --columns FILE.toml says which column is what; ".to_owned();
                error.and(rule + &pick::list(&layout.columns))
            }
            Err(_) => error,
        })?;
        self.paced(records.columns, records, None, 1)
    }

    fn comtrade(self, dat: Dat) -> Result<Recording, InputError> {
        let (mapping, sensors) = (self.reading.mapping.as_ref(), self.scene.sensors);
        let mut rows = ComtradeRows::new(dat, mapping, &sensors)?;
        let cfg = &rows.dat.cfg;
        if let (false, None, None) = (cfg.rates.is_empty(), cfg.rate(), self.reading.resample) {
            let rates = cfg.rates.iter();
            let rates = rates.map(|(rate, last)| format!("{rate} Hz up to sample {last}"));
            let rates = rates.collect::<Vec<_>>().join(", ");
            let rule = "--resample RATE makes one of them and says so";
            let rule = format!("the sample rate changes: {rates}; {rule}");
            return Err(rows.dat.account.of_file(rule));
        }
        let is_episode = cfg.is_episode && mapping.is_none();
        let format = format!("COMTRADE {}, {} data", cfg.year, cfg.data);
        let (columns, rate) = (rows.pick.columns(), cfg.rate());
        let rows = iter::from_fn(move || {
            let mut read = rows.read();
            if let (true, Ok(Some(stamped))) = (is_episode, &mut read) {
                let positions = &mut stamped.row.positions;
                *positions = of_own_axes(positions, &sensors);
            }
            read.transpose()
        });
        Ok(Recording {
            format: Some(format),
            is_episode,
            ..self.paced(columns, rows, rate, 1)?
        })
    }

    /// `rate` where no stamp can tell another; `header` is its line.
    fn paced(
        self,
        columns: Columns,
        stamped: impl Iterator<Item = Result<Stamped, InputError>> + 'static,
        rate: Option<f64>,
        header: u64,
    ) -> Result<Recording, InputError> {
        let account = self.account;
        let (rows, rate, start): (Rows, f64, f64) = if let Some(wanted) = self.reading.resample {
            if columns.edges != [false; 2] {
                return Err(account.of_file("counted edges cannot be resampled"));
            }
            let resampled = Resampled::new(&account, Box::new(stamped), wanted)?;
            let start = resampled.start;
            (Box::new(resampled), wanted, start)
        } else if let Some(given) = rate {
            if !is_rate(given) {
                let rule = "--resample RATE makes another of it and says so";
                let rule = format!("{}; {rule}", not_a_rate(given));
                return Err(account.of_file(rule));
            }
            let mut stamped = stamped.peekable();
            let first = stamped.peek().and_then(|it| it.as_ref().ok());
            let start = first.map_or(0.0, |it| it.stamp.time);
            let rows = stamped.map(|it| it.map(|it| it.row));
            (Box::new(rows), given, start)
        } else {
            let even = Even::of_rows(&account, stamped, header)?;
            let (rate, start) = (even.rate, even.start());
            (Box::new(even), rate, start)
        };
        // Another rate would make something else of it.
        let learnt = account.learnt.take();
        let learnt = learnt.filter(|_| self.reading.resample.is_none());
        Ok(Recording {
            columns,
            rate,
            start,
            format: None,
            is_episode: learnt.is_some(),
            learnt,
            size: self.size,
            rows,
            account,
            doubt: Doubt::new(self.scene),
        })
    }
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
    let (count, delimiter) = (layout.columns.len(), layout.delimiter);
    format!("text, {count} columns with {delimiter} between{decimal}{before}")
}
