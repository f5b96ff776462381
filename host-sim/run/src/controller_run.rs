//! The whole controller on the desktop: what the emulator's image runs, over flash in RAM.

use touchdown_core::event::{Notice, Notices};
use touchdown_core::forecast::ForecastTask;
use touchdown_core::monitor::{Fingerprint, MonitorConfig};
use touchdown_core::sample::Sample;
use touchdown_firmware::app::App;
use touchdown_firmware::board::{BLOCK_SAMPLES, Board, EMULATED_SLOTS};
use touchdown_firmware::drop_log::{DropLog, bytes_of};
use touchdown_firmware::recorder::{Memory, Recorder};
use touchdown_firmware::tick::tick;
use touchdown_protocol::config_block::{self, Block};
use touchdown_protocol::controller::{Faults, Shown};
use touchdown_protocol::link::Hello;
use touchdown_protocol::wire::Switching;
use touchdown_rotor::error::ConfigError;

use crate::controller_trace::{ControllerTrace, MonitorOutput, Procedure};
use touchdown_files::ram_nor::RamNor;

type RamLog = DropLog<RamNor, EMULATED_SLOTS>;

/// Runs the controller over `samples`, from an erased log on.
pub fn run(
    config: &MonitorConfig,
    procedure: &Procedure,
    samples: impl Iterator<Item = Sample>,
) -> Result<(MonitorOutput, ControllerTrace), ConfigError> {
    let mut log =
        RamLog::mount(RamNor(vec![0xff; bytes_of(EMULATED_SLOTS)])).expect("room for the slots");
    let mut desk = Desk {
        block: config_block::encode(&(*config).into()),
        ..Desk::default()
    };
    let mut memory = Box::new(Memory::EMPTY);
    let boot = log.counters().boots;
    let mut recorder = Recorder::new(&mut memory, config, &desk.block, boot);
    let mut app = App::try_new(config, Faults::NONE)?;
    match &procedure.learnt {
        Some(learnt) => app.resume(learnt),
        None if procedure.power_on => {}
        None => app.assume_lift(),
    }
    let mut forecast_task = ForecastTask::try_new(&config.detector)?;
    let mut notices = Notices::new();
    let mut fingerprint = Fingerprint::default();
    for sample in samples {
        if procedure.clear_at.contains(&desk.ticks) {
            let notice = app.clear_as_ordered();
            desk.report(&notice);
            recorder.hear(&notice);
        }
        tick(&mut app, &mut recorder, &mut desk, &sample, 0, &mut notices);
        if let Some(outlook) = forecast_task.work(&app.forecast_input(forecast_task.wants_input()))
        {
            desk.report(&outlook);
            recorder.hear(&outlook);
        }
        fingerprint.take(app.state(), &forecast_task);
        if desk.ticks.is_multiple_of(BLOCK_SAMPLES as u64) {
            let latched = app.shown().latched();
            while log.work(recorder.counted, latched, || recorder.fetch()) == Ok(true) {}
        }
    }
    let latched = app.shown().latched();
    while log.work(recorder.counted, latched, || recorder.fetch()) == Ok(true) {}
    let answer = MonitorOutput {
        severity: app.state().severity.so_far,
        summary: fingerprint.summary(app.state()),
        ..desk.said
    };
    // As the link would answer.
    let hello = Hello {
        firmware: env!("CARGO_PKG_VERSION").try_into().unwrap_or_default(),
        sample_rate: config.detector.sample_rate,
    };
    let state = app.report(0, 0);
    let conduct = ControllerTrace {
        flash: log.flash().0.clone(),
        ..ControllerTrace::new(&answer.notices, desk.switchings, hello, state)
    };
    Ok((answer, conduct))
}

/// The board: it remembers.
#[derive(Default)]
struct Desk {
    block: Block,
    said: MonitorOutput,
    switchings: Vec<Switching>,
    ticks: u64,
}

impl Board for Desk {
    fn report(&mut self, notice: &Notice) {
        self.said.hear(*notice);
    }

    fn drive(&mut self, shown: Shown) {
        if self.switchings.last().is_none_or(|it| it.shown != shown) {
            let sample = self.ticks;
            self.switchings.push(Switching { sample, shown });
        }
        self.ticks += 1;
    }

    fn config(&self) -> &[u8] {
        &self.block
    }

    // There is no watchdog on a desktop.
    fn feed(&mut self) {}
}
