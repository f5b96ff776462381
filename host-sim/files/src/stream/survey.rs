//! How the times of a file really go: rate, jitter, gaps.

use std::fmt;

use super::clock::round;
use super::row::{RATES, Stamped};
use touchdown_base::input_error::InputError;

/// Rows that are read on after the first that is uneven.
const MOST: usize = 1_000_000;
/// Lines that are named.
const NAMED: usize = 5;
/// An interval longer than so many periods is a gap.
const GAP: f64 = 1.5;

/// Counts what is uneven, in constant memory.
#[derive(Clone, Debug, Default)]
pub struct Survey {
    /// Median of the first intervals, s.
    period: f64,
    first: f64,
    last: f64,
    intervals: u64,
    shortest: f64,
    longest: f64,
    /// Sum of the squares of their differences from the period, s^2.
    squares: f64,
    gaps: Lines,
    back: Lines,
    /// Whether the file goes on.
    cut: bool,
}

/// The first lines of a kind, and how many there are.
#[derive(Clone, Debug, Default)]
struct Lines {
    count: u64,
    first: Vec<u64>,
}

impl Lines {
    fn add(&mut self, line: u64) {
        self.count += 1;
        if self.first.len() < NAMED {
            self.first.push(line);
        }
    }
}

impl fmt::Display for Lines {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let lines: Vec<_> = self.first.iter().map(u64::to_string).collect();
        let is_more = self.count > NAMED as u64;
        let more = if is_more { ", ..." } else { "" };
        let word = if self.count == 1 { "line" } else { "lines" };
        write!(f, "{word} {}{more}", lines.join(", "))
    }
}

/// Median of the intervals between `times` (s) that go forward; infinite where there is none.
pub fn median_interval(first: f64, times: impl Iterator<Item = f64>) -> f64 {
    let mut last = first;
    let intervals = times.map(|time| time - std::mem::replace(&mut last, time));
    let mut intervals: Vec<f64> = intervals.filter(|it| *it > 0.0).collect();
    let middle = intervals.len() / 2;
    if intervals.is_empty() {
        return f64::INFINITY;
    }
    *intervals.select_nth_unstable_by(middle, f64::total_cmp).1
}

impl Survey {
    /// Starts at `first` (s); `times` are those after it that are known already.
    pub fn new(first: f64, times: impl Iterator<Item = f64>) -> Self {
        Self {
            period: median_interval(first, times),
            first,
            last: first,
            shortest: f64::INFINITY,
            ..Self::default()
        }
    }

    /// Takes the next time (s), of line `line`.
    pub fn take(&mut self, time: f64, line: u64) {
        let interval = time - self.last;
        self.last = time;
        self.intervals += 1;
        self.longest = self.longest.max(interval);
        self.shortest = self.shortest.min(interval);
        if interval <= 0.0 {
            self.back.add(line);
        } else if interval > GAP * self.period {
            self.gaps.add(line);
        } else {
            self.squares += (interval - self.period).powi(2);
        }
    }

    /// Takes what follows, as far as it can be read.
    pub fn read_on(&mut self, rows: &mut impl Iterator<Item = Result<Stamped, InputError>>) {
        for _ in 0..MOST {
            match rows.next() {
                Some(Ok(next)) => self.take(next.stamp.time, next.line),
                Some(Err(_)) | None => return,
            }
        }
        self.cut = true;
    }

    /// The rate of most intervals, as near as a round number is, Hz.
    fn rate(&self) -> f64 {
        let rate = 1.0 / self.period;
        let mut round = round(rate).into_iter();
        let near = round.find(|it| (it / rate - 1.0).abs() < 0.01);
        near.unwrap_or(rate).clamp(*RATES.start(), *RATES.end())
    }
}

impl fmt::Display for Survey {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let mean = self.intervals as f64 / (self.last - self.first);
        let usual = self.intervals - self.gaps.count - self.back.count;
        let jitter = (self.squares / usual.max(1) as f64).sqrt() / self.period;
        let rows = if self.cut { "first rows" } else { "rows" };
        let (count, middle) = (self.intervals + 1, 1.0 / self.period);
        let (shortest, longest, jitter) = (self.shortest, self.longest, 100.0 * jitter);
        write!(
            f,
            "found in its {count} {rows}: {mean:.6} Hz on average, {middle:.6} Hz in the middle, intervals of \
             {shortest:.3e} to {longest:.3e} s, jitter {jitter:.2} %"
        )?;
        if self.gaps.count > 0 {
            let word = if self.gaps.count == 1 { "gap" } else { "gaps" };
            write!(f, ", {} {word} ({})", self.gaps.count, self.gaps)?;
        }
        if self.back.count > 0 {
            let (count, lines) = (self.back.count, &self.back);
            write!(f, ", {count} times not later than the one before ({lines})")?;
            let rule = "a file whose stamps are coarser than its rate needs the rate itself";
            return write!(f, "; {rule}: rate_hz in the [time] of --columns");
        }
        write!(f, "; --resample {} makes it even and says so", self.rate())
    }
}
