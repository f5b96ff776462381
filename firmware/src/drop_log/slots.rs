//! What is in a slot.

use embedded_storage::nor_flash::ReadNorFlash;
use touchdown_core::event::EventKind;
use touchdown_protocol::log::block::{BLOCK_BYTES, Kind, Page, Sealed};
use touchdown_protocol::log::ending::Ending;
use touchdown_protocol::log::header::Header;
use touchdown_protocol::log::marks::{MARKS_BYTES, Marks};

use super::layout::{self, BLOCKS_PER_SLOT};

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

/// Flash, and the slot of it that is read.
pub(super) struct SlotReader<'a, F>(pub(super) &'a mut F, pub(super) usize);

impl<F: ReadNorFlash> SlotReader<'_, F> {
    pub(super) fn found(&mut self) -> Result<Slot, F::Error> {
        let marks = self.marks()?;
        let sequence = if marks.released { 0 } else { self.owner()? };
        Ok(Slot {
            sequence,
            locked: marks.locked && sequence != 0,
            released: marks.released,
        })
    }

    pub(super) fn marks(&mut self) -> Result<Marks, F::Error> {
        let mut bytes = [0; MARKS_BYTES];
        self.0.read(layout::marks(self.1), &mut bytes)?;
        Ok(Marks::decode(&bytes))
    }

    /// The ending of episode `sequence`, if it has one.
    pub(super) fn ending(&mut self, sequence: u32) -> Result<Option<Ending>, F::Error> {
        let mut bytes = [0; BLOCK_BYTES];
        for block in (0..BLOCKS_PER_SLOT).rev() {
            let sealed = self.sealed(block, &mut bytes)?;
            let own = sealed.filter(|it| it.sequence == sequence && it.kind == Some(Kind::Ending));
            if let Some(ending) = own.and_then(|it| Ending::decode(it.payload)) {
                return Ok(Some(ending));
            }
        }
        Ok(None)
    }

    /// What began episode `sequence`; none where its first page is lost.
    pub(super) fn trigger(&mut self, sequence: u32) -> Result<Option<EventKind>, F::Error> {
        let mut bytes = [0; BLOCK_BYTES];
        let own = self
            .sealed(0, &mut bytes)?
            .filter(|it| it.sequence == sequence);
        let header = own.and_then(|it| Header::decode(it.payload));
        Ok(header.map(|it| it.trigger_kind))
    }

    /// Episode that its first pages belong to; 0 for none.
    fn owner(&mut self) -> Result<u32, F::Error> {
        let mut bytes = [0; BLOCK_BYTES];
        for block in 0..FIRST_PAGES {
            if let Some(sealed) = self.sealed(block, &mut bytes)? {
                return Ok(sealed.sequence);
            }
        }
        Ok(0)
    }

    /// The block on a page, if one is whole there.
    fn sealed<'b>(
        &mut self,
        block: u32,
        bytes: &'b mut [u8; BLOCK_BYTES],
    ) -> Result<Option<Sealed<'b>>, F::Error> {
        self.0.read(layout::page(self.1, block), bytes)?;
        Ok(match Page::open(bytes) {
            Page::Sealed(sealed) => Some(sealed),
            Page::Blank | Page::Broken => None,
        })
    }
}
