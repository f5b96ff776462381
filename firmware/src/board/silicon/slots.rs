//! The stored configuration: flash that is filled block by block without ever being erased here; an erase would stall the
//! core. The last block counts.

use touchdown_protocol::config_block::{self, BLOCK_BYTES, BlockError, Settings};
use touchdown_protocol::link::Refusal;

use crate::power_on::InForce;

/// Flash of a chip that no image takes.
pub trait ConfigFlash {
    /// Its first address; any byte may be read.
    const START: usize;
    /// Its bytes.
    const BYTES: usize;

    /// Programs 8 bytes at this address, of it and aligned, that were erased; only meanwhile it can be written.
    fn program(&self, address: usize, bytes: [u8; 8]);
}

const fn slots<F: ConfigFlash>() -> usize {
    F::BYTES / BLOCK_BYTES
}

fn slot<F: ConfigFlash>(index: usize) -> &'static [u8] {
    let at = F::START + index.min(slots::<F>() - 1) * BLOCK_BYTES;
    // SAFETY: inside the chip's flash, where any byte may be read; written only by `store`, of which
    // no slice that is in use is a part: it fills empty slots.
    unsafe { core::slice::from_raw_parts(at as *const u8, BLOCK_BYTES) }
}

/// Slots in use.
fn used<F: ConfigFlash>() -> usize {
    let is_used = |index: usize| slot::<F>(index).iter().any(|&byte| byte != 0xff);
    (0..slots::<F>())
        .rev()
        .find(|&index| is_used(index))
        .map_or(0, |last| last + 1)
}

/// The last block and its settings.
pub fn load<F: ConfigFlash>() -> Result<(InForce, Settings), BlockError> {
    match used::<F>() {
        0 => Err(BlockError::Blank),
        used => {
            let (block, settings) = config_block::decode(slot::<F>(used - 1))?;
            Ok((InForce::Stored(block), settings))
        }
    }
}

pub fn store<F: ConfigFlash>(flash: &F, block: &[u8]) -> Result<(), Refusal> {
    let at = used::<F>();
    if at >= slots::<F>() || block.len() > BLOCK_BYTES {
        return Err(Refusal::StoreFailed);
    }
    for (index, part) in block.chunks(8).enumerate() {
        let mut bytes = [0xff; 8];
        bytes
            .iter_mut()
            .zip(part)
            .for_each(|(to, from)| *to = *from);
        // A few at a time: ticks come in between.
        flash.program(F::START + at * BLOCK_BYTES + 8 * index, bytes);
    }
    let stored = slot::<F>(at).get(..block.len());
    (stored == Some(block))
        .then_some(())
        .ok_or(Refusal::StoreFailed)
}
