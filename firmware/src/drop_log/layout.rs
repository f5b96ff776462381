//! Where things are in flash, from its first byte on.

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

/// Address of page `block` of a slot.
pub(super) const fn page(slot: usize, block: u32) -> u32 {
    bytes_of(slot) as u32 + block * BLOCK_BYTES as u32
}

/// Address of a slot's marks.
pub(super) const fn marks(slot: usize) -> u32 {
    page(slot, BLOCKS_PER_SLOT)
}
