//! The constant rate behind printed time stamps.
//!
//! A stamp is rounded to the digits that its printer gives: a fixed number of decimals or of
//! significant digits, with trailing zeros or without. Each stamp bounds the period; the bounds of
//! all stamps so far must leave a period, or else the rate is not constant.

use std::ops::RangeInclusive;
use touchdown_base::plain::Number;

/// Rows that are read before the rate is settled.
pub const LOOK_AHEAD: usize = 4096;

/// Unevenness of a stamp that passes beside its rounding, part of a period.
const JITTER: f64 = 0.01;
/// The same for the time between two rows.
const INTERVAL_JITTER: f64 = 0.1;
/// Unevenness that passes for sums of rounded periods, part of the time since the first stamp.
const DRIFT: f64 = 1e-9;
/// Largest rounding that passes, part of a period: more would hide a missing row.
const COARSEST: f64 = 0.45;

/// Digits of a number that is not rounded to fewer.
const MOST_DIGITS: i32 = 17;

/// Follows the stamps of a stream.
#[derive(Debug)]
pub struct Clock {
    /// Time of the first stamp, s.
    pub first: f64,
    last: f64,
    intervals: u64,
    /// Periods that explain every stamp so far, s.
    period: RangeInclusive<f64>,
    print: Print,
}

/// A time as it was printed.
#[derive(Clone, Copy, Debug)]
pub struct Stamp {
    /// s.
    pub time: f64,
    print: Print,
}

/// The most digits of one or more stamps.
#[derive(Clone, Copy, Debug)]
struct Print {
    decimals: i32,
    significant: i32,
}

impl Print {
    /// Half of the last digit that `time` is printed with, s.
    fn rounding(self, time: f64) -> f64 {
        let leading = time.abs().max(f64::MIN_POSITIVE).log10().floor() as i32;
        let last_digit = (-self.decimals).max(leading + 1 - self.significant);
        0.5 * 10_f64.powi(last_digit)
    }
}

impl Stamp {
    /// Reads a finite decimal number.
    pub fn parse(text: &str) -> Option<Self> {
        let time: f64 = text.parse().ok().filter(|time: &f64| time.is_finite())?;
        let (mantissa, exponent) = match text.split_once(['e', 'E']) {
            Some((mantissa, exponent)) => (mantissa, exponent.parse::<i32>().ok()?),
            None => (text, 0),
        };
        let (whole, fraction) = mantissa.split_once('.').unwrap_or((mantissa, ""));
        let digits = [whole.trim_start_matches(['+', '-']), fraction].concat();
        let print = Print {
            decimals: i32::try_from(fraction.len()).ok()?.saturating_sub(exponent),
            significant: i32::try_from(digits.trim_start_matches('0').len()).ok()?,
        };
        Some(Self { time, print })
    }

    /// A time (s) that is not rounded.
    pub fn exact(time: f64) -> Self {
        let print = Print {
            decimals: MOST_DIGITS,
            significant: MOST_DIGITS,
        };
        Self { time, print }
    }

    /// A time (s) that was counted in ticks of so many seconds.
    pub fn counted(time: f64, tick: f64) -> Self {
        let print = Print {
            decimals: -(tick.log10().ceil() as i32),
            significant: MOST_DIGITS,
        };
        Self { time, print }
    }

    /// The same in a unit of so many powers of ten.
    pub fn times_ten_to(mut self, power: i32) -> Option<Self> {
        // A division by an exact power keeps the digits.
        self.time = if power < 0 {
            self.time / 10_f64.powi(-power)
        } else {
            self.time * 10_f64.powi(power)
        };
        self.print.decimals = self.print.decimals.checked_sub(power)?;
        self.time.is_finite().then_some(self)
    }
}

impl Clock {
    /// Starts at the first stamp.
    pub fn new(first: Stamp) -> Self {
        Self {
            first: first.time,
            last: first.time,
            intervals: 0,
            period: 0.0..=f64::INFINITY,
            print: first.print,
        }
    }

    /// Learns from a stamp how the printer rounds; the sooner, the sharper the check.
    pub fn learn(&mut self, stamp: Stamp) {
        self.print.decimals = self.print.decimals.max(stamp.print.decimals);
        self.print.significant = self.print.significant.max(stamp.print.significant);
    }

    /// Takes the next stamp, or says which rule it breaks.
    pub fn take(&mut self, stamp: Stamp) -> Result<(), String> {
        self.learn(stamp);
        let time = stamp.time;
        let interval = time - self.last;
        if interval <= 0.0 {
            let (now, last) = (Number(time), Number(self.last));
            return Err(format!("time_s must increase, but {now} follows {last}"));
        }
        let since = time - self.first;
        let count = (self.intervals + 1) as f64;
        let period = if self.intervals == 0 {
            since
        } else {
            self.middle()
        };
        let coarsest = COARSEST * period;
        let rounding = self.print.rounding(time);
        let uneven = (interval - period).abs() - INTERVAL_JITTER * period;
        let rounded = (rounding + self.print.rounding(self.first)).min(coarsest);
        let slack = rounded + JITTER * period + DRIFT * since;
        let low = ((since - slack) / count).max(*self.period.start());
        let high = ((since + slack) / count).min(*self.period.end());
        if low > high || uneven > (2.0 * rounding).min(coarsest) {
            let rule =
                format!("{interval:.3e} s after the row before, the period is {period:.3e} s");
            return Err(format!("the sample rate is not constant: {rule}"));
        }
        self.period = low..=high;
        self.last = time;
        self.intervals += 1;
        Ok(())
    }

    /// Samples per second: of all rates that the rounding of the first and the last stamp allows,
    /// the roundest; `None` before the second stamp.
    pub fn rate(&self) -> Option<f64> {
        if self.intervals == 0 {
            return None;
        }
        let since = self.last - self.first;
        let count = self.intervals as f64;
        let mean = count / since;
        let rounded = self.print.rounding(self.first) + self.print.rounding(self.last);
        let slack = rounded.min(COARSEST / mean) + DRIFT * since;
        let allowed = count / (since + slack)..=count / (since - slack);
        let roundest = round(mean).into_iter().find(|it| allowed.contains(it));
        Some(roundest.unwrap_or(mean))
    }

    fn middle(&self) -> f64 {
        0.5 * (self.period.start() + self.period.end())
    }
}

/// The number, rounded to ever more digits.
pub(super) fn round(number: f64) -> [f64; 5] {
    [1e4, 1e3, 1e2, 1e1, 1.0].map(|unit| (number / unit).round() * unit)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn follow(stamps: impl IntoIterator<Item = String>) -> Result<Clock, String> {
        let stamps: Vec<_> = stamps
            .into_iter()
            .map(|text| Stamp::parse(&text).unwrap())
            .collect();
        let mut clock = Clock::new(stamps[0]);
        stamps.iter().for_each(|stamp| clock.learn(*stamp));
        stamps[1..]
            .iter()
            .try_for_each(|stamp| clock.take(*stamp))?;
        Ok(clock)
    }

    #[test]
    fn every_rate_survives_microsecond_stamps() {
        for rate in [
            100.0, 7_000.0, 20_000.0, 30_000.0, 44_100.0, 150_000.0, 200_000.0,
        ] {
            let stamps = (0..5000).map(|k| format!("{:.6}", f64::from(k) / rate - 0.01));
            assert_eq!(follow(stamps).unwrap().rate(), Some(rate), "{rate} Hz");
        }
    }

    #[test]
    fn shortest_and_exponent_prints_pass() {
        let stamps = (0..5000).map(|k| format!("{:?}", f64::from(k) / 30_000.0));
        assert_eq!(follow(stamps).unwrap().rate(), Some(30_000.0));
        let stamps = (0..5000).map(|k| format!("{:e}", f64::from(k) / 20_000.0));
        assert_eq!(follow(stamps).unwrap().rate(), Some(20_000.0));
    }

    #[test]
    fn summed_periods_pass() {
        let stamps = (0..200_000).scan(0.0, |time, _| {
            *time += 1.0 / 20_000.0;
            Some(format!("{time}"))
        });
        assert_eq!(follow(stamps).unwrap().rate(), Some(20_000.0));
    }

    #[test]
    fn six_significant_digits_pass() {
        for start in [0.0, 1.2345, 12.0] {
            let stamps = (0..8000).map(|k| {
                let time = start + f64::from(k) / 1000.0;
                let digits = if time > 0.0 {
                    5 - time.log10().floor() as i32
                } else {
                    0
                };
                let factor = 10_f64.powi(digits);
                format!("{}", (time * factor).round() / factor)
            });
            assert_eq!(
                follow(stamps).unwrap().rate(),
                Some(1000.0),
                "from {start} s"
            );
        }
    }

    #[test]
    fn three_rows_show_a_changed_rate() {
        for last in ["0.0015", "0.003", "0.0013"] {
            let stamps = ["0", "0.001", last].map(str::to_owned);
            assert!(
                follow(stamps).unwrap_err().contains("not constant"),
                "{last}"
            );
        }
    }

    #[test]
    fn a_row_that_is_missing_after_hours_is_found() {
        let period = 1.0 / 20_000.0;
        let mut clock = Clock::new(Stamp::parse("0").unwrap());
        clock.last = 80_000.0;
        clock.intervals = 1_600_000_000;
        clock.period = period * (1.0 - 1e-12)..=period * (1.0 + 1e-12);
        let stamp = Stamp::parse("80000.000100").unwrap();
        assert!(clock.take(stamp).is_err());
    }

    #[test]
    fn a_changed_rate_is_found() {
        let time = |k: i32| f64::from(k.min(1000)) + 1.05 * f64::from((k - 1000).max(0));
        let stamps = (0..1020).map(|k| format!("{:.6}", time(k) / 20_000.0));
        assert!(follow(stamps).unwrap_err().contains("not constant"));
    }

    #[test]
    fn a_missing_row_is_found() {
        for digits in [5, 6, 12] {
            let stamps = (0..2000)
                .filter(|k| *k != 700)
                .map(|k| format!("{:.digits$}", f64::from(k) / 20_000.0));
            assert!(follow(stamps).is_err(), "{digits} digits");
        }
    }

    #[test]
    fn time_must_go_forward() {
        for next in ["0.0001", "0.00005"] {
            let stamps = ["0", "0.0001", next].map(str::to_owned);
            assert!(follow(stamps).unwrap_err().contains("must increase"));
        }
    }
}
