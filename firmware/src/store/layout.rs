//! Where things are in flash.

use touchdown_protocol::log::block::BLOCK_BYTES;
use touchdown_protocol::log::marks::RELEASE_BYTES;

/// Bytes that are erased at once, 4 KiB in the usual serial NOR flash.
pub(super) const SECTOR_BYTES: u32 = 4096;
/// Sectors of the counters.
pub(super) const COUNTER_SECTORS: u32 = 2;
/// Sectors of a slot: 190 blocks at most and a page of marks.
pub(super) const SECTORS_PER_SLOT: u32 = 12;
/// Pages of a slot but the last, which has the marks.
pub(super) const BLOCKS_PER_SLOT: u32 = SECTORS_PER_SLOT * SECTOR_BYTES / BLOCK_BYTES as u32 - 1;
/// Bytes of an episode with the erased ones behind it.
pub const EPISODE_BYTES: usize = BLOCKS_PER_SLOT as usize * BLOCK_BYTES;
/// The mark that an episode is given up.
pub(super) const RELEASED: [u8; RELEASE_BYTES] = [0; RELEASE_BYTES];

/// Bytes of flash that the log takes with `slots` slots.
pub const fn bytes_of(slots: usize) -> usize {
    (COUNTER_SECTORS as usize + slots * SECTORS_PER_SLOT as usize) * SECTOR_BYTES as usize
}

/// Addresses.
#[derive(Clone, Copy, Debug)]
pub(super) struct Layout {
    pub(super) base: u32,
}

impl Layout {
    pub(super) fn counters(self, sector: u32) -> u32 {
        self.base + sector * SECTOR_BYTES
    }

    pub(super) fn slot(self, slot: usize) -> u32 {
        self.base + bytes_of(slot) as u32
    }

    pub(super) fn marks(self, slot: usize) -> u32 {
        self.slot(slot) + EPISODE_BYTES as u32
    }

    /// From and to.
    pub(super) fn sector(self, slot: usize, sector: u32) -> (u32, u32) {
        let from = self.slot(slot) + sector * SECTOR_BYTES;
        (from, from + SECTOR_BYTES)
    }
}
