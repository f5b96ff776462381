//! The drop log in serial NOR flash.
//!
//! [`DropLog::work`] does at most one program or erase call, so that a low-priority task can call it
//! and nothing waits for it. In flash there are two sectors of counters and then slots of twelve
//! sectors, an episode each: `docs/formats/log.md` says what makes them safe against a cut of power.

mod layout;
mod ledger;
mod slots;

use embedded_storage::nor_flash::{MultiwriteNorFlash, ReadNorFlash};
use touchdown_core::event::EventKind;
use touchdown_protocol::controller::{Busy, Cause};
use touchdown_protocol::link::{CHUNK_BYTES, Chunk, Log, Refusal};
use touchdown_protocol::log::block::{Block, Kind};
use touchdown_protocol::log::counters::Counters;
use touchdown_protocol::log::ending::Ending;

use self::layout::{BLOCKS_PER_SLOT, SECTOR_BYTES, SECTORS_PER_SLOT};
pub use self::layout::{EPISODE_BYTES, bytes_of};
use self::ledger::Ledger;
pub use self::slots::Slot;
use self::slots::SlotReader;
use crate::recorder::Counted;

/// Slots that must stay unlocked: one to write to, one to erase meanwhile, one to keep.
const LEAST_UNLOCKED: usize = 3;

/// The lifetime counters of the log in `flash`, as [`DropLog::mount`] finds them, before it counts anything itself.
pub fn counters<F: ReadNorFlash>(flash: &mut F) -> Result<Counters, F::Error> {
    Ok(Ledger::mount(flash)?.counters)
}

/// What is in slot `slot` of the log in `flash`, as [`DropLog::mount`] finds it.
pub fn slot<F: ReadNorFlash>(flash: &mut F, slot: usize) -> Result<Slot, F::Error> {
    SlotReader(flash, slot).found()
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

/// The drop log, of `SLOTS` episodes in flash of its own.
#[derive(Clone, Debug)]
pub struct DropLog<F, const SLOTS: usize> {
    flash: F,
    ledger: Ledger,
    slots: [Slot; SLOTS],
    state: State,
    /// Lost drops and touches since reset that are counted in.
    counted: Counted,
    /// Why the outputs are off, where that is latched.
    latched: Option<Cause>,
}

impl<F: MultiwriteNorFlash, const SLOTS: usize> DropLog<F, SLOTS> {
    /// Finds what is in `flash`, which has nothing but the log. Only reads; takes as long as
    /// reading 8 KiB and 800 bytes a slot, and two episodes more after a cut of power. A flash that is smaller than the
    /// slots refuses to be read.
    pub fn mount(mut flash: F) -> Result<Self, F::Error> {
        const {
            assert!(SLOTS >= LEAST_UNLOCKED);
        }
        let mut ledger = Ledger::mount(&mut flash)?;
        let mut slots = [Slot::default(); SLOTS];
        for (number, slot) in slots.iter_mut().enumerate() {
            *slot = SlotReader(&mut flash, number).found()?;
        }
        let counted = ledger.counters.episodes;
        let numbered = slots.iter().map(|it| it.sequence).enumerate();
        for (slot, sequence) in numbered.filter(|&(_, it)| it > counted) {
            let mut found = SlotReader(&mut flash, slot);
            let ending = found.ending(sequence)?;
            // Power went before it was counted, maybe before the trip was noted.
            let trigger = found.trigger(sequence)?;
            let latched = (trigger == Some(EventKind::FreeFall)).then_some(Cause::Fall);
            ledger.update(|counters| counters.count(sequence, ending.as_ref(), latched));
        }
        ledger.update(|counters| counters.boots = counters.boots.saturating_add(1));
        Ok(Self {
            flash,
            ledger,
            slots,
            state: State::Unprepared,
            counted: Counted::default(),
            latched: None,
        })
    }

    /// The flash.
    pub fn flash(&mut self) -> &mut F {
        &mut self.flash
    }

    /// Does the next thing: one operation on the flash at most. `fetch` is called at most once, and
    /// only if its block can be written at once; `counted` is the recorder's, `latched` the application's. Whether there
    /// may be more to do.
    ///
    /// On an error the block that was fetched is lost, which the episode shows; all else is tried
    /// again by the next call.
    pub fn work(
        &mut self,
        counted: Counted,
        latched: Option<Cause>,
        fetch: impl FnOnce() -> Option<Block>,
    ) -> Result<bool, F::Error> {
        self.note_latched(latched);
        self.count(counted);
        match self.state {
            // Also amid an episode: a trip is noted before its record is whole.
            _ if self.ledger.is_ahead() => self.ledger.write(&mut self.flash)?,
            State::Unprepared => return self.prepare(),
            State::Erasing { slot, sector } => self.erase_sector(slot, sector)?,
            State::Ready { slot } => match fetch() {
                Some(next) => self.begin(slot, &next)?,
                None => return Ok(false),
            },
            State::Writing { slot, block } => match fetch() {
                Some(next) => self.write(slot, block, &next)?,
                None => return Ok(false),
            },
        }
        Ok(true)
    }

    /// The lifetime counters; the flash has them after the next few calls of [`Self::work`].
    pub fn counters(&self) -> &Counters {
        &self.ledger.counters
    }

    /// Number of each episode and whether it is locked, in no order.
    pub fn slots(&self) -> impl Iterator<Item = (u32, bool)> + '_ {
        let used = self.slots.iter().filter(|slot| slot.sequence != 0);
        used.map(|slot| (slot.sequence, slot.locked))
    }

    fn slot(&self, number: usize) -> Slot {
        self.slots.get(number).copied().unwrap_or_default()
    }

    fn set_slot(&mut self, number: usize, sequence: u32, locked: bool) {
        if let Some(slot) = self.slots.get_mut(number) {
            *slot = Slot {
                sequence,
                locked,
                released: false,
            };
        }
    }

    fn find(&self, episode: u32) -> Option<usize> {
        let mut slots = self.slots.iter();
        slots.position(|slot| slot.sequence == episode && episode != 0)
    }

    /// Counts in what happened since reset. A rub touches once a turn: touches are written when they are an eighth more
    /// than the flash has.
    fn count(&mut self, since_reset: Counted) {
        let lost = since_reset.lost.saturating_sub(self.counted.lost);
        if lost > 0 {
            self.counted.lost = since_reset.lost;
            self.ledger
                .update(|counters| counters.lost = counters.lost.saturating_add(lost));
        }
        let touches = since_reset.touches.saturating_sub(self.counted.touches);
        if touches > self.counters().touches / 8 {
            self.counted.touches = since_reset.touches;
            self.ledger
                .update(|counters| counters.touches = counters.touches.saturating_add(touches));
        }
    }

    /// Takes note of why the outputs are off, where that is latched: a drop is remembered until nothing is. A fault
    /// alone is none.
    fn note_latched(&mut self, latched: Option<Cause>) {
        self.latched = latched;
        let known = self.counters().uncleared;
        let tripped = latched.filter(|it| *it != Cause::Fault);
        let drop = latched.and(known.or(tripped));
        if drop != known {
            self.ledger.update(|counters| counters.uncleared = drop);
        }
    }

    /// Number of each episode that is not being written, in no order.
    fn written(&self) -> impl Iterator<Item = u32> + '_ {
        let open = match self.state {
            State::Writing { slot, .. } => self.slot(slot).sequence,
            _ => 0,
        };
        let numbers = self.slots().map(|(number, _)| number);
        numbers.filter(move |&number| number != open)
    }

    /// The slot of an episode that is not being written.
    fn slot_of(&self, episode: u32) -> Result<usize, Refusal> {
        let is_written = self.written().any(|number| number == episode);
        let slot = self.find(episode).filter(|_| is_written);
        slot.ok_or(Refusal::NoEpisode)
    }

    /// Takes the slot to be written next, an empty one or else the oldest that is not locked, and marks its episode as given
    /// up, if it has one.
    fn prepare(&mut self) -> Result<bool, F::Error> {
        let slots = self.slots.iter().enumerate();
        let unlocked = slots.filter(|(_, slot)| !slot.locked);
        let Some((slot, oldest)) = unlocked.min_by_key(|(_, slot)| slot.sequence) else {
            return Ok(false);
        };
        if oldest.sequence != 0 {
            self.release(slot)?;
        }
        self.state = State::Erasing { slot, sector: 0 };
        Ok(true)
    }

    fn release(&mut self, slot: usize) -> Result<(), F::Error> {
        self.flash.write(layout::marks(slot), &layout::RELEASED)?;
        self.set_slot(slot, 0, false);
        Ok(())
    }

    /// From the first sector, the one with the header, to the last, the one with the mark.
    fn erase_sector(&mut self, slot: usize, sector: u32) -> Result<(), F::Error> {
        let from = layout::page(slot, 0) + sector * SECTOR_BYTES;
        self.flash.erase(from, from + SECTOR_BYTES)?;
        let sector = sector + 1;
        self.state = if sector == SECTORS_PER_SLOT {
            State::Ready { slot }
        } else {
            State::Erasing { slot, sector }
        };
        Ok(())
    }

    fn begin(&mut self, slot: usize, first: &Block) -> Result<(), F::Error> {
        // What is left of an episode that had too many blocks has no place.
        if first.kind() != Kind::Header {
            return Ok(());
        }
        let numbers = self.slots.iter().map(|slot| slot.sequence);
        let newest = numbers.fold(self.counters().episodes, u32::max);
        self.set_slot(slot, newest.saturating_add(1), false);
        self.write(slot, 0, first)
    }

    fn write(&mut self, slot: usize, block: u32, next: &Block) -> Result<(), F::Error> {
        let sequence = self.slot(slot).sequence;
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
        let sealed = next.seal(sequence, block as u16);
        self.flash.write(layout::page(slot, block), &sealed)
    }
}

impl<F: MultiwriteNorFlash, const SLOTS: usize> Log for DropLog<F, SLOTS> {
    fn episodes(&mut self) -> Option<(u32, u32)> {
        let numbers = self.written();
        numbers.fold(None, |range, number| {
            let (first, last) = range.unwrap_or((number, number));
            Some((number.min(first), number.max(last)))
        })
    }

    /// An episode has [`EPISODE_BYTES`], erased ones at the end.
    fn fetch(&mut self, episode: u32, offset: u32, chunk: &mut Chunk) -> Result<u32, Refusal> {
        let slot = self.slot_of(episode)?;
        let left = (EPISODE_BYTES as u32).saturating_sub(offset) as usize;
        // A chunk has that room.
        let _ = chunk.resize_default(left.min(CHUNK_BYTES));
        if left > 0 {
            let read = self.flash.read(layout::page(slot, 0) + offset, chunk);
            read.map_err(|_| Refusal::StoreFailed)?;
        }
        Ok(EPISODE_BYTES as u32)
    }

    /// One operation.
    fn erase(&mut self, episode: u32) -> Result<(), Refusal> {
        let slot = self.slot_of(episode)?;
        if self.slot(slot).locked {
            return Err(Busy::Locked.into());
        }
        self.release(slot).map_err(|_| Refusal::StoreFailed)
    }

    /// One that was locked and unlocked too often fails. One operation.
    fn set_locked(&mut self, episode: u32, locked: bool) -> Result<(), Refusal> {
        let slot = self.find(episode).ok_or(Refusal::NoEpisode)?;
        if self.slot(slot).locked == locked {
            return Ok(());
        }
        let unlocked = self.slots.iter().filter(|slot| !slot.locked);
        if locked && unlocked.count() <= LEAST_UNLOCKED {
            return Err(Refusal::NoRoom);
        }
        let marks = SlotReader(&mut self.flash, slot).marks();
        let free = marks.ok().and_then(|it| it.toggle);
        let address = layout::marks(slot) + u32::from(free.ok_or(Refusal::StoreFailed)?);
        let made = self.flash.write(address, &[0]);
        made.map_err(|_| Refusal::StoreFailed)?;
        self.set_slot(slot, episode, locked);
        Ok(())
    }

    fn lifetime(&mut self) -> Option<Counters> {
        Some(self.ledger.counters)
    }
}
