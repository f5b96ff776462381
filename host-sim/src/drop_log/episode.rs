//! One episode, as far as it is there.

use serde::Serialize;
use touchdown_core::event::{EventKind, Notice};
use touchdown_core::log::ending::Ending;
use touchdown_core::log::header::Header;
use touchdown_core::log::reader::{Item, MOST_BLOCKS, Reader, Report, Verdict};
use touchdown_core::log::waveform::{Counts, NO_VALUE, SAMPLES_PER_BLOCK};

/// An episode.
#[derive(Clone, Debug, Serialize)]
pub struct Episode {
    /// Its number; 0 where no block tells.
    pub sequence: u32,
    /// Slot of the flash; none for a file of one episode.
    pub slot: Option<usize>,
    /// Not to be overwritten.
    pub locked: bool,
    /// Whether it is all there.
    pub verdict: Verdict,
    /// What it is a record of.
    pub header: Option<Header>,
    /// What it added up to.
    pub ending: Option<Ending>,
    /// What was reported, in its order; those of an unknown kind left out.
    pub events: Vec<Event>,
    /// Pages by their state.
    pub report: Report,
    /// Version and bytes of the severity.
    pub severity: Option<(u8, Vec<u8>)>,
    /// Counts of each sample; none where its block is missing.
    #[serde(skip)]
    pub samples: Vec<Option<Counts>>,
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
}

impl Episode {
    /// From the pages of a slot, or of a file.
    pub fn of(pages: &[u8]) -> Self {
        let mut reader = Reader::new(pages);
        let (mut header, mut ending, mut severity) = (None, None, None);
        let (mut notices, mut samples) = (Vec::new(), Vec::new());
        for item in reader.by_ref() {
            match item {
                Item::Header(it) => header = Some(it),
                Item::Ending(it) => ending = Some(it),
                Item::Severity(version, bytes) => severity = Some((version, bytes.to_vec())),
                Item::Events(it) => notices.extend(it.notices().flatten()),
                Item::Waveform(it) => {
                    let start = it.start as usize;
                    if start < MOST_BLOCKS * SAMPLES_PER_BLOCK {
                        let end = start + it.samples().len();
                        samples.resize(samples.len().max(end), None);
                        let places = samples.iter_mut().skip(start);
                        places
                            .zip(it.samples())
                            .for_each(|(to, from)| *to = Some(from));
                    }
                }
            }
        }
        let report = reader.finish();
        Self {
            sequence: report.sequence.unwrap_or(0),
            slot: None,
            locked: false,
            verdict: report.verdict(),
            events: header
                .as_ref()
                .map_or(Vec::new(), |it| events(it, &notices)),
            header,
            ending,
            report,
            severity,
            samples,
        }
    }

    /// Of a sample, since the trigger, s.
    pub fn time(&self, header: &Header, sample: usize) -> f64 {
        let before = header.trigger as f64 - header.first as f64;
        (sample as f64 * f64::from(header.decimation) - before) / f64::from(header.sample_rate)
    }

    /// Displacement of a channel, m.
    pub fn position(
        &self,
        header: &Header,
        counts: &Option<Counts>,
        channel: usize,
    ) -> Option<f64> {
        let count = counts.as_ref()?.get(channel).copied()?;
        let there = count != NO_VALUE && header.fitted & (1 << channel) != 0;
        let from_zero = f64::from(count) - f64::from(header.zero_count);
        there.then_some(from_zero * f64::from(header.resolution))
    }
}

fn events(header: &Header, notices: &[Notice]) -> Vec<Event> {
    let rate = f64::from(header.sample_rate);
    let since = |tick: f64| (tick - header.trigger as f64) / rate;
    let event = |notice: &Notice| match notice {
        Notice::Declared(event) => Some(Event {
            event: event.kind,
            onset_s: since(event.onset.samples()),
            declared_s: since(event.declared as f64),
            normal_speed_m_s: event.normal_speed,
        }),
        _ => None,
    };
    notices.iter().filter_map(event).collect()
}
