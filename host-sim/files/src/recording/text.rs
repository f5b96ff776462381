//! Rows of a recording that is a text.

use std::io::{Chain, Cursor, Read};

use csv::ByteRecord;

use super::layout::{HEAD, Layout, text_of, with_point};
use super::mapping::{Mapping, TextHints};
use super::pick::{Pick, list};
use crate::stream::{Account, Bounded, Stamp, Stamped, is_missing};
use touchdown_base::input_error::{InputError, UTF_16, is_utf_16, reason};
use touchdown_scene::sensors::SensorsConfig;

/// The first part of a file, and the rest of it.
pub struct Head<R> {
    bytes: Vec<u8>,
    rest: R,
}

impl<R: Read> Head<R> {
    /// Reads the first part of `bytes`, in an encoding that is known.
    pub fn read(mut bytes: R, account: &Account) -> Result<Self, InputError> {
        let mut head = Vec::new();
        let read = (&mut bytes).take(HEAD as u64).read_to_end(&mut head);
        read.map_err(|error| account.of_file(reason(&error)))?;
        if is_utf_16(&head) {
            return Err(account.at_line(1, UTF_16));
        }
        Ok(Self {
            bytes: head,
            rest: bytes,
        })
    }

    /// How it is written.
    pub fn layout(&self, hints: &TextHints) -> Result<Layout, (u64, String)> {
        Layout::find(&self.bytes, self.bytes.len() < HEAD, hints)
    }

    /// All of it again, from byte `from` of the first part.
    pub fn whole(self, from: usize) -> Chain<Cursor<Vec<u8>>, R> {
        let mut first = Cursor::new(self.bytes);
        first.set_position(from as u64);
        first.chain(self.rest)
    }
}

/// Rows of a text, its columns as a mapping has them.
pub struct TextRows<R> {
    account: Account,
    pub layout: Layout,
    pub pick: Pick,
    used: Vec<usize>,
    /// The rate that the mapping gives, Hz.
    pub rate: Option<f64>,
    records: csv::Reader<Bounded<Chain<Cursor<Vec<u8>>, R>>>,
    record: ByteRecord,
    values: Vec<f64>,
    /// Rows so far.
    rows: u64,
    /// Whether `record` is one that is not handed out yet, or why it cannot be read.
    there: Result<bool, InputError>,
}

impl<R: Read> TextRows<R> {
    /// Finds how the text is written and where its columns are.
    pub fn new(
        head: Head<R>,
        mapping: &Mapping,
        sensors: &SensorsConfig,
        account: &Account,
    ) -> Result<Self, InputError> {
        let layout = head.layout(&mapping.text);
        let layout = layout.map_err(|(line, rule)| account.at_line(line, rule))?;
        let header = layout.before.1.max(1);
        let fail = |rule: String| account.at_line(header, rule);
        let pick = Pick::new(mapping, &layout.columns, sensors, account).map_err(fail)?;
        let rate = mapping.time.as_ref().and_then(|it| it.get_ref().rate_hz);
        if pick.time.is_none() && rate.is_none() {
            let rule = "nothing says when its rows were sampled: [time] of --columns needs a column or rate_hz";
            return Err(fail(format!("{rule}; {}", list(&layout.columns))));
        }
        let bytes = Bounded::new(head.whole(layout.before.0), account);
        let records = csv::ReaderBuilder::new()
            .has_headers(false)
            .flexible(true)
            .trim(csv::Trim::All)
            .delimiter(layout.delimiter as u8)
            .comment(layout.comment.map(|it| it as u8))
            .from_reader(bytes);
        let mut rows = Self {
            account: account.clone(),
            values: vec![f64::NAN; layout.columns.len()],
            used: pick.used(),
            layout,
            pick,
            rate,
            records,
            record: ByteRecord::new(),
            rows: 0,
            there: Ok(false),
        };
        rows.there = rows.advance();
        Ok(rows)
    }

    fn line(&self) -> u64 {
        self.layout.before.1 + self.record.position().map_or(1, csv::Position::line)
    }

    fn advance(&mut self) -> Result<bool, InputError> {
        let read = self.records.read_byte_record(&mut self.record);
        let before = self.layout.before.1;
        read.map_err(|error| self.account.csv_error(&error).further(before))
    }

    /// The next row. A number that lost its last digits is still a number: only the end of its line shows that the
    /// last row is whole.
    pub fn read(&mut self) -> Result<Option<Stamped>, InputError> {
        if !std::mem::replace(&mut self.there, Ok(false))? {
            return Ok(None);
        }
        let line = self.line();
        let row = self.parse(line);
        self.there = self.advance();
        if matches!(self.there, Ok(false)) && !self.account.ends_in(b"\r\n") {
            let rule = "it does not end with a newline, so it may be cut off";
            let at = format!("{}:{line}", self.account.file);
            let text = format!("{at}: the last line is left out: {rule}");
            self.account.warn(text);
            return Ok(None);
        }
        let row = row.map_err(|rule| self.account.at_line(line, rule));
        row.map(Some)
    }

    fn parse(&mut self, line: u64) -> Result<Stamped, String> {
        let (needed, there) = (self.layout.columns.len(), self.record.len());
        if there != needed {
            return Err(format!("a row needs {needed} fields, this one has {there}"));
        }
        for index in 0..self.used.len() {
            let column = self.used[index];
            self.values[column] = self.number(column)?;
        }
        let stamp = match self.pick.time {
            Some((column, power)) => self.stamp(column, power)?,
            None => Stamp::exact(self.rows as f64 / self.rate.unwrap_or(1.0)),
        };
        self.rows += 1;
        Ok(Stamped {
            stamp,
            row: self.pick.row(stamp.time, &self.values),
            line,
        })
    }

    /// What `read` makes of a field; else that it must be `wanted`, and `more`.
    fn field<T>(
        &self,
        column: usize,
        (wanted, more): (&str, &str),
        read: impl FnOnce(&str) -> Option<T>,
    ) -> Result<T, String> {
        let bytes = &self.record[column];
        read(str::from_utf8(bytes).unwrap_or("?")).ok_or_else(|| {
            let text = text_of(bytes);
            match self.layout.columns[column].text.as_str() {
                "" => format!("column {} must be {wanted}, is {text:?}{more}", column + 1),
                name => format!("{name} must be {wanted}, is {text:?}{more}"),
            }
        })
    }

    fn number(&self, column: usize) -> Result<f64, String> {
        let wanted = ("a finite number, empty or NaN", "");
        self.field(column, wanted, |text| {
            if is_missing(text) {
                return Some(f64::NAN);
            }
            let number: f64 = with_point(text, self.layout.decimal)?.parse().ok()?;
            number.is_finite().then_some(number)
        })
    }

    fn stamp(&self, column: usize, power: i32) -> Result<Stamp, String> {
        let more = "; without one, give rate_hz in the [time] of --columns";
        self.field(column, ("a finite number", more), |text| {
            Stamp::parse(&with_point(text, self.layout.decimal)?)?.times_ten_to(power)
        })
    }
}
