//! The stored configuration in a file of the desktop: one block, written whole.

use semihosting::fs::{self, File};
use semihosting::io::{self, Read as _};
use touchdown_protocol::config_block::{self, BLOCK_BYTES, Block, BlockError, Settings};
use touchdown_protocol::link::Refusal;

use super::Name;
use crate::power_on::InForce;

/// The file; where it is not there, nothing is stored.
pub struct SettingsFile(pub Name);

impl SettingsFile {
    pub fn load(&self) -> Result<(InForce, Settings), BlockError> {
        let mut bytes = [0xff; BLOCK_BYTES];
        let mut file = File::open(&self.0).map_err(|_| BlockError::Blank)?;
        fill(&mut file, &mut bytes).map_err(|_| BlockError::Length)?;
        let (block, settings) = config_block::decode(&bytes)?;
        let block = Block::from_slice(block).map_err(|_| BlockError::Length)?;
        Ok((InForce::Held(block), settings))
    }

    pub fn store(&self, block: &[u8]) -> Result<(), Refusal> {
        fs::write(&self.0, block).map_err(|_| Refusal::StoreFailed)
    }
}

/// Fills `bytes` as far as the file goes; how many of them it has.
pub fn fill(file: &mut File, bytes: &mut [u8]) -> io::Result<usize> {
    let mut filled = 0;
    while let Some(space) = bytes.get_mut(filled..).filter(|space| !space.is_empty()) {
        match file.read(space)? {
            0 => break,
            read => filled += read,
        }
    }
    Ok(filled)
}
