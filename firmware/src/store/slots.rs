//! Which episode is in which slot.

use embedded_storage::nor_flash::ReadNorFlash;
use touchdown_core::event::EventKind;
use touchdown_protocol::log::block::{BLOCK_BYTES, Kind, Page, Sealed};
use touchdown_protocol::log::ending::Ending;
use touchdown_protocol::log::header::Header;
use touchdown_protocol::log::marks::{MARKS_BYTES, Marks};

use super::layout::{BLOCKS_PER_SLOT, Layout};

/// Pages of which one tells whose slot it is: so many may be damaged but one.
const FIRST_PAGES: u32 = 3;

/// What a slot holds.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Slot {
    /// Number of its episode, from 1; 0 if it has none.
    pub sequence: u32,
    /// Not to be overwritten.
    pub locked: bool,
    /// Its episode has been given up: what is left of it is none.
    pub released: bool,
}

#[derive(Clone, Debug)]
pub(super) struct Slots<const SLOTS: usize>([Slot; SLOTS]);

impl<const SLOTS: usize> Slots<SLOTS> {
    pub(super) fn mount<F: ReadNorFlash>(flash: &mut F, layout: Layout) -> Result<Self, F::Error> {
        let mut slots = [Slot::default(); SLOTS];
        for (number, slot) in slots.iter_mut().enumerate() {
            *slot = found(flash, layout, number)?;
        }
        Ok(Self(slots))
    }

    /// Slots with episodes after `sequence`, and these.
    pub(super) fn after(&self, sequence: u32) -> impl Iterator<Item = (usize, u32)> + '_ {
        let numbered = self.0.iter().map(|slot| slot.sequence).enumerate();
        numbered.filter(move |&(_, it)| it > sequence)
    }

    pub(super) fn episodes(&self) -> impl Iterator<Item = (u32, bool)> + '_ {
        let used = self.0.iter().filter(|slot| slot.sequence != 0);
        used.map(|slot| (slot.sequence, slot.locked))
    }

    pub(super) fn find(&self, sequence: u32) -> Option<usize> {
        self.0
            .iter()
            .position(|slot| slot.sequence == sequence && sequence != 0)
    }

    pub(super) fn newest(&self) -> u32 {
        self.0.iter().map(|slot| slot.sequence).max().unwrap_or(0)
    }

    pub(super) fn unlocked(&self) -> usize {
        self.0.iter().filter(|slot| !slot.locked).count()
    }

    /// Slot to be written next: an empty one, or else the oldest that is not locked.
    pub(super) fn oldest(&self) -> Option<usize> {
        let slots = self.0.iter().enumerate();
        slots
            .filter(|(_, slot)| !slot.locked)
            .min_by_key(|(_, slot)| slot.sequence)
            .map(|(number, _)| number)
    }

    pub(super) fn get(&self, slot: usize) -> Slot {
        self.0.get(slot).copied().unwrap_or_default()
    }

    pub(super) fn set(&mut self, slot: usize, sequence: u32, locked: bool) {
        if let Some(slot) = self.0.get_mut(slot) {
            *slot = Slot {
                sequence,
                locked,
                released: false,
            };
        }
    }
}

/// What is in a slot.
pub(super) fn found<F: ReadNorFlash>(
    flash: &mut F,
    layout: Layout,
    slot: usize,
) -> Result<Slot, F::Error> {
    let marks = marks(flash, layout, slot)?;
    let sequence = if marks.released {
        0
    } else {
        owner(flash, layout, slot)?
    };
    Ok(Slot {
        sequence,
        locked: marks.locked && sequence != 0,
        released: marks.released,
    })
}

/// Marks of a slot.
pub(super) fn marks<F: ReadNorFlash>(
    flash: &mut F,
    layout: Layout,
    slot: usize,
) -> Result<Marks, F::Error> {
    let mut bytes = [0; MARKS_BYTES];
    flash.read(layout.marks(slot), &mut bytes)?;
    Ok(Marks::decode(&bytes))
}

/// Ending of episode `sequence` in `slot`, if it has one.
pub(super) fn ending<F: ReadNorFlash>(
    flash: &mut F,
    layout: Layout,
    slot: usize,
    sequence: u32,
) -> Result<Option<Ending>, F::Error> {
    let mut bytes = [0; BLOCK_BYTES];
    for block in (0..BLOCKS_PER_SLOT).rev() {
        let sealed = sealed(flash, layout, slot, block, &mut bytes)?;
        let own = sealed.filter(|it| it.sequence == sequence && it.kind == Some(Kind::Ending));
        if let Some(ending) = own.and_then(|it| Ending::decode(it.payload)) {
            return Ok(Some(ending));
        }
    }
    Ok(None)
}

/// What began episode `sequence` in `slot`; none where its first page is lost.
pub(super) fn trigger<F: ReadNorFlash>(
    flash: &mut F,
    layout: Layout,
    slot: usize,
    sequence: u32,
) -> Result<Option<EventKind>, F::Error> {
    let mut bytes = [0; BLOCK_BYTES];
    let own = sealed(flash, layout, slot, 0, &mut bytes)?.filter(|it| it.sequence == sequence);
    let header = own.and_then(|it| Header::decode(it.payload));
    Ok(header.map(|it| it.trigger_kind))
}

/// Episode that the first pages of a slot belong to; 0 for none.
fn owner<F: ReadNorFlash>(flash: &mut F, layout: Layout, slot: usize) -> Result<u32, F::Error> {
    let mut bytes = [0; BLOCK_BYTES];
    for block in 0..FIRST_PAGES {
        if let Some(sealed) = sealed(flash, layout, slot, block, &mut bytes)? {
            return Ok(sealed.sequence);
        }
    }
    Ok(0)
}

/// The block on a page of a slot, if one is whole there.
fn sealed<'a, F: ReadNorFlash>(
    flash: &mut F,
    layout: Layout,
    slot: usize,
    block: u32,
    bytes: &'a mut [u8; BLOCK_BYTES],
) -> Result<Option<Sealed<'a>>, F::Error> {
    flash.read(layout.slot(slot) + block * BLOCK_BYTES as u32, bytes)?;
    Ok(match Page::open(bytes) {
        Page::Sealed(sealed) => Some(sealed),
        Page::Blank | Page::Broken => None,
    })
}
