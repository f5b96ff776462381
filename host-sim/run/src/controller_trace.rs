//! A run of the controller: what is done to it, what its monitor says, and what it does besides: outputs, log and link.

use std::collections::{BTreeMap, BTreeSet};

use serde::Serialize;
use touchdown_core::checksum::CRC;
use touchdown_core::event::{Alarm, Level, Notice, Ordered};
use touchdown_core::learnt::Learnt;
use touchdown_core::monitor::Summary;
use touchdown_core::sensing::PLANES;
use touchdown_core::severity::Severity;
use touchdown_protocol::controller::{Fault, Mode};
use touchdown_protocol::link::{Counters, Hello, State};
use touchdown_protocol::wire::Switching;

use crate::timebase::Timebase;
use touchdown_base::paint::Paint;
use touchdown_files::controller::{AlarmAt, OutputsFrom, table};
use touchdown_files::drop_log::{Completeness, Dump, Episode};
use touchdown_files::link::refused_why;

/// Notices that are kept; a recording of any length has to fit.
const MOST_NOTICES: usize = 100_000;

/// What is done to a controller over a recording, and where it begins. By default a lift was seen before it, and
/// nothing is ordered.
#[derive(Clone, Debug, Default)]
pub struct Procedure {
    /// What the monitor had learnt before the first sample.
    pub learnt: Option<Box<Learnt>>,
    /// Switched on with the first sample: nothing is proven.
    pub power_on: bool,
    /// Samples, from 0, before which an order to clear comes.
    pub clear_at: BTreeSet<u64>,
    /// Upper ends of the zones A, B and C, as parts of the clearance.
    pub zones: [f64; 3],
}

impl Procedure {
    /// The zone of that plane of a sample that is farther out, by displacements and `clearance`, m; none where no plane
    /// delivers.
    pub(crate) fn zone(&self, clearance: f64, planes: [Option<[f32; 2]>; PLANES]) -> Option<usize> {
        let distances = planes.into_iter().flatten();
        let distances = distances.map(|[x, y]| f64::from(x).hypot(f64::from(y)));
        let distance = distances.reduce(f64::max)?;
        let inner = self.zones.iter().filter(|it| distance > **it * clearance);
        Some(inner.count())
    }
}

/// What the monitor said over a run.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct MonitorOutput {
    /// In the order of the ticks.
    pub notices: Vec<Notice>,
    /// Later ones, counted.
    pub left_out: u64,
    /// Of the last drop in it.
    pub severity: Severity,
    /// Last.
    pub summary: Summary,
    /// What the target printed.
    pub log: Vec<String>,
}

impl MonitorOutput {
    /// Takes the next notice, while there is room.
    pub(crate) fn hear(&mut self, notice: Notice) {
        if self.notices.len() < MOST_NOTICES {
            self.notices.push(notice);
        } else {
            self.left_out += 1;
        }
    }
}

/// What the controller did. The same bits on the desktop and in the emulator.
#[derive(Clone, Debug, PartialEq)]
pub struct ControllerTrace {
    /// What it showed at the first sample, and each change.
    pub outputs: Vec<Switching>,
    /// Of the guard.
    pub alarms: Vec<Alarm>,
    /// What came of the orders.
    pub orders: Vec<Ordered>,
    /// Samples in the zones A to D.
    pub zones: [u64; 4],
    /// Flash of the drop log after the run: docs/formats/log.md.
    pub flash: Vec<u8>,
    /// What the link answered to Hello.
    pub hello: Hello,
    /// What it answered to State after the last sample.
    pub state: State,
}

/// The same with times, for people and programs.
#[derive(Debug, Serialize)]
pub struct Controller {
    outputs: Vec<OutputsFrom>,
    touches: u32,
    alarms: Vec<AlarmAt>,
    orders: Vec<OrderAt>,
    zones: BTreeMap<&'static str, f64>,
    log: Log,
    link: Link,
}

#[derive(Debug, Serialize)]
struct OrderAt {
    /// Of the sample before which it came, s.
    time_s: f64,
    order: &'static str,
    done: bool,
    why: Option<String>,
}

#[derive(Debug, Serialize)]
struct Log {
    /// CRC-32 of all its bytes.
    checksum: u32,
    #[serde(flatten)]
    dump: Dump,
}

/// What came over the link after the last sample.
#[derive(Debug, Serialize)]
struct Link {
    firmware: String,
    sample_rate_hz: f32,
    mode: Mode,
    faults: Vec<Fault>,
    #[serde(flatten)]
    counters: Counters,
}

impl ControllerTrace {
    /// Without log and zones; alarms and orders are among the `notices`.
    pub(crate) fn new(
        notices: &[Notice],
        outputs: Vec<Switching>,
        hello: Hello,
        state: State,
    ) -> Self {
        let (mut alarms, mut orders) = (Vec::new(), Vec::new());
        for notice in notices {
            match *notice {
                Notice::Alarm(alarm) => alarms.push(alarm),
                Notice::Ordered(order) => orders.push(order),
                _ => {}
            }
        }
        Self {
            outputs,
            alarms,
            orders,
            zones: [0; 4],
            flash: Vec::new(),
            hello,
            state,
        }
    }

    /// Part of the samples in each zone.
    pub fn zone_parts(&self) -> [f64; 4] {
        let all = self.zones.iter().sum::<u64>().max(1) as f64;
        self.zones.map(|it| it as f64 / all)
    }

    /// With the times of the samples.
    pub fn told(&self, timebase: Timebase) -> Controller {
        let time = |sample: u64| timebase.time(sample as f64);
        let order = |it: &Ordered| {
            let why = refused_why(it.refused);
            OrderAt {
                time_s: time(it.sample.wrapping_add(1)),
                order: it.act.into(),
                done: why.is_none(),
                why,
            }
        };
        let (outputs, alarms, state) = (self.outputs.iter(), self.alarms.iter(), &self.state);
        Controller {
            outputs: (outputs.map(|it| OutputsFrom::new(it, time(it.sample)))).collect(),
            touches: state.touches,
            alarms: (alarms.map(|it| AlarmAt::new(it, time(it.sample)))).collect(),
            orders: self.orders.iter().map(order).collect(),
            zones: ["a", "b", "c", "d"]
                .into_iter()
                .zip(self.zone_parts())
                .collect(),
            log: Log {
                checksum: CRC.checksum(&self.flash),
                dump: Dump::of(&self.flash),
            },
            link: Link {
                firmware: self.hello.firmware.to_string(),
                sample_rate_hz: self.hello.sample_rate,
                mode: state.mode,
                faults: state.faults.iter().collect(),
                counters: state.counters,
            },
        }
    }
}

impl Controller {
    /// For the terminal, in 80 columns.
    pub fn text(&self, paint: Paint) -> String {
        let mut text = table(&self.outputs, paint);
        let dangers = self.alarms.iter().filter(|it| it.level == Level::Danger);
        let (touches, alarms, dangers) = (self.touches, self.alarms.len(), dangers.count());
        text += &format!("guard: {touches} touches, {alarms} alarms, {dangers} of them danger\n");
        for it in &self.orders {
            let (time, came) = (it.time_s * 1e3, it.why.as_deref().unwrap_or("done"));
            text += &format!("{} at {time:.4} ms: {came}\n", it.order);
        }
        for episode in &self.log.dump.episodes {
            text += &logged(episode);
        }
        let link = &self.link;
        text + &format!(
            "link: firmware {}, {} Hz; lost: {} samples, {} notices; {} damaged frames\n",
            link.firmware,
            link.sample_rate_hz,
            link.counters.lost_samples,
            link.counters.lost_notices,
            link.counters.damaged_frames
        )
    }
}

fn logged(episode: &Episode) -> String {
    let state = match (episode.damaged, episode.complete) {
        (true, _) => "damaged",
        (false, Completeness::Yes) => "whole",
        (false, Completeness::Open | Completeness::CutOff) => "open at the end of the run",
    };
    let trigger = episode
        .header
        .map_or("no header", |it| it.trigger_kind.into());
    let (number, events) = (episode.sequence, episode.events.len());
    let samples = episode.samples.iter().flatten().count();
    format!("log: episode {number}, {trigger}; {samples} samples, {events} events, {state}\n")
}
