//! One buffer's state: a history, then an episode, then nothing again.

use heapless::Vec;
use touchdown_core::event::{EventKind, Notice};
use touchdown_core::learnt::Learnt;
use touchdown_core::sample::Sample;
use touchdown_core::severity::Severity;
use touchdown_protocol::controller::Cause;
use touchdown_protocol::link::Recent;
use touchdown_protocol::log::block::{Block, Kind};
use touchdown_protocol::log::ending::{Closing, Ending};
use touchdown_protocol::log::header::Header;
use touchdown_protocol::log::waveform::{self, Counts, SAMPLES_PER_BLOCK, Waveform};
use touchdown_protocol::log::{learnt, reader, severity};
use touchdown_protocol::wire::{self, NOTICE_BYTES, Record};

use super::pulses::{Pulses, Ring};
use super::{CAPACITY, Plan};

/// Notices of an episode; those beyond are counted.
const NOTICES: usize = 64;
/// Notices of a block.
const NOTICES_PER_BLOCK: usize = touchdown_protocol::log::block::PAYLOAD_BYTES / NOTICE_BYTES;
const COPIES: u8 = reader::COPIES as u8;

/// How an episode ended.
#[derive(Clone, Copy, Debug)]
pub(super) struct Closed {
    pub(super) why: Closing,
    pub(super) tick: u64,
    pub(super) latched: Option<Cause>,
}

/// What began an episode.
#[derive(Clone, Copy, Debug)]
pub(super) struct Trigger {
    kind: EventKind,
    pub(super) tick: u64,
    /// Samples to be recorded, those before it included.
    planned: usize,
    /// A contact in it is a landing.
    lands: bool,
}

/// How far the store has come.
#[derive(Clone, Copy, Debug, Default)]
struct Fetched {
    blocks: u16,
    headers: u8,
    learnt: u8,
    samples: usize,
    notices: usize,
    severity: bool,
    endings: u8,
}

/// A buffer's state.
#[derive(Clone, Debug, Default)]
pub(super) struct Capture {
    /// Place of the first sample in the ring.
    first: usize,
    held: usize,
    /// Samples since the last mark; the first sample is at the mark before, or at none.
    fresh: usize,
    /// Which of the two snapshots is that of the first sample.
    oldest: usize,
    /// Tick of the last sample.
    pub(super) newest: u64,
    pulses: Pulses,
    pub(super) trigger: Option<Trigger>,
    pub(super) closing: Option<Closed>,
    notices: Vec<[u8; NOTICE_BYTES], NOTICES>,
    notices_lost: u32,
    /// Whether the retainer was touched.
    pub(super) touched: bool,
    fastest: f32,
    /// How severe the drop is so far.
    pub(super) severity: Option<Severity>,
    fetched: Fetched,
}

impl Capture {
    /// Holds no episode any more. A frame of its own: a new state takes two kilobytes.
    #[inline(never)]
    pub(super) fn clear(&mut self) {
        *self = Self::default();
    }

    /// Whether it holds no episode.
    pub(super) fn is_idle(&self) -> bool {
        self.trigger.is_none()
    }

    /// Whether it has all samples of its episode.
    pub(super) fn is_full(&self) -> bool {
        self.trigger.is_some_and(|it| self.held >= it.planned)
    }

    /// Whether the store has all of its episode.
    pub(super) fn is_fetched(&self) -> bool {
        self.fetched.endings == COPIES
    }

    /// The last samples, every `step`-th, oldest first.
    pub(super) fn recent<'b>(
        &self,
        buffer: &'b [Counts; CAPACITY],
        step: u16,
    ) -> impl Iterator<Item = Counts> + use<'b> {
        let (first, held, step) = (self.first, self.held, usize::from(step));
        let back = (0..Recent::SAMPLES).rev().map(move |it| 1 + it * step);
        let numbers = back.filter_map(move |back| held.checked_sub(back));
        numbers.filter_map(move |number| buffer.get(wrapped(first + number)).copied())
    }

    pub(super) fn record(
        &mut self,
        buffer: &mut [Counts; CAPACITY],
        ring: &mut Ring,
        sample: &Sample,
        plan: &Plan,
        tick: u64,
    ) {
        if plan.header.pulsed != 0 {
            let is_history = self.trigger.is_none();
            self.pulses.take(ring, self.held, sample, is_history);
        }
        let counts = waveform::counts(sample);
        if let Some(place) = buffer.get_mut(wrapped(self.first + self.held)) {
            *place = counts;
        }
        self.newest = tick;
        self.held += 1;
        self.fresh += 1;
        if self.trigger.is_none() && self.fresh == plan.before {
            self.mark();
        }
    }

    /// A mark behind the last sample; what was before the last mark goes.
    fn mark(&mut self) {
        let old = self.held - self.fresh;
        self.pulses.mark(old);
        if old > 0 {
            self.first = wrapped(self.first + old);
            self.held = self.fresh;
            self.oldest = 1 - self.oldest;
        }
        self.fresh = 0;
    }

    /// Which snapshot is to be taken now, if one is.
    pub(super) fn due(&self) -> Option<usize> {
        let is_due = self.trigger.is_none() && self.fresh == 0;
        is_due.then_some(if self.held == 0 {
            self.oldest
        } else {
            1 - self.oldest
        })
    }

    /// Begins an episode, or goes on with one that has ended but is still being recorded. Whether a contact
    /// from now on `lands`.
    pub(super) fn begin(&mut self, kind: EventKind, tick: u64, lands: bool, plan: &Plan) {
        self.closing = None;
        let trigger = self.trigger.get_or_insert(Trigger {
            kind,
            tick,
            planned: (self.held + plan.after).min(CAPACITY),
            lands: false,
        });
        if lands && !trigger.lands {
            // What it touched before, it lay on.
            self.touched = false;
            trigger.lands = true;
        }
    }

    /// A record, while there is room.
    pub(super) fn push(&mut self, record: &Record) {
        if self.notices.push(wire::encode_record(record)).is_err() {
            self.notices_lost = self.notices_lost.saturating_add(1);
        }
    }

    pub(super) fn note(&mut self, notice: &Notice) {
        self.push(&Record::Notice(*notice));
        self.touched |= touches(notice);
        if let Notice::Declared(event) = notice {
            self.fastest = self.fastest.max(event.normal_speed);
        }
    }

    /// An alarm or an order, while half of the room is left for what the detector says.
    pub(super) fn note_aside(&mut self, notice: &Notice) {
        if self.notices.len() < NOTICES / 2 {
            self.push(&Record::Notice(*notice));
        }
    }

    /// The next block, if it is ready.
    pub(super) fn fetch(
        &mut self,
        buffer: &[Counts; CAPACITY],
        ring: &Ring,
        learnt: &[&mut Learnt; 2],
        plan: &Plan,
    ) -> Option<Block> {
        let trigger = self.trigger.filter(|_| self.held > 0)?;
        let complete = self.is_full() && self.fetched.samples == self.held;
        let block = self
            .header(&trigger, plan)
            .or_else(|| self.learnt(learnt))
            .or_else(|| self.waveform(buffer))
            .or_else(|| self.pulses(ring, plan))
            .or_else(|| self.events(complete && self.closing.is_some()))
            .or_else(|| {
                let closed = self.closing.filter(|_| complete)?;
                self.severity()
                    .or_else(|| Some(self.ending(&trigger, &closed, plan)))
            })?;
        self.fetched.blocks += 1;
        Some(block)
    }

    fn header(&mut self, trigger: &Trigger, plan: &Plan) -> Option<Block> {
        if self.fetched.headers == COPIES {
            return None;
        }
        self.fetched.headers += 1;
        let recorded = (self.held as u64).saturating_sub(1) * u64::from(plan.header.decimation);
        let header = Header {
            trigger_kind: trigger.kind,
            trigger: trigger.tick,
            first: self.newest - recorded.min(self.newest),
            planned: trigger.planned as u32,
            ..plan.header
        };
        Some(Block::of(Kind::Header, &header.encode()))
    }

    fn learnt(&mut self, snapshots: &[&mut Learnt; 2]) -> Option<Block> {
        let learnt = snapshots.get(self.oldest).filter(|it| it.is_known())?;
        let block = learnt::part(learnt, self.fetched.learnt)?;
        self.fetched.learnt += 1;
        Some(block)
    }

    /// A whole block, or what is left of the last one.
    fn waveform(&mut self, buffer: &[Counts; CAPACITY]) -> Option<Block> {
        let start = self.fetched.samples;
        let ready = self.held - start;
        if ready == 0 || (ready < SAMPLES_PER_BLOCK && !self.is_full()) {
            return None;
        }
        let samples = (start..self.held)
            .filter_map(|number| buffer.get(wrapped(self.first + number)).copied());
        let (block, taken) = Waveform::block(start as u32, samples);
        self.fetched.samples += taken;
        Some(block)
    }

    fn pulses(&mut self, ring: &Ring, plan: &Plan) -> Option<Block> {
        let is_last = self.is_full();
        (plan.header.pulsed != 0).then(|| self.pulses.fetch(ring, self.held, is_last))?
    }

    /// A whole block, or at the end what is left.
    fn events(&mut self, last: bool) -> Option<Block> {
        let ready = self.notices.get(self.fetched.notices..)?;
        if ready.is_empty() || (ready.len() < NOTICES_PER_BLOCK && !last) {
            return None;
        }
        let mut block = Block::new(Kind::Events);
        for notice in ready.iter().take(NOTICES_PER_BLOCK) {
            block.push(notice);
            self.fetched.notices += 1;
        }
        Some(block)
    }

    fn severity(&mut self) -> Option<Block> {
        let payload = severity::encode(self.severity.as_ref()?);
        if self.fetched.severity {
            return None;
        }
        self.fetched.severity = true;
        Some(Block::of(Kind::Severity, &payload))
    }

    fn ending(&mut self, trigger: &Trigger, closed: &Closed, plan: &Plan) -> Block {
        let left = u16::from(COPIES - self.fetched.endings);
        self.fetched.endings += 1;
        let ending = Ending {
            closing: closed.why,
            landing: self.touched && trigger.lands,
            blocks: self.fetched.blocks + left,
            samples: self.held as u32,
            notices: self.notices.len() as u32,
            notices_lost: self.notices_lost,
            index: self.fastest / plan.fall_speed,
            last: closed.tick,
            latched: closed.latched,
        };
        Block::of(Kind::Ending, &ending.encode())
    }
}

/// Whether it tells of the retainer.
pub(super) fn touches(notice: &Notice) -> bool {
    use EventKind::{FreeFall, Levitated, SensorFault};
    matches!(notice, Notice::Declared(event)
        if !matches!(event.kind, FreeFall | Levitated | SensorFault))
}

/// A place in the ring; `place` is below twice its size.
fn wrapped(place: usize) -> usize {
    if place < CAPACITY {
        place
    } else {
        place - CAPACITY
    }
}
