//! What outlives main's frame on every board: 80 kB of samples, application and recorder.
//!
//! Application and recorder are made in functions of their own, so that their copies are gone from the stack
//! before the first tick.

use core::mem::MaybeUninit;

use touchdown_core::forecast::ForecastTask;
use touchdown_core::monitor::{Monitor, MonitorConfig};
use touchdown_protocol::controller::Faults;
use touchdown_rotor::error::ConfigError;

use crate::app::App;
use crate::recorder::{self, Identity, Recorder};

/// Places for them, for a static.
pub struct Memory {
    samples: recorder::Memory,
    // Without values of their own: these would take as much flash.
    app: MaybeUninit<App>,
    recorder: MaybeUninit<Recorder<'static>>,
}

impl Memory {
    /// Nothing in its place yet.
    pub const EMPTY: Self = Self {
        samples: recorder::Memory::EMPTY,
        app: MaybeUninit::uninit(),
        recorder: MaybeUninit::uninit(),
    };

    /// Application and recorder; `found` is what was wrong at power-on.
    pub fn fill(
        &'static mut self,
        config: &MonitorConfig,
        found: Faults,
        identity: Identity,
    ) -> Result<(&'static mut App, &'static mut Recorder<'static>), ConfigError> {
        let app = application(&mut self.app, config, found)?;
        let recorder = recorder(&mut self.recorder, &mut self.samples, config, identity);
        Ok((app, recorder))
    }
}

/// The application, in `place`; `found` is what was wrong at power-on.
#[inline(never)]
pub fn application<'a>(
    place: &'a mut MaybeUninit<App>,
    config: &MonitorConfig,
    found: Faults,
) -> Result<&'a mut App, ConfigError> {
    let monitor = Monitor::try_new(config)?;
    let app = place.write(App::new(monitor, config, found));
    app.learn_memory();
    Ok(app)
}

/// The forecast, which whoever runs below the tick keeps.
#[inline(never)]
pub fn forecast_task(config: &MonitorConfig) -> Result<ForecastTask, ConfigError> {
    ForecastTask::try_new(&config.detector)
}

#[inline(never)]
fn recorder<'a, 'm>(
    place: &'a mut MaybeUninit<Recorder<'m>>,
    samples: &'m mut recorder::Memory,
    config: &MonitorConfig,
    identity: Identity,
) -> &'a mut Recorder<'m> {
    place.write(Recorder::new(samples, config, identity))
}
