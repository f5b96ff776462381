//! The constant rate behind printed time stamps.
//!
//! A stamp is rounded to its last printed digit. Each one bounds the period; the bounds of all
//! stamps so far must leave a period, or else the rate is not constant.

use std::ops::RangeInclusive;

/// Rows that are read before the rate is settled.
pub const LOOK_AHEAD: usize = 4096;

/// Unevenness of the stamps that passes, part of a period.
const JITTER: f64 = 0.1;
/// Unevenness that passes for sums of rounded periods, part of the time since the first stamp.
const DRIFT: f64 = 1e-9;

/// Follows the stamps of a stream.
#[derive(Debug)]
pub struct Clock {
    first: Stamp,
    last: Stamp,
    intervals: u64,
    /// Periods that explain every stamp so far, s.
    period: RangeInclusive<f64>,
}

/// A time as it was printed.
#[derive(Clone, Copy, Debug)]
pub struct Stamp {
    /// s.
    pub time: f64,
    /// Half of its last printed digit, s.
    pub rounding: f64,
}

impl Stamp {
    /// Reads a finite decimal number.
    pub fn parse(text: &str) -> Option<Self> {
        let time: f64 = text.parse().ok().filter(|time: &f64| time.is_finite())?;
        let (mantissa, exponent) = text
            .split_once(['e', 'E'])
            .map_or(Some((text, 0)), |(mantissa, exponent)| {
                Some((mantissa, exponent.parse::<i32>().ok()?))
            })?;
        let decimals = mantissa
            .split_once('.')
            .map_or(0, |(_, digits)| digits.len());
        let last_digit = exponent.saturating_sub(i32::try_from(decimals).ok()?);
        Some(Self {
            time,
            rounding: 0.5 * 10_f64.powi(last_digit),
        })
    }
}

impl Clock {
    /// Starts at the first stamp.
    pub fn new(first: Stamp) -> Self {
        Self {
            first,
            last: first,
            intervals: 0,
            period: 0.0..=f64::INFINITY,
        }
    }

    /// Takes the next stamp, or says which rule it breaks.
    pub fn take(&mut self, stamp: Stamp) -> Result<(), String> {
        let Stamp { time, rounding } = stamp;
        if time <= self.last.time {
            return Err(format!(
                "time_s must increase, but {time} follows {}",
                self.last.time
            ));
        }
        let since = time - self.first.time;
        let count = (self.intervals + 1) as f64;
        let period = if self.intervals == 0 {
            since
        } else {
            self.middle()
        };
        // Trailing zeros are often left out: "0.0001" may be as sharp as "0.00015". A rounding
        // of half a period or more would hide a missing row.
        let rounded = (rounding + self.first.rounding).min(0.45 * period);
        let slack = rounded + JITTER * period + DRIFT * since;
        let low = ((since - slack) / count).max(*self.period.start());
        let high = ((since + slack) / count).min(*self.period.end());
        if low > high {
            return Err(format!(
                "the sample rate is not constant: {} s after the last row, {period} s before",
                time - self.last.time
            ));
        }
        self.period = low..=high;
        self.last = stamp;
        self.intervals += 1;
        Ok(())
    }

    /// Time of the first stamp, s.
    pub fn start(&self) -> f64 {
        self.first.time
    }

    /// Samples per second: of all rates that the rounding of the first and the last stamp allows,
    /// the roundest; `None` before the second stamp.
    pub fn rate(&self) -> Option<f64> {
        if self.intervals == 0 {
            return None;
        }
        let since = self.last.time - self.first.time;
        let count = self.intervals as f64;
        let mean = count / since;
        let slack = (self.first.rounding + self.last.rounding).min(0.45 / mean) + DRIFT * since;
        let allowed = count / (since + slack)..=count / (since - slack);
        let roundest = [1e4, 1e3, 1e2, 1e1, 1.0]
            .map(|unit| (mean / unit).round() * unit)
            .into_iter()
            .find(|rate| allowed.contains(rate));
        Some(roundest.unwrap_or(mean))
    }

    fn middle(&self) -> f64 {
        0.5 * (self.period.start() + self.period.end())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn follow(stamps: impl IntoIterator<Item = String>) -> Result<Clock, String> {
        let mut stamps = stamps.into_iter().map(|text| Stamp::parse(&text).unwrap());
        let mut clock = Clock::new(stamps.next().unwrap());
        stamps.try_for_each(|stamp| clock.take(stamp))?;
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
