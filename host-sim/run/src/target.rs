//! Where the detector runs.

use std::path::Path;

use touchdown_core::learnt::Learnt;
use touchdown_core::monitor::MonitorConfig;
use touchdown_core::sample::Sample;

use crate::controller_run;
use crate::controller_trace::ControllerTrace;
use crate::emulator::{Emulator, EmulatorError};
use crate::monitor_run::{self, MonitorOutput};
use touchdown_base::failure::Failure;

/// Where the detector runs.
#[derive(Clone, Debug)]
pub enum Target {
    /// In this process.
    Host,
    /// The firmware image, in the emulator.
    Qemu(Emulator),
}

impl Target {
    /// The image that runs.
    pub fn image(&self) -> Option<&Path> {
        match self {
            Self::Host => None,
            Self::Qemu(emulator) => Some(emulator.image()),
        }
    }

    /// Runs the monitor over `samples`.
    pub fn run(
        &self,
        config: &MonitorConfig,
        samples: impl Iterator<Item = Sample>,
    ) -> Result<MonitorOutput, Failure> {
        match self {
            Self::Host => monitor_run::run(config, samples)
                .map_err(|error| Failure::Usage(format!("monitor: {error}"))),
            Self::Qemu(emulator) => Ok(emulator.run(config, samples)?),
        }
    }

    /// The same from what the monitor had `learnt` before them on, which the image cannot be handed.
    pub fn resume(
        &self,
        config: &MonitorConfig,
        learnt: &Learnt,
        samples: impl Iterator<Item = Sample>,
    ) -> Result<MonitorOutput, Failure> {
        match self {
            Self::Host => monitor_run::resume(config, learnt, samples)
                .map_err(|error| Failure::Usage(format!("monitor: {error}"))),
            Self::Qemu(_) => Err(Failure::Usage(
                "the stream says what the detector had learnt (its column learnt), which the emulator's image \
                 cannot be handed; leave out --on qemu, or the column"
                    .to_owned(),
            )),
        }
    }

    /// Runs the whole controller over `samples`.
    pub fn control(
        &self,
        config: &MonitorConfig,
        samples: impl Iterator<Item = Sample>,
    ) -> Result<(MonitorOutput, ControllerTrace), Failure> {
        match self {
            Self::Host => controller_run::run(config, samples)
                .map_err(|error| Failure::Usage(format!("monitor: {error}"))),
            Self::Qemu(emulator) => Ok(emulator.control(config, samples)?),
        }
    }
}

impl From<EmulatorError> for Failure {
    fn from(error: EmulatorError) -> Self {
        Self::Target(error.to_string())
    }
}
