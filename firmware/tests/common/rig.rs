//! A recorder that is fed with noise and drops, and remembers what it was fed with.

use touchdown_core::detect::Phase;
use touchdown_core::event::{Event, EventKind, Moment, Motion, Notice, Plane};
use touchdown_core::monitor::MonitorConfig;
use touchdown_core::sample::{CHANNELS, Sample, TACHOMETERS};
use touchdown_firmware::board::default_config;
use touchdown_firmware::recorder::{Memory, Recorder};
use touchdown_protocol::controller::Shown;
use touchdown_protocol::link::{Chunk, Log};
use touchdown_protocol::log::header::Header;
use touchdown_protocol::log::reader::{Item, Reader, Report, Verdict};
use touchdown_protocol::log::waveform::Counts;
use touchdown_protocol::wire::decode_record;

use super::chip::random;

/// Of the configuration block its end, the checksum.
pub const BLOCK: [u8; 4] = 0xc0ff_ee00_u32.to_le_bytes();
/// Times switched on.
pub const BOOT: u32 = 7;

/// The rig's configuration at `rate`.
pub fn config(rate: f32) -> MonitorConfig {
    let mut config = default_config();
    config.detector.sample_rate = rate;
    config
}

/// Feeds a recorder.
pub struct Rig {
    pub recorder: Recorder<'static>,
    /// Counts of every tick since reset.
    pub fed: Vec<Counts>,
    /// What begins a drop.
    pub trigger: EventKind,
    seed: u64,
    number: u16,
}

impl Rig {
    /// Of a rotor that has floated.
    pub fn new(rate: f32, seed: u64) -> Self {
        let mut rig = Self::switched_on(rate, seed);
        rig.recorder.set_phase(Phase::Levitated, Shown::default());
        rig
    }

    /// Of one that has not been seen to float.
    pub fn switched_on(rate: f32, seed: u64) -> Self {
        let memory = Box::leak(Box::new(Memory::EMPTY));
        Self {
            recorder: Recorder::new(memory, &config(rate), &BLOCK, BOOT),
            fed: Vec::new(),
            trigger: EventKind::FreeFall,
            seed: seed | 1,
            number: 0,
        }
    }

    /// One tick, with an event of each of `kinds`.
    pub fn tick(&mut self, kinds: &[EventKind]) {
        let counts: Counts = core::array::from_fn(|_| random(&mut self.seed) as u16 & 0x0fff);
        let sample = Sample {
            counts,
            valid: 0x0f,
            spin: None,
            levitated: None,
            edges: [None; TACHOMETERS],
        };
        assert_eq!(counts.len(), CHANNELS);
        let notices: Vec<_> = kinds.iter().map(|&kind| self.declared(kind)).collect();
        self.fed.push(counts);
        self.recorder.take(&sample, &notices);
    }

    /// An event of `kind` in the tick to come.
    pub fn declared(&mut self, kind: EventKind) -> Notice {
        self.number += 1;
        let now = self.fed.len() as u64;
        Notice::Declared(Event {
            number: self.number,
            kind,
            onset: Moment::of_sample(now),
            declared: now,
            plane: Plane::A,
            normal_speed: if kind == EventKind::Impact { 0.2 } else { 0.0 },
            motion: Motion::Cylindrical,
            fault: None,
        })
    }

    /// What happens in tick `tick` of a drop that is levitated again after `length` ticks.
    pub fn drop_tick(&mut self, tick: usize, length: usize) {
        match tick {
            0 => self.tick(&[self.trigger]),
            _ if tick == length => {
                self.tick(&[EventKind::LiftOff, EventKind::Levitated]);
                self.recorder.set_phase(Phase::Levitated, Shown::default());
            }
            _ if tick < length && tick % 37 == 36 => self.tick(&[EventKind::Impact]),
            _ => self.tick(&[]),
        }
    }
}

/// All bytes of an episode, fetched as over the link.
pub fn episode(log: &mut impl Log, number: u32) -> Vec<u8> {
    let mut bytes = Vec::new();
    loop {
        let mut chunk = Chunk::new();
        let total = log.fetch(number, bytes.len() as u32, &mut chunk);
        bytes.extend_from_slice(&chunk);
        if bytes.len() >= total.expect("an episode") as usize {
            return bytes;
        }
    }
}

/// An episode as it was read.
pub struct Read {
    pub report: Report,
    pub header: Option<Header>,
    pub samples: Vec<Option<Counts>>,
    pub notices: usize,
}

pub fn read(bytes: &[u8]) -> Read {
    let mut reader = Reader::new(bytes);
    let mut read = Read {
        report: Report::default(),
        header: None,
        samples: Vec::new(),
        notices: 0,
    };
    for item in &mut reader {
        match item {
            Item::Header(header) => read.header = Some(header),
            Item::Waveform(waveform) => {
                let end = waveform.start as usize + waveform.samples().len();
                read.samples.resize(read.samples.len().max(end), None);
                for (number, counts) in waveform.samples().enumerate() {
                    read.samples[waveform.start as usize + number] = Some(counts);
                }
            }
            Item::Events(events) => {
                assert!(events.iter().all(|it| decode_record(it).is_some()));
                read.notices += events.len();
            }
            Item::Learnt(_) | Item::Pulses(_) | Item::Severity(..) | Item::Ending(_) => {}
        }
    }
    read.report = reader.finish(|_| ());
    read
}

impl Read {
    /// Whether each sample that is there is the one that was fed.
    pub fn agrees(&self, fed: &[Counts]) -> bool {
        let Some(header) = &self.header else {
            return self.samples.is_empty();
        };
        self.samples.iter().enumerate().all(|(number, counts)| {
            let tick = header.first as usize + number * usize::from(header.decimation);
            counts.is_none_or(|counts| fed.get(tick) == Some(&counts))
        })
    }

    /// Whether all of it is there and right.
    pub fn is_whole(&self, fed: &[Counts]) -> bool {
        let planned = self.header.map_or(0, |it| it.planned as usize);
        self.report.verdict() == Verdict::Whole
            && self.samples.len() == planned
            && self.samples.iter().all(Option::is_some)
            && self.agrees(fed)
    }
}
