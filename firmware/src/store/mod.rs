//! The drop log in serial NOR flash.
//!
//! [`Store::work`] does at most one program or erase a call, so that a low-priority task can call it
//! and nothing waits for it. In flash there are two sectors of counters and then slots of twelve
//! sectors, an episode each: `docs/formats/log.md` says what makes them safe against a cut of power.

mod layout;
mod ledger;
mod slots;

use embedded_storage::nor_flash::{MultiwriteNorFlash, NorFlash, ReadNorFlash};
use touchdown_core::event::EventKind;
use touchdown_protocol::controller::Cause;
use touchdown_protocol::link::Refusal;
use touchdown_protocol::log::block::{BLOCK_BYTES, Block, Kind};
use touchdown_protocol::log::counters::Counters;
use touchdown_protocol::log::ending::Ending;

use self::layout::{BLOCKS_PER_SLOT, Layout, SECTORS_PER_SLOT};
pub use self::layout::{EPISODE_BYTES, bytes_of};
use self::ledger::Ledger;
pub use self::slots::Slot;
use self::slots::Slots;

/// Slots that must stay unlocked: one to write to, one to erase meanwhile, one to keep.
const LEAST_UNLOCKED: usize = 3;

/// The lifetime counters of the log in `flash`, as [`Store::mount`] finds them, before it counts anything itself.
pub fn counters<F: ReadNorFlash>(flash: &mut F, base: u32) -> Result<Counters, F::Error> {
    Ok(*Ledger::mount(flash, Layout { base })?.counters())
}

/// What is in slot `slot` of the log in `flash`, as [`Store::mount`] finds it.
pub fn slot<F: ReadNorFlash>(flash: &mut F, base: u32, slot: usize) -> Result<Slot, F::Error> {
    slots::found(flash, Layout { base }, slot)
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum State {
    /// A slot is to be found and erased.
    Unprepared,
    /// Sectors of `slot` before `sector` are erased.
    Erasing { slot: usize, sector: u32 },
    /// `slot` is erased.
    Ready { slot: usize },
    /// Blocks before `block` are written.
    Writing { slot: usize, block: u32 },
}

/// The drop log, of `SLOTS` episodes.
#[derive(Clone, Debug)]
pub struct Store<const SLOTS: usize> {
    layout: Layout,
    ledger: Ledger,
    slots: Slots<SLOTS>,
    state: State,
    /// Lost drops and touches since reset that are counted in.
    lost: u32,
    touches: u32,
    /// Why the outputs are off, where that is latched.
    latched: Option<Cause>,
}

impl<const SLOTS: usize> Store<SLOTS> {
    /// Finds what is in `flash` from `base` on, a multiple of 4096. Only reads; takes as long as
    /// reading 8 KiB and 800 bytes a slot, and two episodes more after a cut of power. A flash that is smaller than the
    /// slots refuses to be read.
    pub fn mount<F: NorFlash>(flash: &mut F, base: u32) -> Result<Self, F::Error> {
        const {
            assert!(SLOTS >= LEAST_UNLOCKED);
        }
        let layout = Layout { base };
        let mut ledger = Ledger::mount(flash, layout)?;
        let slots = Slots::mount(flash, layout)?;
        let counted = ledger.counters().episodes;
        for (slot, sequence) in slots.after(counted) {
            let ending = slots::ending(flash, layout, slot, sequence)?;
            // Power went before it was counted, maybe before the trip was noted.
            let trigger = slots::trigger(flash, layout, slot, sequence)?;
            let latched = (trigger == Some(EventKind::FreeFall)).then_some(Cause::Fall);
            ledger.update(|counters| counters.count(sequence, ending.as_ref(), latched));
        }
        ledger.update(|counters| counters.boots = counters.boots.saturating_add(1));
        Ok(Self {
            layout,
            ledger,
            slots,
            state: State::Unprepared,
            lost: 0,
            touches: 0,
            latched: None,
        })
    }

    /// Does the next thing: one operation on `flash` at most. `fetch` is called at most once, and
    /// only if its block can be written at once. Whether there may be more to do.
    ///
    /// On an error the block that was fetched is lost, which the episode shows; all else is tried
    /// again by the next call.
    pub fn work<F: MultiwriteNorFlash>(
        &mut self,
        flash: &mut F,
        fetch: impl FnOnce() -> Option<Block>,
    ) -> Result<bool, F::Error> {
        match self.state {
            // Also amid an episode: a trip is noted before its record is whole.
            _ if self.ledger.is_ahead() => self.ledger.write(flash).map(|()| true),
            State::Writing { slot, block } => match fetch() {
                Some(next) => self.write(flash, slot, block, &next).map(|()| true),
                None => Ok(false),
            },
            State::Unprepared => self.prepare(flash),
            State::Erasing { slot, sector } => self.erase(flash, slot, sector).map(|()| true),
            State::Ready { slot } => match fetch() {
                Some(next) => self.begin(flash, slot, &next).map(|()| true),
                None => Ok(false),
            },
        }
    }

    /// The lifetime counters; the flash has them after the next few calls of [`Self::work`].
    pub fn counters(&self) -> &Counters {
        self.ledger.counters()
    }

    /// Counts the drops of which nothing was recorded, given their number since reset.
    pub fn count_lost(&mut self, since_reset: u32) {
        let more = since_reset.saturating_sub(self.lost);
        if more > 0 {
            self.lost = since_reset;
            self.ledger
                .update(|counters| counters.lost = counters.lost.saturating_add(more));
        }
    }

    /// Counts touches, given their number since reset. A rub touches once a turn: they are written when they are an
    /// eighth more than the flash has.
    pub fn count_touches(&mut self, since_reset: u32) {
        let more = since_reset.saturating_sub(self.touches);
        if more > self.ledger.counters().touches / 8 {
            self.touches = since_reset;
            self.ledger
                .update(|counters| counters.touches = counters.touches.saturating_add(more));
        }
    }

    /// Takes note of why the outputs are off, where that is latched: a drop is remembered until nothing is. A fault
    /// alone is none.
    pub fn note_latched(&mut self, latched: Option<Cause>) {
        self.latched = latched;
        let known = self.ledger.counters().uncleared;
        let tripped = latched.filter(|it| *it != Cause::Fault);
        let drop = latched.and(known.or(tripped));
        if drop != known {
            self.ledger.update(|counters| counters.uncleared = drop);
        }
    }

    /// Number of each episode and whether it is locked, in no order.
    pub fn episodes(&self) -> impl Iterator<Item = (u32, bool)> + '_ {
        self.slots.episodes()
    }

    /// Number of each episode that is not being written, in no order.
    pub fn written(&self) -> impl Iterator<Item = u32> + '_ {
        let open = match self.state {
            State::Writing { slot, .. } => self.slots.get(slot).sequence,
            _ => 0,
        };
        let numbers = self.episodes().map(|(number, _)| number);
        numbers.filter(move |&number| number != open)
    }

    /// Gives an episode up, locked or not. One operation.
    pub fn erase_episode<F: NorFlash>(
        &mut self,
        flash: &mut F,
        sequence: u32,
    ) -> Result<(), Refusal> {
        let is_written = self.written().any(|number| number == sequence);
        let slot = self.slots.find(sequence).filter(|_| is_written);
        let released = self.release(flash, slot.ok_or(Refusal::NoEpisode)?);
        released.map_err(|_| Refusal::StoreFailed)
    }

    /// Reads bytes of an episode from `offset` on; how many, 0 past its end or if there is no such
    /// episode. An episode has [`EPISODE_BYTES`], erased ones at the end.
    pub fn read<F: NorFlash>(
        &self,
        flash: &mut F,
        sequence: u32,
        offset: u32,
        bytes: &mut [u8],
    ) -> Result<usize, F::Error> {
        let left = (EPISODE_BYTES as u32).saturating_sub(offset) as usize;
        let length = left.min(bytes.len());
        match (self.slots.find(sequence), bytes.get_mut(..length)) {
            (Some(slot), Some(bytes)) if length > 0 => {
                flash.read(self.layout.slot(slot) + offset, bytes)?;
                Ok(length)
            }
            _ => Ok(0),
        }
    }

    /// Keeps an episode, or gives it free to be overwritten; one that was locked and unlocked too often fails. One
    /// operation.
    pub fn set_locked<F: MultiwriteNorFlash>(
        &mut self,
        flash: &mut F,
        sequence: u32,
        locked: bool,
    ) -> Result<(), Refusal> {
        let slot = self.slots.find(sequence).ok_or(Refusal::NoEpisode)?;
        if self.slots.get(slot).locked == locked {
            return Ok(());
        }
        if locked && self.slots.unlocked() <= LEAST_UNLOCKED {
            return Err(Refusal::NoRoom);
        }
        let marks = slots::marks(flash, self.layout, slot).map_err(|_| Refusal::StoreFailed)?;
        let address =
            self.layout.marks(slot) + u32::from(marks.toggle.ok_or(Refusal::StoreFailed)?);
        let made = flash.write(address, &[0]);
        made.map_err(|_| Refusal::StoreFailed)?;
        self.slots.set(slot, sequence, locked);
        Ok(())
    }

    /// Marks the oldest episode as given up, if its slot has one.
    fn prepare<F: MultiwriteNorFlash>(&mut self, flash: &mut F) -> Result<bool, F::Error> {
        let Some(slot) = self.slots.oldest() else {
            return Ok(false);
        };
        if self.slots.get(slot).sequence != 0 {
            self.release(flash, slot)?;
        }
        self.state = State::Erasing { slot, sector: 0 };
        Ok(true)
    }

    fn release<F: NorFlash>(&mut self, flash: &mut F, slot: usize) -> Result<(), F::Error> {
        flash.write(self.layout.marks(slot), &layout::RELEASED)?;
        self.slots.set(slot, 0, false);
        Ok(())
    }

    /// From the first sector, the one with the header, to the last, the one with the mark.
    fn erase<F: NorFlash>(
        &mut self,
        flash: &mut F,
        slot: usize,
        sector: u32,
    ) -> Result<(), F::Error> {
        let (from, to) = self.layout.sector(slot, sector);
        flash.erase(from, to)?;
        let sector = sector + 1;
        self.state = if sector == SECTORS_PER_SLOT {
            State::Ready { slot }
        } else {
            State::Erasing { slot, sector }
        };
        Ok(())
    }

    fn begin<F: NorFlash>(
        &mut self,
        flash: &mut F,
        slot: usize,
        first: &Block,
    ) -> Result<(), F::Error> {
        // What is left of an episode that had too many blocks has no place.
        if first.kind() != Kind::Header {
            return Ok(());
        }
        let newest = self.slots.newest().max(self.counters().episodes);
        self.slots.set(slot, newest.saturating_add(1), false);
        self.write(flash, slot, 0, first)
    }

    fn write<F: NorFlash>(
        &mut self,
        flash: &mut F,
        slot: usize,
        block: u32,
        next: &Block,
    ) -> Result<(), F::Error> {
        let sequence = self.slots.get(slot).sequence;
        let ending = Ending::decode(next.payload()).filter(|_| next.kind() == Kind::Ending);
        let complete = ending.is_some_and(|it| u32::from(it.blocks) == block + 1);
        if complete || block + 1 == BLOCKS_PER_SLOT {
            self.ledger
                .update(|counters| counters.count(sequence, ending.as_ref(), self.latched));
            self.state = State::Unprepared;
        } else {
            let block = block + 1;
            self.state = State::Writing { slot, block };
        }
        let address = self.layout.slot(slot) + block * BLOCK_BYTES as u32;
        flash.write(address, &next.seal(sequence, block as u16))
    }
}
