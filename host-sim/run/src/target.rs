//! Where the detector runs.

use std::path::Path;

use touchdown_core::monitor::MonitorConfig;
use touchdown_core::sample::Sample;
use touchdown_core::sensing::Sensing;

use crate::controller_run;
use crate::controller_trace::{ControllerTrace, MonitorOutput, Procedure};
use crate::emulator::{Emulator, EmulatorError};
use touchdown_base::failure::Failure;
use touchdown_rotor::error::ConfigError;

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
            Self::Qemu(emulator) => Some(&emulator.image),
        }
    }

    /// Runs the whole controller over `samples`, which the image cannot be handed what was learnt before.
    pub fn control(
        &self,
        config: &MonitorConfig,
        procedure: &Procedure,
        samples: impl Iterator<Item = Sample>,
    ) -> Result<(MonitorOutput, ControllerTrace), Failure> {
        let refused = |error: ConfigError| Failure::Usage(format!("monitor: {error}"));
        let mut zones = [0; 4];
        let sensing = Sensing::try_new(&config.sensing).map_err(refused)?;
        let clearance = f64::from(config.detector.machine.clearance);
        let samples = samples.inspect(|sample| {
            if let Some(zone) = procedure.zone(clearance, sensing.planes(sample)) {
                zones[zone] += 1;
            }
        });
        let (answer, trace) = match self {
            Self::Host => controller_run::run(config, procedure, samples).map_err(refused)?,
            Self::Qemu(_) if procedure.learnt.is_some() => {
                return Err(Failure::Usage(
                    "the stream says what the detector had learnt (its column learnt), which the emulator's image \
                     cannot be handed; leave out --on qemu, or the column"
                        .to_owned(),
                ));
            }
            Self::Qemu(emulator) => emulator.control(config, procedure, samples)?,
        };
        Ok((answer, ControllerTrace { zones, ..trace }))
    }
}

impl From<EmulatorError> for Failure {
    fn from(error: EmulatorError) -> Self {
        Self::Target(error.to_string())
    }
}
