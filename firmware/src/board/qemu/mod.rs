//! QEMU's netduinoplus2: samples from a replay file, notices to an answer file, both by
//! semihosting. Formats: [`touchdown_protocol::wire`].

mod counter;
mod files;
mod name;
mod nor;
mod remote;
mod serial;
mod settings;

use defmt::{Debug2Format, Display2Format, error, info};
use touchdown_core::event::{Notice, Notices};
use touchdown_core::monitor::{Fingerprint, MonitorConfig};
use touchdown_protocol::config_block::{self, Block, BlockError, Settings, Wiring};
use touchdown_protocol::controller::{Busy, Cause, Fault, Faults, Shown};
use touchdown_protocol::wire::{Cleared, Record, Switching};

pub use self::counter::Counter;
use self::files::{Answer, Files};
use self::nor::NorFile;
use self::remote::Line;
use self::settings::SettingsFile;
use super::{Abilities, Board, EMULATED_SLOTS, image};
use crate::drop_log::DropLog;
use crate::journal;
use crate::memory::{self, Memory};
use crate::recorder::{Identity, Recorder};
use crate::tick::tick;

/// Why a run failed; the exit status.
#[derive(Clone, Copy, Debug)]
#[repr(u8)]
pub enum Failure {
    /// The command line is not two file names.
    CommandLine = 2,
    /// The replay file is missing, damaged or of another version.
    Replay = 3,
    /// The monitor refused the configuration.
    Config = 4,
    /// The answer could not be written.
    Answer = 5,
    /// The log's file could not be used.
    Log = 6,
}

/// How a run ended well; the exit status.
#[derive(Clone, Copy, Debug)]
#[repr(u8)]
enum End {
    /// No sample is left.
    Done = 0,
    /// A configuration was stored and waits for a start: silicon would reset.
    Restart = 7,
}

/// The drop log in a file.
pub(crate) type FileLog = DropLog<NorFile, EMULATED_SLOTS>;

struct Emulated {
    answer: Answer,
    shown: Option<Shown>,
    ticks: u64,
    block: Block,
    line: Line,
    service: bool,
    failed: bool,
}

impl Board for Emulated {
    fn report(&mut self, notice: &Notice) {
        journal::notice(notice);
        self.line.notice(notice);
        self.failed |= self.answer.write(&Record::Notice(*notice)).is_err();
    }

    fn drive(&mut self, shown: Shown) {
        if self.shown != Some(shown) {
            journal::shown(shown);
            self.shown = Some(shown);
            let switching = Switching {
                sample: self.ticks,
                shown,
            };
            self.failed |= self.answer.write(&Record::Switching(switching)).is_err();
        }
        self.ticks += 1;
    }

    fn config(&self) -> &[u8] {
        &self.block
    }

    fn service(&self) -> bool {
        self.service
    }

    // No watchdog is emulated.
    fn feed(&mut self) {}
}

impl Emulated {
    /// An order of the replay file to clear was `refused`, or done.
    fn cleared(&mut self, refused: Option<Busy>) {
        let cleared = Cleared {
            sample: self.ticks,
            refused,
        };
        self.failed |= self.answer.write(&Record::Cleared(cleared)).is_err();
    }
}

/// Runs the replay file that the command line names, and exits the emulator.
pub fn main(memory: &'static mut Memory) -> ! {
    info!("touchdown {=str} on qemu", env!("CARGO_PKG_VERSION"));
    let status = match run(memory) {
        Ok(end) => end as i32,
        Err(failure) => {
            error!("failed: {}", Debug2Format(&failure));
            failure as i32
        }
    };
    semihosting::process::exit(status)
}

/// Ends the emulator after a fault of the core, which would else spin for ever.
pub fn abort() -> ! {
    semihosting::process::abort()
}

fn run(memory: &'static mut Memory) -> Result<End, Failure> {
    let Files {
        mut replay,
        answer,
        log,
        settings,
    } = Files::open()?;
    let mut log = log
        .map(|it| FileLog::mount(it).map_err(|_| Failure::Log))
        .transpose()?;
    let (config, powers_on) = replay.config()?;
    let abilities = abilities(&config);
    let (block, in_force, mut found) = found_at_power_on(config, abilities, settings.as_ref());
    if !image::is_whole() {
        error!("image damaged");
        found = found.with(Fault::ImageDamaged);
    }
    let config = in_force.monitor;
    journal::config(&config);
    let mut board = Emulated {
        answer,
        shown: None,
        ticks: 0,
        block,
        line: Line::new(abilities, in_force.key, settings),
        service: false,
        failed: false,
    };
    let boot = log.as_ref().map_or(0, DropLog::boot);
    // The log tells the checksum of the block, which would tell of the key.
    let told = config_block::blanked(&board.block, in_force.key.is_some());
    let identity = Identity::new(&told, boot);
    let filled = memory.fill(&config, found, identity);
    let (app, recorder) = filled.map_err(|refusal| {
        error!("config: {}", Display2Format(&refusal));
        Failure::Config
    })?;
    if powers_on {
        app.recall(log.as_ref().and_then(DropLog::uncleared));
    } else {
        app.assume_lift();
    }
    let mut forecast_task = memory::forecast_task(&config).map_err(|_| Failure::Config)?;
    let mut notices = Notices::new();
    // Outside the tick: silicon has neither the time nor the use for it.
    let mut fingerprint = Fingerprint::default();
    let mut is_over = false;
    loop {
        if let Some(samples) = replay.samples()? {
            for (sample, clears, service) in samples {
                board.service = service;
                if clears {
                    board.cleared(app.clear().err());
                }
                tick(app, recorder, &mut board, &sample, 0, &mut notices);
                if let Some(outlook) =
                    forecast_task.work(&app.forecast_input(forecast_task.wants_input()))
                {
                    board.report(&outlook);
                    recorder.hear(&outlook);
                }
                fingerprint.take(app.state(), &forecast_task);
            }
        } else if !is_over {
            is_over = true;
            let summary = fingerprint.clone().summary(app.state());
            let severity = *app.state().severity();
            board.answer.write(&Record::Severity(severity))?;
            board.answer.write(&Record::Summary(summary))?;
            info!(
                "end: {=u64} samples, {=u64} faults",
                summary.samples, summary.faults
            );
        }
        // Between blocks of samples: the link is no part of the tick.
        if let Some(log) = &mut log {
            store(log, recorder, app.latched());
        }
        board
            .line
            .serve(app, recorder, &board.block, board.service, &mut log);
        if log.as_mut().is_some_and(|log| log.flash().has_failed()) {
            return Err(Failure::Log);
        }
        if board.failed {
            return Err(Failure::Answer);
        }
        if board.line.wants_restart() {
            return Ok(End::Restart);
        }
        if is_over && !board.line.stays() {
            return Ok(End::Done);
        }
    }
}

/// Those of a board that gives the samples of this configuration.
fn abilities(replayed: &MonitorConfig) -> Abilities {
    Abilities {
        sample_rate: replayed.detector.sample_rate,
        full_scale: replayed.sensing.full_scale,
        tachometers: replayed.tachometers.is_some(),
    }
}

/// The configuration in force, and what was wrong: that of the replay file, where none is stored.
fn found_at_power_on(
    replayed: MonitorConfig,
    abilities: Abilities,
    settings: Option<&SettingsFile>,
) -> (Block, Settings, Faults) {
    let stored = settings.map_or(Err(BlockError::Blank), SettingsFile::load);
    let found = match stored {
        Ok((block, it)) if abilities.misfit(&it.monitor).is_none() => {
            return (block, it, Faults::NONE);
        }
        // What a replay brings counts as configured.
        Err(BlockError::Blank) => Faults::NONE,
        Ok(_) => {
            error!("config: of another board, that of the replay is in force");
            Faults::NONE.with(Fault::ConfigMisfit)
        }
        Err(_) => {
            error!("config: damaged, that of the replay is in force");
            Faults::NONE.with(Fault::ConfigDamaged)
        }
    };
    let settings = Settings {
        monitor: replayed,
        wiring: Wiring::default(),
        key: None,
    };
    (config_block::encode(&settings), settings, found)
}

/// All that is ready.
fn store(log: &mut FileLog, recorder: &mut Recorder<'_>, latched: Option<Cause>) {
    let mut work = |log: &mut FileLog| log.work(recorder.counted(), latched, || recorder.fetch());
    while !log.flash().has_failed() && work(log) {}
}
