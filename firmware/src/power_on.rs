//! What is checked at power-on, the same on every board, and what follows from it.

use defmt::error;
use touchdown_protocol::config_block::{self, Block, BlockError, Settings};
use touchdown_protocol::controller::{Fault, Faults};

use crate::board::Abilities;
use crate::crash::Crash;
use crate::journal;

/// What a board finds.
pub struct PowerOn {
    /// The block that is stored, and what it says.
    pub stored: Result<(InForce, Settings), BlockError>,
    /// In force where nothing that fits is stored.
    pub fallback: Settings,
    /// Whether the fallback counts as configured.
    pub is_configured: bool,
    /// Whether the image is the one that was built.
    pub is_whole: bool,
    /// The record of a crash.
    pub crash: Option<Crash>,
    /// Whether the watchdog reset the core.
    pub has_bitten: bool,
}

/// The configuration block in force.
#[expect(clippy::large_enum_variant, reason = "one of it, and no allocation")]
pub enum InForce {
    /// Where it is stored.
    Stored(&'static [u8]),
    /// In memory.
    Held(Block),
}

impl InForce {
    /// The block.
    pub fn bytes(&self) -> &[u8] {
        match self {
            Self::Stored(block) => block,
            Self::Held(block) => block,
        }
    }
}

impl PowerOn {
    /// The configuration in force, and what was wrong.
    pub fn check(self, abilities: &Abilities) -> (InForce, Settings, Faults) {
        let mut found = Faults::NONE;
        let mut find = |fault, is_so| {
            if is_so {
                error!("power-on: fault {=u8}", fault as u8);
                found = found.with(fault);
            }
        };
        if let Some(crash) = &self.crash {
            journal::crash(crash);
        }
        find(Fault::Crash, self.crash.is_some());
        find(Fault::WatchdogReset, self.has_bitten);
        find(Fault::ImageDamaged, !self.is_whole);
        let fault = match self.stored {
            Ok((block, settings)) if abilities.misfit(&settings.monitor).is_none() => {
                return (block, settings, found);
            }
            Ok(_) => Fault::ConfigMisfit,
            Err(BlockError::Blank) => Fault::Unconfigured,
            Err(_) => Fault::ConfigDamaged,
        };
        find(fault, fault != Fault::Unconfigured || !self.is_configured);
        let block = InForce::Held(config_block::encode(&self.fallback));
        (block, self.fallback, found)
    }
}
