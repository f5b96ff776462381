//! Rows at a rate that they do not have: linear between neighbours, and no value across a gap.

use crate::stream::{Account, Row, Stamped, median_interval};
use touchdown_base::input_error::InputError;
use touchdown_base::plain::Number;

/// Intervals from which the usual one is known.
const LOOK_AHEAD: usize = 4096;
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
            let rule = format!(
                "most rows are {usual:.3e} s apart: at {rate} Hz that is more than {FINEST} samples a row, most of them made up"
            );
            return Err(account.of_file(rule));
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
        if time <= last {
            let rule = format!(
                "time must increase, but {} s follows {} s: no rate can be made of that",
                Number(time),
                Number(last)
            );
            return Err(self.account.at_line(next.line, rule));
        }
        if time - last > LONGEST_GAP {
            let rule = format!(
                "{} s is followed by {} s: a gap of more than a minute is between two recordings",
                Number(last),
                Number(time)
            );
            return Err(self.account.at_line(next.line, rule));
        }
        if time - last > GAP * self.usual {
            self.gaps += 1;
        }
        Ok(Some(next))
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
        let times = self.from.stamp.time - self.start;
        self.account.warn(format!(
            "{}: resampled, linear between neighbours, from {} rows at {:.6} Hz on average to {} samples at {} Hz, \
             {} of them without a value{gaps}",
            self.account.file,
            self.read,
            (self.read - 1) as f64 / times,
            self.made,
            self.rate,
            self.empty,
        ));
    }
}

/// The row at `time` (s) between two rows that are `usual` (s) apart if none is missing.
fn between(from: &Stamped, to: &Stamped, time: f64, usual: f64) -> Row {
    let length = to.stamp.time - from.stamp.time;
    let at_from = time - from.stamp.time <= SAME * usual;
    let at_to = to.stamp.time - time <= SAME * usual;
    let part = (time - from.stamp.time) / length;
    let mix = |a: f64, b: f64| {
        if at_from {
            a
        } else if at_to {
            b
        } else if length > GAP * usual {
            f64::NAN
        } else {
            a + part * (b - a)
        }
    };
    let mut row = from.row;
    row.time = time;
    for (place, (a, b)) in
        (row.positions.iter_mut()).zip(from.row.positions.iter().zip(to.row.positions))
    {
        *place = mix(*a, b);
    }
    let spins = from.row.spin.zip(to.row.spin);
    row.spin = spins.map(|(a, b)| mix(a, b)).filter(|it| !it.is_nan());
    row.levitated = if at_to {
        to.row.levitated
    } else {
        from.row.levitated
    };
    row
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
