//! Reads a recorded stream, strictly: a row that breaks a rule ends it.

use std::io::Read;

use csv::StringRecord;
use touchdown_core::sample::{CHANNELS, TACHOMETERS};

use super::Columns;
use super::account::Account;
use super::bounded::Bounded;
use super::clock::Stamp;
use super::learnt::{LEARNT, of_field};
use super::row::{Pulses, Row, Stamped};
use touchdown_base::input_error::InputError;
use touchdown_scene::rule::{MICRO, RPM};

/// Whole numbers up to here are exact.
const MOST_EDGES: f64 = 9_007_199_254_740_992.0;

/// The rows of a stream as they stand there, whatever their times.
pub struct Records<R> {
    account: Account,
    records: csv::Reader<Bounded<R>>,
    /// The columns.
    pub columns: Columns,
    header: Vec<&'static str>,
    record: StringRecord,
    begun: bool,
}

impl<R: Read> Records<R> {
    /// Reads the header of `bytes`, of which `account` is.
    pub fn new(bytes: R, account: &Account) -> Result<Self, InputError> {
        let bytes = Bounded::new(bytes, account);
        let mut records = csv::ReaderBuilder::new()
            .flexible(true)
            .trim(csv::Trim::All)
            .from_reader(bytes);
        let header = records.headers();
        let header = header.map_err(|error| account.csv_error(&error))?;
        let names: Vec<_> = header.iter().collect();
        let known = names.strip_suffix(&[LEARNT]).unwrap_or(&names);
        let Some(columns) = Columns::of_header(known) else {
            let rule = format!(
                "the header must be time_s,ax_um,ay_um[,bx_um,by_um][,speed_rpm][,levitated]\
                 [,inner_ring_edges,inner_ring_edge_age_us][,cage_edges,cage_edge_age_us][,learnt], is {:?}",
                names.join(",")
            );
            return Err(account.at_line(1, rule));
        };
        let mut header = columns.header();
        header.extend((known.len() < names.len()).then_some(LEARNT));
        Ok(Self {
            account: account.clone(),
            records,
            columns,
            header,
            record: StringRecord::new(),
            begun: false,
        })
    }

    fn read(&mut self) -> Result<Option<Stamped>, InputError> {
        let read = self.records.read_record(&mut self.record);
        if !read.map_err(|error| self.account.csv_error(&error))? {
            self.check_end()?;
            return Ok(None);
        }
        let row = self.parse()?;
        if self.header.last() == Some(&LEARNT) {
            self.learn()?;
        }
        Ok(Some(row))
    }

    fn line(&self) -> u64 {
        self.record.position().map_or(1, csv::Position::line)
    }

    fn parse(&self) -> Result<Stamped, InputError> {
        let (record, header, columns) = (&self.record, &self.header, &self.columns);
        let line = self.line();
        let fail = |rule: String| self.account.at_line(line, rule);
        let (needed, there) = (header.len(), record.len());
        if there != needed {
            let rule = format!("a row needs {needed} fields, this one has {there}");
            return Err(fail(rule));
        }
        let broken = |(name, text): (&str, &str), rule: &str| {
            fail(format!("{name} must be {rule}, is {text:?}"))
        };
        let mut fields = header.iter().copied().zip(record);
        // There are as many as the columns want.
        let mut next = || fields.next().unwrap_or_default();
        let time = next();
        let stamp = Stamp::parse(time.1).ok_or_else(|| broken(time, "a finite number"))?;
        let number = |(name, text): (&str, &str)| match text.parse::<f64>() {
            _ if is_missing(text) => Ok(f64::NAN),
            Ok(value) if value.is_finite() => Ok(value),
            _ => Err(broken((name, text), "a finite number, empty or NaN")),
        };
        let mut positions = [f64::NAN; CHANNELS];
        for position in &mut positions[..2 * usize::from(columns.planes)] {
            *position = MICRO * number(next())?;
        }
        let spin = columns.speed.then(|| number(next())).transpose()?;
        let levitated = match columns.levitated.then(&mut next) {
            Some((_, "0")) => Some(false),
            Some((_, "1")) => Some(true),
            Some(field) if !is_missing(field.1) => {
                return Err(broken(field, "0, 1, empty or NaN"));
            }
            _ => None,
        };
        let mut edges = [None; TACHOMETERS];
        for (pulses, _) in (edges.iter_mut().zip(columns.edges)).filter(|(_, there)| *there) {
            let (counted, aged) = (next(), next());
            let (count, age) = (number(counted)?, MICRO * number(aged)?);
            if !(count.is_nan() || (0.0..=MOST_EDGES).contains(&count) && count.fract() == 0.0) {
                let rule = "a whole number from 0 to 2^53, empty or NaN";
                return Err(broken(counted, rule));
            }
            if age < 0.0 {
                return Err(broken(aged, "0 or more"));
            }
            let is_known = !count.is_nan() && !age.is_nan();
            let count = count as u64;
            *pulses = is_known.then_some(Pulses { count, age });
        }
        let row = Row {
            time: stamp.time,
            positions,
            spin: spin.map(|it| RPM * it).filter(|it| !it.is_nan()),
            levitated,
            edges,
        };
        Ok(Stamped { stamp, row, line })
    }

    /// The last field of a row: only the first one's has something in it.
    fn learn(&mut self) -> Result<(), InputError> {
        let text = &self.record[self.header.len() - 1];
        let is_first = !std::mem::replace(&mut self.begun, true);
        if text.is_empty() {
            return Ok(());
        }
        let fail = |rule: &str| self.account.at_line(self.line(), rule);
        if !is_first {
            return Err(fail("learnt has a value in the first row only"));
        }
        let learnt = of_field(text);
        let rule = "learnt is not what `touchdown log export` of this version writes";
        let learnt = Box::new(learnt.ok_or_else(|| fail(rule))?);
        self.account.learnt.replace(Some(learnt));
        Ok(())
    }

    /// A number that lost its last digits is still a number: only the newline shows that the last
    /// row is whole.
    fn check_end(&self) -> Result<(), InputError> {
        if self.account.ends_in(b"\n") {
            return Ok(());
        }
        let last = self.records.position().line();
        let rule = "the last line is cut off: it does not end with a newline";
        Err(self.account.at_line(last, rule))
    }
}

impl<R: Read> Iterator for Records<R> {
    type Item = Result<Stamped, InputError>;

    fn next(&mut self) -> Option<Self::Item> {
        self.read().transpose()
    }
}

/// Whether a field says that there is no value.
pub fn is_missing(field: &str) -> bool {
    field.is_empty() || field.eq_ignore_ascii_case("nan")
}
