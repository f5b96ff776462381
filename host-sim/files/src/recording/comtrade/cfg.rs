//! The configuration of a COMTRADE recording (IEEE C37.111-1991, -1999, -2013): channels, rates, times.

use std::str::FromStr;

use chrono::{Datelike, NaiveDateTime};

use crate::recording::pick::Heading;

/// Most channels of a kind that are believed.
const MOST_CHANNELS: usize = 10_000;
/// Most rates that are believed.
const MOST_RATES: usize = 1000;
/// Station of an episode.
pub const STATION: &str = "touchdown";
/// Beginning of the device of an episode.
pub const DEVICE: &str = "episode ";

#[derive(Clone, Debug, PartialEq)]
pub struct Cfg {
    /// Of the standard.
    pub year: u16,
    /// Whether it is the export of an episode: along the channels' axes, with zero and gain of a commissioning check.
    pub is_episode: bool,
    /// In the order of the data, as the digital ones.
    pub analog: Vec<Analog>,
    pub digital: Vec<Heading>,
    /// Each rate (Hz) and the number of its last sample; none where the stamps alone tell.
    pub rates: Vec<(f64, u64)>,
    /// Samples in all.
    pub samples: u64,
    /// First sample before the trigger, s; `None` where the dates cannot be read.
    pub start: Option<f64>,
    pub data: Data,
    /// Of one unit of a stamp, s.
    pub tick: f64,
}

/// An analog channel: value = scale count + shift.
#[derive(Clone, Debug, PartialEq)]
pub struct Analog {
    pub heading: Heading,
    /// `a`.
    pub scale: f64,
    /// `b`.
    pub shift: f64,
    /// Time by which it is sampled later, us.
    pub skew: f64,
    /// Largest count.
    pub most: f64,
}

/// How the data are written.
#[derive(Clone, Copy, Debug, PartialEq, Eq, strum::Display, strum::EnumString)]
#[strum(serialize_all = "UPPERCASE", ascii_case_insensitive)]
pub enum Data {
    Ascii,
    /// Whole numbers of 16 bit.
    Binary,
    Binary32,
    Float32,
}

/// The lines of the text, one after the other, with their numbers.
struct Lines<'a> {
    lines: std::str::Lines<'a>,
    number: u64,
    /// Of the line that was read last.
    fields: Vec<&'a str>,
}

type Diagnostic = (u64, String);

/// As much of a text as belongs into a message.
fn shown(text: &str) -> &str {
    const MOST: usize = 40;
    let end = text.char_indices().nth(MOST).map_or(text.len(), |it| it.0);
    &text[..end]
}

impl<'a> Lines<'a> {
    /// Goes on to the next line, that of `what`.
    fn next(&mut self, what: &str) -> Result<&'a str, Diagnostic> {
        self.number += 1;
        let Some(line) = self.lines.next() else {
            return self.fail(format!("the file ends before the line of {what}"));
        };
        self.fields = line.split(',').map(str::trim).collect();
        Ok(line)
    }

    fn fail<T>(&self, rule: impl Into<String>) -> Result<T, Diagnostic> {
        Err((self.number, rule.into()))
    }

    /// A field of the line, empty where there is none.
    fn text(&self, at: usize) -> &'a str {
        self.fields.get(at).copied().unwrap_or("")
    }

    fn number<T: FromStr>(&self, at: usize, what: &str) -> Result<T, Diagnostic> {
        let text = self.text(at);
        let number = text.parse();
        number.or_else(|_| self.fail(format!("{what} must be a number, is {:?}", shown(text))))
    }

    fn finite(&self, at: usize, what: &str) -> Result<f64, Diagnostic> {
        match self.number(at, what)? {
            number if f64::is_finite(number) => Ok(number),
            number => self.fail(format!("{what} must be finite, is {number}")),
        }
    }

    /// Likewise; `other` where the field is empty.
    fn finite_or(&self, other: f64, at: usize, what: &str) -> Result<f64, Diagnostic> {
        match self.text(at) {
            "" => Ok(other),
            _ => self.finite(at, what),
        }
    }
}

impl Cfg {
    /// Reads the text; else the line and the rule.
    pub fn parse(text: &str) -> Result<Self, Diagnostic> {
        let mut lines = Lines {
            lines: text.lines(),
            number: 0,
            fields: Vec::new(),
        };
        lines.next("station and device")?;
        let is_episode = lines.text(0) == STATION && lines.text(1).starts_with(DEVICE);
        let year = match lines.text(2) {
            "" => 1991,
            _ => lines.number(2, "the year of the standard")?,
        };
        let (analogs, digitals) = counts(&mut lines)?;
        let analog = (0..analogs).map(|_| analog(&mut lines));
        let analog = analog.collect::<Result<_, _>>()?;
        let digital = (0..digitals).map(|_| {
            lines.next("a digital channel")?;
            Ok(heading(&lines, ""))
        });
        let digital = digital.collect::<Result<_, Diagnostic>>()?;
        lines.next("the line frequency")?;
        let (rates, samples) = rates(&mut lines)?;
        lines.next("the first sample's time")?;
        let (date, time) = (lines.text(0), lines.text(1));
        let (begin, digits) = (instant(date, time, year), decimals(time));
        lines.next("the trigger's time")?;
        let instants = begin.zip(instant(lines.text(0), lines.text(1), year));
        let kind = lines.next("the kind of the data file")?;
        let Ok(data) = kind.trim().parse() else {
            let rule = "must be ASCII, BINARY, BINARY32 or FLOAT32";
            return lines.fail(format!("the kind of the data file {rule}, is {kind:?}"));
        };
        let factor = "the factor of the stamps";
        let multiple = match lines.next(factor) {
            Ok(_) if year > 1991 => lines.finite_or(1.0, 0, factor)?,
            _ => 1.0,
        };
        if multiple <= 0.0 {
            return lines.fail(format!("{factor} must be above 0"));
        }
        // Since 2013 stamps count nanoseconds where the dates do.
        let nano = year >= 2013 && digits > 6;
        let start = instants.map(|(begin, trigger)| (begin - trigger).as_seconds_f64());
        Ok(Self {
            year,
            is_episode,
            analog,
            digital,
            rates,
            samples,
            start,
            data,
            tick: multiple * if nano { 1e-9 } else { 1e-6 },
        })
    }

    /// Bytes of a sample in a binary file.
    pub fn bytes(&self) -> usize {
        let analog = match self.data {
            Data::Binary => 2,
            _ => 4,
        };
        8 + analog * self.analog.len() + 2 * self.digital.len().div_ceil(16)
    }

    /// The one rate of the recording, Hz; `None` where it has several or none.
    pub fn rate(&self) -> Option<f64> {
        let (first, _) = *self.rates.first()?;
        let same = self.rates.iter().all(|(rate, _)| *rate == first);
        (same && first > 0.0).then_some(first)
    }

    /// Time of sample `number` (from 0) after the first, by the rates, s.
    pub fn time(&self, number: u64) -> f64 {
        let (mut time, mut from) = (0.0, 0);
        for &(rate, last) in &self.rates {
            if number <= last {
                return time + (number - from) as f64 / rate;
            }
            time += (last - from) as f64 / rate;
            from = last;
        }
        time
    }
}

/// Numbers of analog and of digital channels.
fn counts(lines: &mut Lines) -> Result<(usize, usize), Diagnostic> {
    lines.next("the numbers of channels")?;
    let count = |at: usize, letter: char| -> Option<usize> {
        let text = lines.text(at).to_ascii_uppercase();
        text.strip_suffix(letter)?.parse().ok()
    };
    let (Some(analogs), Some(digitals)) = (count(1, 'A'), count(2, 'D')) else {
        let (all, rule) = (lines.fields.join(","), "must be as 4,3A,1D");
        return lines.fail(format!(
            "the numbers of channels {rule}, are {:?}",
            shown(&all)
        ));
    };
    if analogs > MOST_CHANNELS || digitals > MOST_CHANNELS {
        return lines.fail(format!("there are more than {MOST_CHANNELS} channels"));
    }
    let total: usize = lines.number(0, "the number of channels")?;
    if total != analogs + digitals {
        return lines.fail(format!("{total} channels are not {analogs} and {digitals}"));
    }
    Ok((analogs, digitals))
}

fn analog(lines: &mut Lines) -> Result<Analog, Diagnostic> {
    lines.next("an analog channel")?;
    Ok(Analog {
        heading: heading(lines, lines.text(4)),
        scale: lines.finite(5, "the factor a of a channel")?,
        shift: lines.finite(6, "the offset b of a channel")?,
        skew: lines.finite_or(0.0, 7, "the skew of a channel")?,
        most: lines.finite_or(0.0, 9, "the largest count of a channel")?,
    })
}

/// Of a channel; the unit as it is written.
fn heading(lines: &Lines, unit: &str) -> Heading {
    Heading {
        text: lines.text(1).to_owned(),
        unit: (!unit.is_empty()).then(|| unit.to_owned()),
    }
}

/// Rates with their last samples, and samples in all.
fn rates(lines: &mut Lines) -> Result<(Vec<(f64, u64)>, u64), Diagnostic> {
    lines.next("the number of rates")?;
    let count: usize = lines.number(0, "the number of rates")?;
    if count > MOST_RATES {
        return lines.fail(format!("there are more than {MOST_RATES} rates"));
    }
    let (mut rates, mut samples) = (Vec::new(), 0);
    for _ in 0..count.max(1) {
        lines.next("a rate")?;
        let rate = lines.finite(0, "a rate")?;
        let last: u64 = lines.number(1, "the last sample of a rate")?;
        if rate < 0.0 || last <= samples {
            return lines.fail("a rate must be 0 or more, and the samples must go up");
        }
        samples = last;
        rates.push((rate, last));
    }
    if count == 0 || rates.iter().any(|(rate, _)| *rate == 0.0) {
        rates.clear();
    }
    Ok((rates, samples))
}

/// `dd/mm/yyyy` and `hh:mm:ss.ssssss`; in 1991 the month came first, and the year may have two digits.
fn instant(date: &str, time: &str, standard: u16) -> Option<NaiveDateTime> {
    let order = if standard > 1991 { "%d/%m" } else { "%m/%d" };
    let format = format!("{order}/%Y %H:%M:%S%.f");
    let read = NaiveDateTime::parse_from_str(&format!("{date} {time}"), &format).ok()?;
    match read.year() {
        year @ 0..100 => read.with_year(year + 1900),
        _ => Some(read),
    }
}

/// Digits of the seconds' fraction.
fn decimals(time: &str) -> usize {
    time.split_once('.').map_or(0, |(_, digits)| digits.len())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn days_count_from_1970() {
        let days = |date: &str, standard| {
            let read = instant(date, "00:00:00", standard)?;
            Some(read.and_utc().timestamp() / 86_400)
        };
        assert_eq!(days("01/01/1970", 1999), Some(0));
        assert_eq!(days("29/02/2000", 1999), Some(11_016));
        assert_eq!(days("02/29/2000", 1991), Some(11_016));
        assert_eq!(days("2/29/72", 1991), Some(789));
        assert_eq!(days("00/00/2000", 1999), None);
    }

    #[test]
    fn times_of_day_have_up_to_nine_decimals() {
        let at = |time: &str| instant("01/01/2024", time, 2013);
        let since = |time: &str| Some((at(time)? - at("0:00:00")?).as_seconds_f64());
        assert_eq!(since("12:34:56.123456789"), Some(45_296.123_456_789));
        assert_eq!(since("1:02:03"), Some(3_723.0));
        assert_eq!(since("1:02"), None);
    }

    #[test]
    fn times_go_on_from_rate_to_rate() {
        let text = "s,d,1999\n0,0A,0D\n50\n2\n1000,10\n2000,30\n01/01/2024,00:00:00\n01/01/2024,00:00:01\nASCII\n1\n";
        let cfg = Cfg::parse(text).unwrap();
        assert_eq!((cfg.rate(), cfg.samples, cfg.start), (None, 30, Some(-1.0)));
        assert_eq!([0, 10, 12].map(|k| cfg.time(k)), [0.0, 0.01, 0.011]);
    }
}
