//! Rows at one constant rate, or an error that says how their times really go.

use std::collections::VecDeque;

use super::account::Account;
use super::clock::{Clock, LOOK_AHEAD, Stamp};
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
        let mut clock = Clock::new(first.stamp);
        let mut ahead = VecDeque::from([first.row]);
        let mut stamps = Vec::new();
        for next in rows.by_ref().take(LOOK_AHEAD - 1) {
            let next = next?;
            clock.learn(next.stamp);
            ahead.push_back(next.row);
            stamps.push((next.stamp, next.line));
        }
        let second = stamps.first().map_or(first.line, |(_, line)| *line);
        let finished = stamps.len() + 1 < LOOK_AHEAD;
        let times = stamps.iter().map(|(stamp, _)| stamp.time);
        let mut even = Self {
            account: account.clone(),
            rows,
            clock,
            survey: Survey::new(first.stamp.time, times),
            ahead,
            rate: 0.0,
            finished,
        };
        for (index, (stamp, line)) in stamps.iter().enumerate() {
            if let Err(rule) = even.hold(*stamp, *line) {
                let rest = &stamps[index + 1..];
                rest.iter().for_each(|it| even.survey.take(it.0.time, it.1));
                return Err(even.uneven(*line, rule));
            }
        }
        let Some(rate) = even.clock.rate() else {
            let rule = "one row alone has no sample rate";
            return Err(account.at_line(first.line, rule));
        };
        if !is_rate(rate) {
            return Err(account.at_line(second, not_a_rate(rate)));
        }
        even.rate = rate;
        Ok(even)
    }

    /// Time of the first row, s.
    pub fn start(&self) -> f64 {
        self.clock.first
    }

    fn hold(&mut self, stamp: Stamp, line: u64) -> Result<(), String> {
        self.survey.take(stamp.time, line);
        self.clock.take(stamp)
    }

    fn read_row(&mut self) -> Result<Option<Row>, InputError> {
        if self.finished {
            return Ok(None);
        }
        let Some(next) = self.rows.next().transpose()? else {
            return Ok(None);
        };
        match self.hold(next.stamp, next.line) {
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
