//! The stored configuration: the last sector of the flash, 128 Kbytes, filled block by block without
//! ever being erased here; an erase would stall the core for 2 s. The last block counts.

use stm32f4::stm32f405::FLASH;
use touchdown_protocol::config_block::{self, BLOCK_BYTES, BlockError, Settings};
use touchdown_protocol::link::Refusal;

use crate::power_on::InForce;

/// Sector 11: RM0090, flash module organization. memory.x leaves it out.
const START: usize = 0x080e_0000;
const SLOTS: usize = 128 * 1024 / BLOCK_BYTES;

fn slot(index: usize) -> &'static [u8] {
    let index = index.min(SLOTS - 1);
    // SAFETY: inside the chip's flash, where any byte may be read; written only by `store`, of which
    // no slice that is in use is a part: it fills empty slots.
    unsafe { core::slice::from_raw_parts((START + index * BLOCK_BYTES) as *const u8, BLOCK_BYTES) }
}

/// Slots in use.
fn used() -> usize {
    let is_used = |index: usize| slot(index).iter().any(|&byte| byte != 0xff);
    (0..SLOTS)
        .rev()
        .find(|&index| is_used(index))
        .map_or(0, |last| last + 1)
}

/// The last block and its settings.
pub fn load() -> Result<(InForce, Settings), BlockError> {
    match used() {
        0 => Err(BlockError::Blank),
        used => {
            let (block, settings) = config_block::decode(slot(used - 1))?;
            Ok((InForce::Stored(block), settings))
        }
    }
}

/// Appends a block.
pub fn store(flash: &FLASH, block: &[u8]) -> Result<(), Refusal> {
    let at = used();
    if at >= SLOTS || block.len() > BLOCK_BYTES {
        return Err(Refusal::StoreFailed);
    }
    // RM0090, unlocking the flash control register.
    for key in [0x4567_0123, 0xcdef_89ab] {
        flash.keyr().write(|w| w.key().set(key));
    }
    for (index, word) in block.chunks(4).enumerate() {
        let mut bytes = [0xff; 4];
        bytes
            .iter_mut()
            .zip(word)
            .for_each(|(to, from)| *to = *from);
        // One word at a time, 16 us: ticks come in between.
        flash.cr().write(|w| w.pg().set_bit().psize().psize32());
        let address = (START + at * BLOCK_BYTES + 4 * index) as *mut u32;
        // SAFETY: an erased word of this sector, aligned, programming enabled.
        unsafe { address.write_volatile(u32::from_le_bytes(bytes)) };
        while flash.sr().read().bsy().bit_is_set() {}
    }
    flash.cr().write(|w| w.lock().set_bit());
    let stored = slot(at).get(..block.len());
    (stored == Some(block))
        .then_some(())
        .ok_or(Refusal::StoreFailed)
}
