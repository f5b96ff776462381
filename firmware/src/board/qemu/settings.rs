//! The stored configuration in a file of the desktop: one block, written whole.

use semihosting::fs::File;
use semihosting::io::{Read, Write};
use touchdown_protocol::config_block::{self, BLOCK_BYTES, Block, BlockError, Settings};
use touchdown_protocol::link::Refusal;

use super::name::Name;
use crate::power_on::InForce;

/// The file; where it is not there, nothing is stored.
pub struct SettingsFile(pub Name);

impl SettingsFile {
    /// What is stored.
    pub fn load(&self) -> Result<(InForce, Settings), BlockError> {
        let mut bytes = [0xff; BLOCK_BYTES];
        let mut file = File::open(self.0.get()).map_err(|_| BlockError::Blank)?;
        let mut filled = 0;
        while let Some(space) = bytes.get_mut(filled..).filter(|space| !space.is_empty()) {
            match file.read(space).map_err(|_| BlockError::Length)? {
                0 => break,
                read => filled += read,
            }
        }
        let (block, settings) = config_block::decode(&bytes)?;
        let block = Block::from_slice(block).map_err(|_| BlockError::Length)?;
        Ok((InForce::Held(block), settings))
    }

    /// Stores a block.
    pub fn store(&self, block: &[u8]) -> Result<(), Refusal> {
        let file = File::create(self.0.get());
        file.and_then(|mut file| file.write_all(block))
            .map_err(|_| Refusal::StoreFailed)
    }
}
