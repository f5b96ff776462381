//! One episode, as far as it is there.

use std::fmt::Display;

use serde::Serialize;
use touchdown_core::event::{EventKind, Notice};
use touchdown_core::fault::FaultKind;
use touchdown_core::sample::{CHANNELS, Edges, TACHOMETERS};
use touchdown_core::sensing::Sensing;
use touchdown_protocol::log::ending::Ending;
use touchdown_protocol::log::header::Header;
use touchdown_protocol::log::reader::{Damage, Item, MOST_BLOCKS, Reader, Report, Verdict};
use touchdown_protocol::log::waveform::{Counts, NO_VALUE, SAMPLES_PER_BLOCK};
use touchdown_protocol::wire::{Record, decode_record};

use crate::controller::{AlarmAt, OutputsFrom};
use crate::link::refused_why;
use crate::stream::{of_field, to_field};
use touchdown_scene::names::channel_name;

/// More than an episode has.
const MOST_SAMPLES: usize = MOST_BLOCKS * SAMPLES_PER_BLOCK;

/// An episode.
#[derive(Clone, Debug, Default, Serialize)]
pub struct Episode {
    /// Its number; 0 where no block tells.
    pub sequence: u32,
    /// Slot of the flash; none for a file of one episode.
    pub slot: Option<usize>,
    /// Not to be overwritten.
    pub locked: bool,
    /// Damaged, or else whether it has its ending.
    pub verdict: Verdict,
    /// Whether it was recorded to its end.
    pub complete: Completeness,
    /// Whether something of it is broken, missing, foreign, unknown or impossible.
    pub damaged: bool,
    /// Its damaged pages.
    pub damage: Vec<Damage>,
    /// What else is wrong with it.
    pub flaws: Vec<String>,
    /// What it is a record of.
    pub header: Option<Header>,
    /// What it added up to.
    pub ending: Option<Ending>,
    /// What was reported, in its order; those of an unknown kind left out.
    pub events: Vec<Event>,
    /// What the controller showed when it began, and each change.
    pub outputs: Vec<OutputsFrom>,
    /// Of the guard, while there was room.
    pub alarms: Vec<AlarmAt>,
    /// What was ordered over the link, and what came of it.
    pub orders: Vec<String>,
    /// Pages by their state.
    pub report: Report,
    /// What had been learnt before the first sample, as in a stream; none where the episode does not say.
    pub learnt: Option<String>,
    /// Version and bytes of the severity.
    pub severity: Option<(u8, Vec<u8>)>,
    /// Counts of each sample; none where its block is missing.
    #[serde(skip)]
    pub samples: Vec<Option<Counts>>,
    /// What the pulse channels showed at each sample; none where no block tells.
    #[serde(skip)]
    pub pulses: Vec<Option<[Option<Edges>; TACHOMETERS]>>,
    /// Samples of which that is known; none for a machine without such channels.
    pub samples_with_pulses: Option<usize>,
}

/// Whether an episode was recorded to its end.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, strum::IntoStaticStr)]
#[serde(rename_all = "snake_case")]
#[strum(serialize_all = "lowercase")]
pub enum Completeness {
    /// It has its ending.
    #[strum(serialize = "complete")]
    Yes,
    /// Power went before its end.
    #[default]
    #[strum(serialize = "cut off")]
    CutOff,
    /// Still being written, or cut off by a loss of power after which nothing has been switched on yet.
    Open,
}

/// An event, its times since the trigger.
#[derive(Clone, Copy, Debug, Serialize)]
pub struct Event {
    /// Kind.
    pub event: EventKind,
    /// Estimated instant, s.
    pub onset_s: f64,
    /// Tick that declared it, s.
    pub declared_s: f64,
    /// Of an impact, m/s.
    pub normal_speed_m_s: f32,
    /// Of a sensor fault.
    pub fault: Option<ChannelFault>,
}

/// What is wrong with which channel.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
pub struct ChannelFault {
    /// `ax`, `ay`, `bx`, `by` or `speed`; the first of a plane stands for the plane where both are wrong.
    pub channel: &'static str,
    /// What.
    pub kind: FaultKind,
}

impl Episode {
    /// From the pages of a slot, or of a file.
    pub fn of(pages: &[u8]) -> Self {
        let mut reader = Reader::new(pages);
        let mut episode = Self::default();
        let (mut records, mut parts) = (Vec::new(), Vec::new());
        for item in reader.by_ref() {
            match item {
                Item::Header(it) => episode.header = Some(it),
                Item::Ending(it) => episode.ending = Some(it),
                Item::Learnt(part) => parts.push(part),
                Item::Severity(version, bytes) => {
                    episode.severity = Some((version, bytes.to_vec()));
                }
                Item::Events(it) => records.extend(it.iter().filter_map(decode_record)),
                Item::Pulses(it) => put(&mut episode.pulses, it.from.into(), it.samples()),
                Item::Waveform(it) if it.start as usize >= MOST_SAMPLES => {}
                Item::Waveform(it) => put(&mut episode.samples, it.start as usize, it.samples()),
            }
        }
        episode.report = reader.finish(|it| episode.damage.push(it));
        episode.sequence = episode.report.sequence.unwrap_or(0);
        episode.verdict = episode.report.verdict();
        episode.damaged = episode.verdict == Verdict::Damaged;
        if episode.report.ended {
            episode.complete = Completeness::Yes;
        }
        // Nothing where a part is missing.
        let learnt = to_field(parts.into_iter());
        episode.learnt = of_field(&learnt).map(|_| learnt);
        if let Some(header) = episode.header {
            let known = episode.pulses.iter().flatten().count();
            episode.samples_with_pulses = (header.pulsed != 0).then_some(known);
            for flaw in impossible(&header) {
                episode.flaw(flaw);
            }
            records.iter().for_each(|it| episode.tell(it, &header));
        }
        episode
    }

    /// Takes a record in; a tick's time is that since the trigger, s.
    fn tell(&mut self, record: &Record, header: &Header) {
        let rate = f64::from(header.sample_rate);
        let since = |tick: f64| (tick - header.trigger as f64) / rate;
        match record {
            Record::Switching(it) => {
                let time = since(it.sample as f64);
                self.outputs.push(OutputsFrom::new(it, time));
            }
            Record::Notice(Notice::Alarm(it)) => {
                self.alarms.push(AlarmAt::new(it, since(it.sample as f64)));
            }
            Record::Notice(Notice::Ordered(it)) => {
                let (order, time) = (<&str>::from(it.act), 1e3 * since(it.sample as f64));
                let why = refused_why(it.refused);
                let came = why.map_or("done".to_owned(), |why| format!("refused: {why}"));
                self.orders.push(format!("{order} at {time:.4} ms: {came}"));
            }
            Record::Notice(Notice::Declared(event)) => self.events.push(Event {
                event: event.kind,
                onset_s: since(event.onset.samples()),
                declared_s: since(event.declared as f64),
                normal_speed_m_s: event.normal_speed,
                fault: event.fault.map(|it| ChannelFault {
                    channel: channel_name(it.channel),
                    kind: it.kind,
                }),
            }),
            _ => {}
        }
    }

    /// Counts as damage whatever its pages say.
    pub(super) fn flaw(&mut self, flaw: String) {
        self.flaws.push(flaw);
        self.damaged = true;
        self.verdict = Verdict::Damaged;
    }

    /// The header, where rate and scale can be what they are.
    pub fn scale(&self) -> Option<&Header> {
        self.header.as_ref().filter(|it| impossible(it).is_empty())
    }

    /// Of a sample, since the trigger, s.
    pub fn time(&self, header: &Header, sample: usize) -> f64 {
        let before = header.trigger as f64 - header.first as f64;
        (sample as f64 * f64::from(header.decimation) - before) / f64::from(header.sample_rate)
    }

    /// Displacements in the scene's axes, m, as the monitor read them; NaN where there is none. On planes that have an
    /// angle or a commissioning check one channel that is missing takes its plane.
    pub fn positions(&self, header: &Header, counts: &Option<Counts>) -> [f64; CHANNELS] {
        let count = |channel: usize| {
            let count = counts.as_ref()?.get(channel).copied()?;
            (count != NO_VALUE && header.fitted & (1 << channel) != 0).then_some(count)
        };
        if header.is_plain() {
            let (zero, resolution) = (f64::from(header.zero_count), f64::from(header.resolution));
            let place = |count| (f64::from(count) - zero) * resolution;
            return std::array::from_fn(|channel| count(channel).map_or(f64::NAN, place));
        }
        let Ok(sensing) = Sensing::try_new(&header.sensing()) else {
            return [f64::NAN; CHANNELS];
        };
        let places = sensing.place([0, 1, 2, 3].map(|channel| count(channel).map(f32::from)));
        let [[ax, ay], [bx, by]] = places.map(|it| it.unwrap_or([f32::NAN; 2]));
        [ax, ay, bx, by].map(f64::from)
    }
}

/// Puts what a block tells of the samples from `first` on in its place.
fn put<T: Clone>(all: &mut Vec<Option<T>>, first: usize, told: impl Iterator<Item = T>) {
    for (place, it) in (first..).zip(told) {
        all.resize(all.len().max(place + 1), None);
        all[place] = Some(it);
    }
}

/// What a header of no recorder says.
fn impossible(header: &Header) -> Vec<String> {
    let it = header;
    let positive = |value: f32| value.is_finite() && value > 0.0;
    let day = it.calibration.map_or(0, |it| it.date);
    let is_sensed = it.is_plain() || Sensing::try_new(&it.sensing()).is_ok();
    let rules: [(bool, &str, &dyn Display); 9] = [
        (positive(it.sample_rate), "sample_rate", &it.sample_rate),
        (positive(it.resolution), "resolution", &it.resolution),
        (it.zero_count.is_finite(), "zero_count", &it.zero_count),
        (it.decimation > 0, "decimation", &it.decimation),
        (it.full_scale > 0, "full_scale", &it.full_scale),
        ((1..16).contains(&it.fitted), "fitted", &it.fitted),
        (it.pulsed < 1 << TACHOMETERS, "pulsed", &it.pulsed),
        (it.first <= it.trigger, "first", &it.first),
        (is_sensed, "calibration or mounting, of the day", &day),
    ];
    let broken = rules.iter().filter(|(holds, ..)| !holds);
    let rule = "which no recorder writes";
    let flaws = broken.map(|(_, name, value)| format!("the header's {name} is {value}, {rule}"));
    flaws.collect()
}
