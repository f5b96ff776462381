//! The drop log of a board: the recorder's blocks into flash, and episodes out of it for the link.

use embedded_storage::nor_flash::MultiwriteNorFlash;
use touchdown_protocol::controller::{Busy, Cause};
use touchdown_protocol::link::{CHUNK_BYTES, Chunk, Log, Refusal};
use touchdown_protocol::log::block::Block;
use touchdown_protocol::log::counters::Counters;

use crate::recorder::Counted;
use crate::store::{EPISODE_BYTES, Store};

/// A store of `SLOTS` episodes in its flash.
pub struct DropLog<F, const SLOTS: usize> {
    store: Store<SLOTS>,
    flash: F,
}

impl<F: MultiwriteNorFlash, const SLOTS: usize> DropLog<F, SLOTS> {
    /// Finds what is in `flash`, which has nothing but the log.
    pub fn mount(mut flash: F) -> Result<Self, F::Error> {
        let store = Store::mount(&mut flash, 0)?;
        Ok(Self { store, flash })
    }

    /// The flash.
    pub fn flash(&mut self) -> &mut F {
        &mut self.flash
    }

    /// Times switched on.
    pub fn boot(&self) -> u32 {
        self.store.counters().boots
    }

    /// The drop that nobody has cleared.
    pub fn uncleared(&self) -> Option<Cause> {
        self.store.counters().uncleared
    }

    /// Writes or erases once at most; `counted` is the recorder's, `latched` the application's. Whether there may be more
    /// to do: an error is tried again.
    pub fn work(
        &mut self,
        counted: Counted,
        latched: Option<Cause>,
        fetch: impl FnOnce() -> Option<Block>,
    ) -> bool {
        self.store.note_latched(latched);
        self.store.count_lost(counted.lost);
        self.store.count_touches(counted.touches);
        self.store.work(&mut self.flash, fetch).unwrap_or(false)
    }
}

impl<F: MultiwriteNorFlash, const SLOTS: usize> Log for DropLog<F, SLOTS> {
    fn episodes(&mut self) -> Option<(u32, u32)> {
        let numbers = self.store.written();
        numbers.fold(None, |range, number| {
            let (first, last) = range.unwrap_or((number, number));
            Some((number.min(first), number.max(last)))
        })
    }

    fn fetch(&mut self, episode: u32, offset: u32, chunk: &mut Chunk) -> Result<u32, Refusal> {
        if !self.store.written().any(|it| it == episode) {
            return Err(Refusal::NoEpisode);
        }
        // A chunk has that room.
        let _ = chunk.resize_default(CHUNK_BYTES);
        let read = self.store.read(&mut self.flash, episode, offset, chunk);
        chunk.truncate(read.map_err(|_| Refusal::StoreFailed)?);
        Ok(EPISODE_BYTES as u32)
    }

    fn erase(&mut self, episode: u32) -> Result<(), Refusal> {
        if self.store.episodes().any(|it| it == (episode, true)) {
            return Err(Busy::Locked.into());
        }
        self.store.erase_episode(&mut self.flash, episode)
    }

    fn set_locked(&mut self, episode: u32, locked: bool) -> Result<(), Refusal> {
        self.store.set_locked(&mut self.flash, episode, locked)
    }

    fn lifetime(&mut self) -> Option<Counters> {
        Some(*self.store.counters())
    }
}
