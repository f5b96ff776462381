//! What outlives main's frame on every board: 80 kB of samples, application, recorder, ring.
//!
//! Application and recorder are made in functions of their own, so that their copies are gone from the stack
//! before the first tick.

use core::mem::MaybeUninit;

use touchdown_core::forecast::ForecastTask;
use touchdown_core::monitor::{Monitor, MonitorConfig};
use touchdown_protocol::config_block::{self, Settings};
use touchdown_protocol::controller::Faults;
use touchdown_rotor::error::ConfigError;

use crate::app::App;
use crate::board::{Abilities, Board};
use crate::intake::{Intake, Ring};
use crate::main_loop::MainLoop;
use crate::recorder::{self, Recorder};
use crate::tick::{Outbox, TickTask};

/// Places for them, for a static.
pub struct Memory {
    samples: recorder::Memory,
    ring: Ring,
    outbox: Outbox,
    // Without values of their own: these would take as much flash.
    app: MaybeUninit<App>,
    recorder: MaybeUninit<Recorder<'static>>,
}

impl Memory {
    /// Nothing in its place yet.
    pub const fn empty() -> Self {
        Self {
            samples: recorder::Memory::EMPTY,
            ring: Ring::empty(),
            outbox: Outbox::new(),
            app: MaybeUninit::uninit(),
            recorder: MaybeUninit::uninit(),
        }
    }

    /// What takes a conversion as it comes, the task that takes the samples, and the main loop below it; `found` is what was
    /// wrong at power-on, which was number `boot`.
    pub fn fill<B: Board>(
        &'static mut self,
        settings: &Settings,
        abilities: &Abilities,
        (found, boot): (Faults, u32),
        board: B,
    ) -> Result<(Intake<'static>, TickTask<'static, B>, MainLoop), ConfigError> {
        let app = application(&mut self.app, &settings.monitor, found)?;
        let (place, samples) = (&mut self.recorder, &mut self.samples);
        let recorder = recorder(place, samples, settings, board.config(), boot);
        let oversampling = abilities.oversampling(&settings.monitor)?;
        let (intake, waiting) = self.ring.split(&settings.monitor, oversampling)?;
        let tick = TickTask::new(app, recorder, board, &mut self.outbox, waiting);
        let forecast = forecast_task(&settings.monitor)?;
        Ok((intake, tick, MainLoop::new(settings, forecast)))
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
    settings: &Settings,
    block: &[u8],
    boot: u32,
) -> &'a mut Recorder<'m> {
    // The log tells the checksum, which would tell of the key.
    let told = config_block::blanked(block, settings.key.is_some());
    place.write(Recorder::new(samples, &settings.monitor, &told, boot))
}
