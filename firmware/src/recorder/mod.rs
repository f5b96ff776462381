//! Records drops in RAM, for the store to write down.
//!
//! Two buffers: samples go into one, as a history of the last 50 to 100 ms until a drop is declared, then
//! until the buffer is full or 200 ms after it. The history begins where the monitor's state was kept, so that
//! the episode can be replayed. From then on they go into the other. A block can be fetched as soon as its
//! samples are there, so what a failing supply leaves is all but the last few milliseconds.

mod capture;
mod pulses;

use core::mem::MaybeUninit;

use touchdown_core::detect::Phase;
use touchdown_core::event::{EventKind, Notice};
use touchdown_core::learnt::Learnt;
use touchdown_core::monitor::{MonitorConfig, MonitorState};
use touchdown_core::sample::{Sample, TACHOMETERS};
use touchdown_core::severity::Severity;
use touchdown_protocol::controller::Shown;
use touchdown_protocol::link::Recent;
use touchdown_protocol::log::block::Block;
use touchdown_protocol::log::ending::Closing;
use touchdown_protocol::log::header::Header;
use touchdown_protocol::log::pulses::PULSE_BYTES;
use touchdown_protocol::log::waveform::Counts;
use touchdown_protocol::wire::{Record, Switching};
use touchdown_rotor::real;

use self::capture::{Capture, Closed};
use self::pulses::Ring;

/// Samples of a buffer.
pub const CAPACITY: usize = 4_450;
/// Recorded samples per second at most, Hz: so a buffer lasts for what is recorded.
const FASTEST: f32 = 20_000.0;

const BUFFERS: usize = 2;
/// Recorded before the trigger, s, at least; at most twice that.
const BEFORE: f32 = 0.05;
/// Recorded after the trigger, s, at most.
const AFTER: f32 = 0.2;
/// Without a notice for so long, s, a drop is over.
const QUIET: f32 = 1.0;
/// No episode is longer, s, so that one is complete however long the rotor whirls.
const LONGEST: f32 = 10.0;
/// Standard gravity, m/s^2.
const GRAVITY: f32 = 9.806_65;

/// The buffers: 79 kB, all zero at first, for a static.
pub struct Memory([Room; BUFFERS]);

/// Room of a buffer.
struct Room {
    counts: [Counts; CAPACITY],
    pulses: Ring,
    // Without values of their own: these would take as much flash.
    learnt: [MaybeUninit<Learnt>; 2],
}

impl Memory {
    /// Empty buffers.
    pub const EMPTY: Self = {
        const ROOM: Room = Room {
            counts: [[0; 4]; CAPACITY],
            pulses: [[0; PULSE_BYTES]; pulses::ROOM],
            learnt: [const { MaybeUninit::uninit() }; 2],
        };
        Self([ROOM; BUFFERS])
    };
}

/// A buffer, and what is in it.
struct Buffer<'m> {
    counts: &'m mut [Counts; CAPACITY],
    pulses: &'m mut Ring,
    /// What had been learnt at the last two marks.
    learnt: [&'m mut Learnt; 2],
    capture: Capture,
}

impl<'m> Buffer<'m> {
    fn new(room: &'m mut Room) -> Self {
        Self {
            counts: &mut room.counts,
            pulses: &mut room.pulses,
            learnt: room.learnt.each_mut().map(nothing_learnt),
            capture: Capture::default(),
        }
    }
}

/// What follows from the configuration.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Plan {
    /// Of every episode, but for its trigger and its samples. Pulses are recorded where every tick's sample is.
    header: Header,
    /// Samples.
    before: usize,
    after: usize,
    /// Ticks.
    quiet: u64,
    longest: u64,
    /// Speed of a fall through the clearance under standard gravity, however the rotor lies, m/s.
    fall_speed: f32,
}

impl Plan {
    fn new(config: &MonitorConfig, block: &[u8], boot: u32) -> Self {
        let (rate, sensing) = (config.detector.sample_rate, &config.sensing);
        // Rounded up: a higher rate is thinned out until it fits.
        let whole = (rate / FASTEST) as u16;
        let decimation = whole.saturating_add(u16::from(f32::from(whole) * FASTEST < rate));
        let samples = |time: f32| (time * rate / f32::from(decimation)) as usize;
        let mut firmware = [0; 16];
        let name = concat!("touchdown ", env!("CARGO_PKG_VERSION"));
        let letters = firmware.iter_mut().zip(name.bytes());
        letters.for_each(|(to, from)| *to = from);
        Self {
            header: Header {
                firmware,
                config_hash: block.last_chunk().map_or(0, |end| u32::from_le_bytes(*end)),
                boot,
                sample_rate: rate,
                decimation,
                fitted: config.fitted,
                trigger_kind: EventKind::FreeFall,
                trigger: 0,
                first: 0,
                planned: 0,
                resolution: sensing.resolution,
                zero_count: sensing.zero_count,
                full_scale: sensing.full_scale,
                pulsed: if decimation == 1 { pulsed(config) } else { 0 },
                mounting_angle: sensing.mounting_angle,
                calibration: sensing.calibration,
            },
            before: samples(BEFORE).clamp(1, CAPACITY / 4),
            after: samples(AFTER).max(1),
            quiet: (QUIET * rate) as u64,
            longest: (LONGEST * rate) as u64,
            fall_speed: real::sqrt(2.0 * GRAVITY * config.detector.machine.clearance),
        }
    }
}

/// Pulse channels that are fitted, bit i.
fn pulsed(config: &MonitorConfig) -> u8 {
    let marks = config
        .tachometers
        .map_or([None; TACHOMETERS], |it| it.marks);
    let bits = (0..)
        .zip(marks)
        .map(|(channel, marks)| u8::from(marks.is_some()) << channel);
    bits.sum()
}

/// In a frame of its own: what is learnt takes over a kilobyte.
#[inline(never)]
fn nothing_learnt(place: &mut MaybeUninit<Learnt>) -> &mut Learnt {
    place.write(Learnt::default())
}

/// The drop that goes on.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Drop {
    None,
    /// Its notices go to this buffer's capture.
    Recorded(usize),
    /// Both buffers were in use when it began.
    Lost,
}

/// Records drops.
pub struct Recorder<'m> {
    buffers: [Buffer<'m>; BUFFERS],
    plan: Plan,
    tick: u64,
    /// Ticks until a sample is recorded.
    skip: u16,
    /// Buffer that samples go into.
    recording: Option<usize>,
    /// Buffer that is fetched from.
    fetching: usize,
    drop: Drop,
    last_notice: u64,
    /// It has floated since reset, and since it last touched the retainer: only then it lands.
    floated: bool,
    /// The last change of what the controller shows.
    switched: Switching,
    /// What was counted since reset.
    pub counted: Counted,
}

/// What was counted since reset.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Counted {
    /// Drops of which nothing was recorded, as both buffers were in use.
    pub lost: u32,
    /// Times that the rotor came to the wall.
    pub touches: u32,
}

impl<'m> Recorder<'m> {
    /// For samples that the monitor takes with `config`, which it has accepted. The header of an episode tells the checksum
    /// of the configuration `block` and the number of this power-on.
    pub fn new(memory: &'m mut Memory, config: &MonitorConfig, block: &[u8], boot: u32) -> Self {
        Self {
            buffers: memory.0.each_mut().map(Buffer::new),
            plan: Plan::new(config, block, boot),
            tick: 0,
            skip: 0,
            recording: Some(0),
            fetching: 0,
            drop: Drop::None,
            last_notice: 0,
            floated: false,
            switched: Switching::default(),
            counted: Counted::default(),
        }
    }

    /// One sample and what the monitor said to it. Bounded; writes RAM only.
    pub fn take(&mut self, sample: &Sample, notices: &[Notice]) {
        if self.skip == 0 {
            self.skip = self.plan.header.decimation;
            self.record(sample);
        }
        self.skip -= 1;
        for notice in notices {
            self.hear(notice);
        }
        self.watch();
        self.tick += 1;
    }

    /// The monitor's state after the tick, after the tick's [`Self::take`]: now and then what it has learnt is kept.
    pub fn keep(&mut self, state: &MonitorState) {
        // Of a tick's state, every tick's samples are needed.
        if self.plan.header.decimation == 1
            && let Some(buffer) = self.recording.and_then(|at| self.buffers.get_mut(at))
            && let Some(due) = buffer.capture.due()
            && let Some(place) = buffer.learnt.get_mut(due)
        {
            place.update(state);
        }
    }

    /// The next block to be stored, if one is ready. Bounded: copies at most a block. A block is
    /// given once, those of an episode in order and none of another in between.
    pub fn fetch(&mut self) -> Option<Block> {
        let next = (self.fetching + 1) % BUFFERS;
        if self.is_idle(self.fetching) && !self.is_idle(next) {
            self.fetching = next;
        }
        let buffer = self.buffers.get_mut(self.fetching)?;
        let capture = &mut buffer.capture;
        let block = capture.fetch(buffer.counts, buffer.pulses, &buffer.learnt, &self.plan);
        if capture.is_fetched() {
            capture.clear();
            buffer.learnt.iter_mut().for_each(|it| it.forget());
            // Where samples had nowhere to go, they have now.
            self.recording.get_or_insert(self.fetching);
        }
        block
    }

    /// How severe the present drop is, before the tick's [`Self::take`], which may end it. The last call counts.
    pub fn set_severity(&mut self, severity: &Severity) {
        if let Some(capture) = self.open() {
            capture.severity = Some(*severity);
        }
    }

    /// The rotor's phase and what the controller shows, before the tick's [`Self::take`].
    pub fn set_phase(&mut self, phase: Phase, shown: Shown) {
        self.floated |= phase == Phase::Levitated;
        if shown != self.switched.shown {
            let sample = self.tick;
            self.switched = Switching { sample, shown };
            self.note_switched();
        }
    }

    #[inline(never)]
    fn note_switched(&mut self) {
        let record = Record::Switching(self.switched);
        if let Some(capture) = self.open() {
            capture.push(&record);
        }
    }

    /// The newest samples, every `step`-th of those recorded; none while both buffers are in use.
    pub fn recent(&self, step: u16) -> Recent {
        let Some(buffer) = self.recording.and_then(|at| self.buffers.get(at)) else {
            return Recent::default();
        };
        let ticks = u32::from(step) * u32::from(self.plan.header.decimation);
        let capture = &buffer.capture;
        Recent::new(capture.newest, ticks, capture.recent(buffer.counts, step))
    }

    /// The capture of the drop that goes on.
    fn open(&mut self) -> Option<&mut Capture> {
        match self.drop {
            Drop::Recorded(at) => self.buffers.get_mut(at).map(|it| &mut it.capture),
            Drop::None | Drop::Lost => None,
        }
    }

    fn is_idle(&self, at: usize) -> bool {
        let buffer = self.buffers.get(at);
        buffer.is_none_or(|it| it.capture.is_idle())
    }

    fn record(&mut self, sample: &Sample) {
        if let Some(at) = self.recording
            && let Some(buffer) = self.buffers.get_mut(at)
        {
            let capture = &mut buffer.capture;
            capture.record(buffer.counts, buffer.pulses, sample, &self.plan, self.tick);
            if capture.is_full() {
                let other = (at + 1) % BUFFERS;
                self.recording = self.is_idle(other).then_some(other);
            }
        }
    }

    /// Takes a notice of the tick, what the forecast says between two ticks, or what was ordered.
    pub fn hear(&mut self, notice: &Notice) {
        match notice {
            // The waveform shows them: the episode has no room for those of every bounce.
            Notice::Touch(touch) => {
                let touches = &mut self.counted.touches;
                *touches = touches.saturating_add(u32::from(touch.end.is_none()));
                return;
            }
            Notice::Alarm(_) | Notice::Ordered(_) => {
                if let Some(capture) = self.open() {
                    capture.note_aside(notice);
                }
                return;
            }
            _ => {}
        }
        if self.drop == Drop::None
            && let Some(kind) = trigger(notice)
        {
            self.begin(kind);
        }
        self.last_notice = self.tick;
        self.floated &= !capture::touches(notice);
        let mut touched = false;
        if let Some(capture) = self.open() {
            capture.note(notice);
            touched = capture.touched;
        }
        match notice {
            Notice::Declared(it) if it.kind == EventKind::Levitated => self.end(Closing::Levitated),
            Notice::Withdrawn { .. } if !touched => self.end(Closing::Withdrawn),
            _ => {}
        }
    }

    fn begin(&mut self, kind: EventKind) {
        self.drop = Drop::Lost;
        if let Some(at) = self.recording
            && let Some(buffer) = self.buffers.get_mut(at)
        {
            let capture = &mut buffer.capture;
            capture.begin(kind, self.tick, self.floated, &self.plan);
            self.drop = Drop::Recorded(at);
            // As it was when it began.
            self.note_switched();
        } else if self.floated {
            let lost = &mut self.counted.lost;
            *lost = lost.saturating_add(1);
        }
    }

    fn end(&mut self, closing: Closing) {
        let closed = Closed {
            why: closing,
            tick: self.tick,
            latched: self.switched.shown.latched(),
        };
        if let Some(capture) = self.open() {
            capture.closing = Some(closed);
        }
        self.drop = Drop::None;
    }

    /// Ends a drop that says no more, or too much.
    fn watch(&mut self) {
        if self.drop == Drop::None {
            return;
        }
        let trigger = self.open().and_then(|it| it.trigger);
        if self.tick - self.last_notice >= self.plan.quiet {
            self.end(Closing::Quiet);
        } else if trigger.is_some_and(|it| self.tick - it.tick >= self.plan.longest) {
            self.end(Closing::Longest);
        }
    }
}

/// What begins an episode: a fall, or any contact.
fn trigger(notice: &Notice) -> Option<EventKind> {
    use EventKind::{Levitated, LiftOff, Rest, SensorFault};
    match notice {
        Notice::Declared(event) => Some(event.kind)
            .filter(|kind| !matches!(kind, LiftOff | Rest | Levitated | SensorFault)),
        _ => None,
    }
}
