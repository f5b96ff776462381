//! The emulator below the tick.

use core::sync::atomic::Ordering;
use core::time::Duration;

use defmt::info;
use semihosting::experimental::time::Instant;
use semihosting::process::exit;
use touchdown_core::forecast::ForecastTask;
use touchdown_core::monitor::Fingerprint;
use touchdown_protocol::link::{Frame, Refusal};
use touchdown_protocol::wire::Record;

use super::line::Line;
use super::settings::SettingsFile;
use super::{DONE, Emulated, FileLog, IS_OVER, RESTART, TICK};
use crate::board::{Abilities, BLOCK_SAMPLES};
use crate::journal;
use crate::platform::{JournalEntry, Platform};
use crate::tick::TickTask;

/// Without a byte for so long, and without samples, nobody is there any more.
const DESERTED: Duration = Duration::from_secs(10);

/// The line, the files and what is told at the end.
pub struct EmulatorPlatform {
    pub(super) line: Line,
    pub(super) abilities: Abilities,
    pub(super) settings: Option<SettingsFile>,
    pub(super) log: Option<FileLog>,
    /// Outside the tick: silicon has neither the time nor the use for it. None once it is told.
    pub(super) fingerprint: Option<Fingerprint>,
    /// Since a byte came, or the last sample.
    pub(super) heard: Option<Instant>,
    /// A whole turn ago there were no more samples.
    pub(super) was_over: bool,
}

impl EmulatorPlatform {
    /// What a replay ends with.
    fn summarise(&mut self, fingerprint: Fingerprint) {
        self.hold(|tick| {
            let summary = fingerprint.summary(tick.app.state());
            let severity = tick.app.state().severity.so_far;
            let board = &mut tick.desk.board;
            board.write(&Record::Severity(severity));
            board.write(&Record::Summary(summary));
            info!(
                "end: {=u64} samples, {=u64} faults",
                summary.samples, summary.faults
            );
        });
    }

    /// Whether somebody may still be on the line: where a configuration is kept, until nobody has said anything for
    /// [`DESERTED`]. A desktop that was killed leaves nothing behind.
    fn stays(&mut self) -> bool {
        let heard = self.heard.get_or_insert_with(Instant::now);
        self.settings.is_some() && heard.elapsed() < DESERTED
    }
}

impl Platform for EmulatorPlatform {
    type Board = Emulated;
    type Log = FileLog;
    const LOG_SAMPLES: u64 = BLOCK_SAMPLES as u64;

    fn abilities(&self) -> Abilities {
        self.abilities
    }

    fn hold<T>(&mut self, act: impl FnOnce(&mut TickTask<'static, Emulated>) -> T) -> T {
        TICK.with(act)
            .unwrap_or_else(|| unreachable!("the tick is in its place, and held by one"))
    }

    fn receive(&mut self) -> Option<u8> {
        let byte = self.line.came.dequeue();
        byte.inspect(|_| self.heard = None)
    }

    fn send(&mut self, frame: &Frame) -> bool {
        self.line.out.push(frame)
    }

    fn is_idle(&mut self) -> bool {
        self.line.push()
    }

    fn is_sent(&mut self) -> bool {
        self.line.push() && self.line.is_done()
    }

    fn log(&mut self) -> &mut Option<FileLog> {
        &mut self.log
    }

    fn store(&mut self, block: &[u8]) -> Result<(), Refusal> {
        let file = self.settings.as_ref().ok_or(Refusal::NoStore)?;
        file.store(block)
    }

    fn write_down(&mut self, entry: &JournalEntry<'_>) {
        journal::entry(entry);
    }

    fn reset(&mut self) {
        exit(RESTART)
    }

    fn after_slice(&mut self, forecast: &ForecastTask) {
        let Some(mut fingerprint) = self.fingerprint.take() else {
            return;
        };
        self.hold(|tick| fingerprint.take(tick.app.state(), forecast));
        self.fingerprint = Some(fingerprint);
    }

    fn is_over(&self) -> bool {
        IS_OVER.load(Ordering::Acquire)
    }

    fn done(&mut self, samples: u64) {
        DONE.store(samples as u32, Ordering::Release);
        let is_over = self.is_over();
        if !core::mem::replace(&mut self.was_over, is_over) {
            return;
        }
        if let Some(fingerprint) = self.fingerprint.take() {
            self.summarise(fingerprint);
        }
        if !self.stays() && self.is_sent() {
            exit(0);
        }
    }
}
