//! Recordings as COMTRADE (IEEE C37.111, all its editions), text or binary.
//!
//! Read sample by sample, so that a recording of any size fits; the crates of that name read all of it.

mod cfg;
mod dat;
mod files;

pub use cfg::{DEVICE, STATION};
pub use dat::Dat;
pub use files::{combined, is_combined, is_pair, open};

use cfg::Data;

use super::mapping::Mapping;
use super::pick::{Heading, Pick, by_name, list};
use crate::stream::{Stamp, Stamped};
use touchdown_base::input_error::InputError;
use touchdown_base::plain::Number;
use touchdown_scene::sensors::SensorsConfig;

/// Part of a period by which a stamp may miss the rate.
const OFF: f64 = 0.5;

/// Ticks at which the stamps of binary data begin again.
const WRAP: f64 = 4_294_967_296.0;

/// Samples of a recording, its channels as a mapping has them.
pub struct ComtradeRows {
    pub dat: Dat,
    /// What is taken of it.
    pub pick: Pick,
    /// First stamp, ticks.
    first: Option<f64>,
}

impl ComtradeRows {
    /// Finds the channels of `mapping`, or without one those that are named as in a stream.
    pub fn new(
        dat: Dat,
        mapping: Option<&Mapping>,
        sensors: &SensorsConfig,
    ) -> Result<Self, InputError> {
        let (cfg, account) = (&dat.cfg, &dat.account);
        let fail = |rule: String| account.of_file(rule);
        let analog = cfg.analog.iter().map(|it| &it.heading);
        let found: Vec<Heading> = analog.chain(&cfg.digital).cloned().collect();
        let rule = "no channels are named ax and ay: --columns says which they are";
        let unnamed = || fail(format!("{rule}; {}", list(&found)));
        let named = by_name(&found);
        let mapping = mapping.or(named.as_ref()).ok_or_else(unnamed)?;
        if mapping.time.is_some() {
            let rule = "COMTRADE has its own rate: leave out [time] of --columns";
            return Err(fail(rule.to_owned()));
        }
        let pick = Pick::new(mapping, &found, sensors, account).map_err(fail)?;
        for channel in pick.used().iter().filter_map(|it| cfg.analog.get(*it)) {
            let (name, late) = (&channel.heading.text, Number(channel.skew));
            if channel.skew != 0.0 {
                let rule = format!("channel {name} is sampled {late} us late, which is not undone");
                account.doubt(&rule);
            }
        }
        if cfg.start.is_none() {
            let rule = "the dates of first sample and trigger cannot be read";
            account.doubt(&format!("{rule}; time 0 is the first sample"));
        }
        Ok(Self {
            dat,
            pick,
            first: None,
        })
    }

    /// The next sample's row.
    pub fn read(&mut self) -> Result<Option<Stamped>, InputError> {
        let Some((number, stamp)) = self.dat.next()? else {
            let (there, told) = (self.dat.records, self.dat.cfg.samples);
            if there < told {
                let rule = format!("the data end at sample {there} of {told}: the file is cut off");
                return Err(self.dat.flaw(rule));
            }
            return Ok(None);
        };
        let cfg = &self.dat.cfg;
        let line = self.dat.records;
        if line > cfg.samples {
            let told = cfg.samples;
            let rule = format!("there are more than the {told} samples of the configuration");
            return Err(self.dat.flaw(rule));
        }
        if number != line {
            let rule = "one is missing, or the file is damaged";
            return Err((self.dat).flaw(format!("sample {line} is numbered {number}: {rule}")));
        }
        let start = cfg.start.unwrap_or(0.0);
        let first = *self.first.get_or_insert(stamp.unwrap_or(0.0));
        let since = stamp.map(|it| (it - first) * cfg.tick);
        let stamp = if let Some((rate, _)) = cfg.rates.iter().find(|it| line <= it.1) {
            let since_first = cfg.time(line - 1);
            let period = 1.0 / rate;
            let wrap = match cfg.data {
                Data::Ascii => f64::INFINITY,
                _ => WRAP * cfg.tick,
            };
            let off = |since: &f64| {
                let off = (since - since_first).abs() % wrap;
                off.min(wrap - off) > OFF * period + cfg.tick
            };
            if let Some(since) = since.filter(off) {
                let rule = format!("the rates of the configuration give {since_first:.6} s");
                let stamp = format!("the stamp is {since:.6} s after the first sample");
                return Err(self.dat.flaw(format!("{stamp}, {rule}")));
            }
            Stamp::exact(start + since_first)
        } else {
            let rule = "the sample has no stamp, and the configuration no rate";
            let since = since.ok_or_else(|| self.dat.flaw(rule))?;
            Stamp::counted(start + since, cfg.tick)
        };
        Ok(Some(Stamped {
            stamp,
            row: self.pick.row(stamp.time, &self.dat.values),
            line,
        }))
    }
}
