//! QEMU's netduinoplus2: samples from a replay file, notices to an answer file, both by
//! semihosting. Formats: [`touchdown_core::wire`].

mod counter;
mod files;

use defmt::{Debug2Format, Display2Format, error, info};
use touchdown_core::event::Notice;
use touchdown_core::monitor::Fingerprint;
use touchdown_core::wire::Record;

pub use self::counter::Counter;
use self::files::Answer;
use super::{Board, TripOutput};
use crate::app::App;
use crate::journal;

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
}

struct Emulated {
    answer: Answer,
    output: TripOutput,
    failed: bool,
}

impl Board for Emulated {
    fn report(&mut self, notice: &Notice) {
        journal::notice(notice);
        self.failed |= self.answer.write(&Record::Notice(*notice)).is_err();
    }

    fn drive(&mut self, output: TripOutput) {
        if output != self.output {
            info!("output: {}", Debug2Format(&output));
            self.output = output;
        }
    }
}

/// Runs the replay file that the command line names, and exits the emulator.
pub fn main() -> ! {
    info!("touchdown {=str} on qemu", env!("CARGO_PKG_VERSION"));
    let status = match run() {
        Ok(()) => 0,
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

fn run() -> Result<(), Failure> {
    let (mut replay, answer) = files::open()?;
    let config = replay.config()?;
    journal::config(&config);
    let mut app = App::try_new(&config).map_err(|refusal| {
        error!("config: {}", Display2Format(&refusal));
        Failure::Config
    })?;
    let mut board = Emulated {
        answer,
        output: TripOutput::Energised,
        failed: false,
    };
    // Outside the tick: silicon has neither the time nor the use for it.
    let mut fingerprint = Fingerprint::default();
    while let Some(samples) = replay.samples()? {
        for sample in samples {
            app.tick(&mut board, &sample);
            fingerprint.take(app.state());
        }
    }
    let summary = fingerprint.summary(app.state());
    let severity = *app.state().severity();
    board.answer.write(&Record::Severity(severity))?;
    board.answer.write(&Record::Summary(summary))?;
    info!(
        "end: {=u64} samples, {=u64} faults",
        summary.samples, summary.faults
    );
    if board.failed {
        return Err(Failure::Answer);
    }
    Ok(())
}
