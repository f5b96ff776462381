//! Rows at a rate that they do not have: linear between neighbours, and no value across a gap.

use crate::stream::{Account, LOOK_AHEAD, Row, Stamped, median_interval};
use touchdown_base::input_error::InputError;
use touchdown_base::plain::Number;

/// An interval longer than so many usual ones is a gap: what was between is not known.
const GAP: f64 = 3.5;

/// Most samples that are made of one row.
const FINEST: f64 = 10.0;
/// A longer gap is between two recordings, s.
const LONGEST_GAP: f64 = 60.0;

/// A time within this part of the usual interval of a row is that row's.
const SAME: f64 = 1e-6;

/// Rows as they come.
type StampedRows = Box<dyn Iterator<Item = Result<Stamped, InputError>>>;

/// Rows at a rate of choice.
pub struct Resampled {
    account: Account,
    rows: StampedRows,
    /// The rows about the next time.
    from: Stamped,
    to: Option<Stamped>,
    /// Time of the first row, s.
    pub start: f64,
    rate: f64,
    /// Usual interval of the rows, s.
    usual: f64,
    read: u64,
    made: u64,
    gaps: u64,
    empty: u64,
}

impl Resampled {
    /// Of `rows`, at `rate` (Hz), from the first of them on.
    pub fn new(account: &Account, mut rows: StampedRows, rate: f64) -> Result<Self, InputError> {
        let Some(from) = rows.next().transpose()? else {
            return Err(account.of_file("there are no rows"));
        };
        let start = from.stamp.time;
        let ahead = (&mut rows).take(LOOK_AHEAD);
        let ahead = ahead.collect::<Result<Vec<_>, _>>()?;
        let usual = median_interval(start, ahead.iter().map(|it| it.stamp.time));
        let mut resampled = Self {
            account: account.clone(),
            rows: Box::new(ahead.into_iter().map(Ok).chain(rows)),
            from,
            to: None,
            start,
            rate,
            usual,
            read: 1,
            made: 0,
            gaps: 0,
            empty: 0,
        };
        resampled.to = resampled.read()?;
        if resampled.to.is_none() {
            let rule = "one row alone has no sample rate";
            return Err(account.at_line(from.line, rule));
        }
        if rate * usual > FINEST {
            let rule = format!("more than {FINEST} samples a row, most of them made up");
            let apart = format!("most rows are {usual:.3e} s apart: at {rate} Hz that is");
            return Err(account.of_file(format!("{apart} {rule}")));
        }
        Ok(resampled)
    }

    fn read(&mut self) -> Result<Option<Stamped>, InputError> {
        let Some(next) = self.rows.next().transpose()? else {
            return Ok(None);
        };
        self.read += 1;
        let last = self.to.unwrap_or(self.from).stamp.time;
        let time = next.stamp.time;
        let (before, now) = (Number(last), Number(time));
        let rule = if time <= last {
            let rule = "no rate can be made of that";
            format!("time must increase, but {now} s follows {before} s: {rule}")
        } else if time - last > LONGEST_GAP {
            let rule = "a gap of more than a minute is between two recordings";
            format!("{before} s is followed by {now} s: {rule}")
        } else {
            self.gaps += u64::from(time - last > GAP * self.usual);
            return Ok(Some(next));
        };
        Err(self.account.at_line(next.line, rule))
    }

    fn make(&mut self) -> Result<Option<Row>, InputError> {
        let time = self.start + self.made as f64 / self.rate;
        let to = loop {
            let Some(to) = self.to else {
                return Ok(None);
            };
            if time <= to.stamp.time + SAME * self.usual {
                break to;
            }
            let next = self.read()?;
            (self.from, self.to) = (to, next);
        };
        self.made += 1;
        let row = between(&self.from, &to, time, self.usual);
        self.empty += u64::from(row.positions[0].is_nan());
        Ok(Some(row))
    }

    fn tell(&self) {
        let gaps = match self.gaps {
            0 => String::new(),
            gaps => format!("; {gaps} gaps, in which nothing is made up"),
        };
        let (read, made, rate, empty) = (self.read, self.made, self.rate, self.empty);
        let mean = (read - 1) as f64 / (self.from.stamp.time - self.start);
        let from = format!("from {read} rows at {mean:.6} Hz on average");
        let to = format!("to {made} samples at {rate} Hz, {empty} of them without a value{gaps}");
        let rule = format!("resampled, linear between neighbours, {from} {to}");
        self.account.doubt(&rule);
    }
}

/// The row at `time` (s) between two rows that are `usual` (s) apart if none is missing.
fn between(from: &Stamped, to: &Stamped, time: f64, usual: f64) -> Row {
    let length = to.stamp.time - from.stamp.time;
    let at_from = time - from.stamp.time <= SAME * usual;
    let at_to = to.stamp.time - time <= SAME * usual;
    let part = (time - from.stamp.time) / length;
    let mix = |a: f64, b: f64| match (at_from, at_to) {
        (true, _) => a,
        (false, true) => b,
        _ if length > GAP * usual => f64::NAN,
        _ => a + part * (b - a),
    };
    let (from, to) = (&from.row, &to.row);
    let spins = from.spin.zip(to.spin);
    Row {
        time,
        positions: std::array::from_fn(|it| mix(from.positions[it], to.positions[it])),
        spin: spins.map(|(a, b)| mix(a, b)).filter(|it| !it.is_nan()),
        levitated: if at_to { to.levitated } else { from.levitated },
        edges: from.edges,
    }
}

impl Iterator for Resampled {
    type Item = Result<Row, InputError>;

    fn next(&mut self) -> Option<Self::Item> {
        let row = self.make().transpose();
        if !matches!(row, Some(Ok(_))) {
            self.tell();
        }
        row
    }
}
