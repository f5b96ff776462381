//! Pulses of a buffer's samples: as these, a history, then an episode's.

use touchdown_core::sample::Sample;
use touchdown_protocol::log::block::Block;
use touchdown_protocol::log::pulses::{self, PULSE_BYTES, PULSES_PER_BLOCK, Pulse, Shown};

/// Pulses that wait for the store, of a buffer.
pub(super) const ROOM: usize = 128;
/// Pulse blocks of an episode.
pub(super) const BLOCKS: u8 = 15;
/// Samples of a block that is not full, so that a failing supply costs no more.
const SPAN: usize = 1_000;

/// Room of a buffer: all zero at first, for a static. A pulse's sample is counted since the buffer began, modulo 2^16.
pub(super) type Ring = [[u8; PULSE_BYTES]; ROOM];

/// A buffer's state, apart from its room.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Pulses {
    /// Place of the oldest pulse in the room.
    first: usize,
    held: usize,
    /// Pulses since the last mark.
    fresh: usize,
    /// Samples that went before the first one that is held, modulo 2^16.
    gone: u16,
    /// First sample that no block has told of, and what was shown before it.
    from: usize,
    before: Shown,
    /// What was shown at the last mark, and at the last sample.
    marked: Shown,
    shown: Shown,
    /// Sample from which on there was no room.
    end: Option<usize>,
    blocks: u8,
}

impl Pulses {
    /// Takes what the channels show at sample `number`. Where a history has no room, it begins anew; an episode's
    /// pulses end.
    #[inline(never)]
    pub(super) fn take(
        &mut self,
        ring: &mut Ring,
        number: usize,
        sample: &Sample,
        is_history: bool,
    ) {
        if self.end.is_some() {
            return;
        }
        let now = sample.edges.map(|edges| edges.map(|it| it.count));
        if now == self.shown {
            return;
        }
        if self.held + now.len() > ROOM {
            if !is_history {
                self.end = Some(number);
                return;
            }
            (self.held, self.fresh) = (0, 0);
            (self.from, self.before) = (number, self.shown);
        }
        for (channel, edges) in (0..).zip(sample.edges) {
            let at = usize::from(channel);
            if now.get(at) != self.shown.get(at)
                && let Some(slot) = ring.get_mut((self.first + self.held) % ROOM)
            {
                let sample = self.gone.wrapping_add(number as u16);
                *slot = Pulse {
                    sample,
                    channel,
                    edges,
                }
                .encode();
                self.held += 1;
                self.fresh += 1;
            }
        }
        self.shown = now;
    }

    /// A mark behind the last sample; what was before the last mark, so many samples, goes.
    pub(super) fn mark(&mut self, old: usize) {
        if old > 0 {
            let before = self.held - self.fresh;
            self.drop(before);
            self.gone = self.gone.wrapping_add(old as u16);
            if self.from <= old {
                self.before = self.marked;
            }
            self.from = self.from.saturating_sub(old);
        }
        self.fresh = 0;
        self.marked = self.shown;
    }

    /// A block, as soon as it is full or tells of as many samples as one may; of the last samples what is left.
    pub(super) fn fetch(&mut self, ring: &Ring, samples: usize, is_last: bool) -> Option<Block> {
        let end = self.end.unwrap_or(samples);
        let is_due = self.held >= PULSES_PER_BLOCK || end >= self.from + SPAN || is_last;
        if !is_due || end <= self.from || self.blocks == BLOCKS {
            return None;
        }
        self.blocks += 1;
        // The pulses of a sample stay together.
        let to = match self.held.checked_sub(PULSES_PER_BLOCK + 1) {
            Some(_) => self
                .pulse(ring, PULSES_PER_BLOCK)
                .map_or(end, |it| usize::from(it.sample)),
            None => end,
        };
        let held = (0..self.held).filter_map(|at| self.pulse(ring, at));
        let told = held.take_while(|it| usize::from(it.sample) < to);
        let (mut count, mut shown) = (0, self.before);
        let pulses = told.inspect(|it| {
            count += 1;
            if let Some(place) = shown.get_mut(usize::from(it.channel)) {
                *place = it.edges.map(|edges| edges.count);
            }
        });
        let block = pulses::Pulses::block(self.from as u16..to as u16, &self.before, pulses);
        self.drop(count);
        (self.from, self.before) = (to, shown);
        Some(block)
    }

    /// The pulse that is `at` places behind the oldest.
    fn pulse(&self, ring: &Ring, at: usize) -> Option<Pulse> {
        let slot = ring.get((self.first + at) % ROOM);
        let pulse = Pulse::decode(slot.filter(|_| at < self.held)?);
        Some(Pulse {
            sample: pulse.sample.wrapping_sub(self.gone),
            ..pulse
        })
    }

    fn drop(&mut self, count: usize) {
        self.first = (self.first + count) % ROOM;
        self.held -= count;
    }
}
