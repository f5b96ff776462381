//! Where the detector runs.

use std::path::PathBuf;

use touchdown_core::monitor::MonitorConfig;
use touchdown_core::sample::Sample;

use crate::failure::Failure;
use crate::monitor_run::{self, Answer};

/// Where the detector runs.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Target {
    /// In this process.
    Host,
    /// The firmware image, in the emulator.
    Qemu {
        /// The image.
        image: PathBuf,
    },
}

/// The image that `cargo xtask firmware` builds, from the workspace's folder.
pub const DEFAULT_IMAGE: &str = "target/thumbv7em-none-eabihf/release/touchdown-firmware";

impl Target {
    /// Fails early where the target is not there.
    pub fn check(&self) -> Result<(), Failure> {
        match self {
            Self::Qemu { image } if !image.is_file() => Err(Failure::Target(format!(
                "{}: no firmware image here; `cargo xtask firmware` builds it, `--image FILE` \
                 takes another one",
                image.display()
            ))),
            _ => Ok(()),
        }
    }

    /// Runs the monitor over `samples`.
    pub fn run(
        &self,
        config: &MonitorConfig,
        samples: impl Iterator<Item = Sample>,
    ) -> Result<Answer, Failure> {
        match self {
            Self::Host => monitor_run::run(config, samples)
                .map_err(|error| Failure::Usage(format!("monitor: {error}"))),
            Self::Qemu { image } => Err(Failure::Target(format!(
                "{}: the emulator is not available",
                image.display()
            ))),
        }
    }
}
