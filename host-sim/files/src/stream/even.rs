//! Rows at one constant rate, or an error that says how their times really go.

use std::collections::VecDeque;

use super::account::Account;
use super::clock::{Clock, LOOK_AHEAD};
use super::row::{RATES, Row, Stamped};
use super::survey::Survey;
use touchdown_base::input_error::InputError;
use touchdown_base::plain::Number;

/// What rounding may add to either end of them, part of the rate.
const ROUNDING: f64 = 1e-6;

/// Whether the detector takes `rate` (Hz), but for rounding.
pub fn is_rate(rate: f64) -> bool {
    (RATES.start() * (1.0 - ROUNDING)..=RATES.end() * (1.0 + ROUNDING)).contains(&rate)
}

/// That `rate` (Hz) is none.
pub(crate) fn not_a_rate(rate: f64) -> String {
    let rate = Number(rate);
    format!("the sample rate must be 100 to 200000 Hz, is {rate} Hz")
}

/// Rows held to the rate of the first [`LOOK_AHEAD`] of them.
pub struct Even<I> {
    account: Account,
    rows: I,
    clock: Clock,
    survey: Survey,
    ahead: VecDeque<Row>,
    /// Samples per second, Hz.
    pub rate: f64,
    finished: bool,
}

impl<I: Iterator<Item = Result<Stamped, InputError>>> Even<I> {
    /// Reads the first rows; `before` is the line of the header.
    pub fn of_rows(account: &Account, mut rows: I, before: u64) -> Result<Self, InputError> {
        let Some(first) = rows.next().transpose()? else {
            return Err(account.at_line(before, "there are no rows after the header"));
        };
        let ahead = rows.by_ref().take(LOOK_AHEAD - 1);
        let ahead: Vec<Stamped> = ahead.collect::<Result<_, _>>()?;
        let mut clock = Clock::new(first.stamp);
        ahead.iter().for_each(|it| clock.learn(it.stamp));
        let times = ahead.iter().map(|it| it.stamp.time);
        let mut even = Self {
            account: account.clone(),
            rows,
            clock,
            survey: Survey::new(first.stamp.time, times),
            ahead: VecDeque::from([first.row]),
            rate: 0.0,
            finished: ahead.len() + 1 < LOOK_AHEAD,
        };
        for (index, next) in ahead.iter().enumerate() {
            if let Err(rule) = even.hold(next) {
                let rest = ahead[index + 1..].iter();
                rest.for_each(|it| even.survey.take(it.stamp.time, it.line));
                return Err(even.uneven(next.line, rule));
            }
            even.ahead.push_back(next.row);
        }
        let Some(rate) = even.clock.rate() else {
            let rule = "one row alone has no sample rate";
            return Err(account.at_line(first.line, rule));
        };
        if !is_rate(rate) {
            let second = ahead.first().unwrap_or(&first);
            return Err(account.at_line(second.line, not_a_rate(rate)));
        }
        even.rate = rate;
        Ok(even)
    }

    /// Time of the first row, s.
    pub fn start(&self) -> f64 {
        self.clock.first
    }

    fn hold(&mut self, next: &Stamped) -> Result<(), String> {
        self.survey.take(next.stamp.time, next.line);
        self.clock.take(next.stamp)
    }

    fn read_row(&mut self) -> Result<Option<Row>, InputError> {
        if self.finished {
            return Ok(None);
        }
        let Some(next) = self.rows.next().transpose()? else {
            return Ok(None);
        };
        match self.hold(&next) {
            Ok(()) => Ok(Some(next.row)),
            Err(rule) => Err(self.uneven(next.line, rule)),
        }
    }

    /// Reads on, to tell of all that is uneven.
    fn uneven(&mut self, line: u64, rule: String) -> InputError {
        self.survey.read_on(&mut self.rows);
        self.account
            .at_line(line, format!("{rule}; {}", self.survey))
    }
}

impl<I: Iterator<Item = Result<Stamped, InputError>>> Iterator for Even<I> {
    type Item = Result<Row, InputError>;

    fn next(&mut self) -> Option<Self::Item> {
        if let Some(row) = self.ahead.pop_front() {
            return Some(Ok(row));
        }
        let row = self.read_row();
        self.finished |= !matches!(row, Ok(Some(_)));
        row.transpose()
    }
}
