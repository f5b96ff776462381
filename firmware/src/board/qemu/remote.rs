//! The link of the emulator: USART1, which QEMU connects to what `-serial` names.

use core::time::Duration;

use semihosting::experimental::time::Instant;
use stm32f4::stm32f405::Peripherals;
use touchdown_core::event::Notice;
use touchdown_protocol::config_block::{Block, Key, Settings};
use touchdown_protocol::link::{Device, Log, Recent, Refusal, Server, State};

use super::FileLog;
use super::serial::Serial;
use super::settings::SettingsFile;
use crate::app::App;
use crate::board::{Abilities, STATE_SAMPLES};
use crate::journal;
use crate::recorder::Recorder;

/// Looks at a line on which nothing comes before it is left: QEMU brings a byte only once the one before
/// has been taken.
const IDLE_POLLS: u32 = 50;
/// The same in the middle of a frame: on a busy desktop a byte takes long.
const FRAME_POLLS: u32 = 5_000;
/// Instructions between two looks: QEMU moves bytes while the core does not ask for them.
const PAUSE: u32 = 5_000;
/// Without a byte for so long, and without samples, nobody is there any more.
const DESERTED: Duration = Duration::from_secs(10);

/// The line and who serves it.
pub struct Line {
    serial: Serial,
    server: Server,
    told: u64,
    abilities: Abilities,
    settings: Option<SettingsFile>,
    wants_restart: bool,
    heard: bool,
    since: Option<Instant>,
}

impl Line {
    /// Says its rate to who asks, obeys who has `key`, and keeps the configuration in `settings`.
    pub fn new(abilities: Abilities, key: Option<Key>, settings: Option<SettingsFile>) -> Self {
        // SAFETY: called once, and nobody else takes them.
        let chip = unsafe { Peripherals::steal() };
        Self {
            // The emulated line has no speed.
            serial: Serial::new(chip.USART1, 16),
            server: Server::new(env!("CARGO_PKG_VERSION"), abilities.sample_rate, key),
            told: 0,
            abilities,
            settings,
            wants_restart: false,
            heard: false,
            since: None,
        }
    }

    /// Whether it is served even when no sample is left: where a configuration is kept, until nobody has
    /// said anything for [`DESERTED`]. A desktop that was killed leaves nothing behind.
    pub fn stays(&mut self) -> bool {
        if core::mem::take(&mut self.heard) || self.since.is_none() {
            self.since = Some(Instant::now());
        }
        self.settings.is_some() && self.since.is_none_or(|it| it.elapsed() < DESERTED)
    }

    /// Whether a configuration was stored and waits for a start.
    pub fn wants_restart(&self) -> bool {
        self.wants_restart
    }

    /// Queues a notice.
    pub fn notice(&mut self, notice: &Notice) {
        let frame = self.server.notice(notice);
        // Nothing is lost: the emulated line has no speed.
        while !self.serial.send(frame.as_ref()) {
            self.serial.push();
        }
    }

    /// Takes what has come, and sends until nothing is left.
    pub fn serve(
        &mut self,
        app: &mut App,
        recorder: &mut Recorder<'_>,
        block: &Block,
        service: bool,
        log: &mut Option<FileLog>,
    ) {
        let mut remote = Remote {
            app,
            recorder,
            block,
            service,
            told: None,
            log,
            abilities: self.abilities,
            settings: self.settings.as_ref(),
            wants_restart: &mut self.wants_restart,
        };
        if remote.app.state().samples() >= self.told + STATE_SAMPLES {
            self.told = remote.app.state().samples();
            // The next one tells more.
            let _ = self.serial.send(self.server.state(&mut remote).as_ref());
        }
        let (mut idle, mut polls) = (0, IDLE_POLLS);
        while idle < polls {
            let Some(byte) = self.serial.poll() else {
                if self.serial.is_done() {
                    // Where nothing is kept, nobody is on the line: not worth a wait.
                    idle += if self.settings.is_some() {
                        cortex_m::asm::delay(PAUSE);
                        1
                    } else {
                        polls
                    };
                }
                continue;
            };
            idle = 0;
            self.heard = true;
            polls = if byte == 0 { IDLE_POLLS } else { FRAME_POLLS };
            // An answer without room is asked for again.
            let _ = self
                .serial
                .send(self.server.take(byte, &mut remote).as_ref());
            if let Some(notice) = remote.told.take() {
                journal::notice(&notice);
                // Without room, as on silicon.
                let _ = self.serial.send(self.server.notice(&notice).as_ref());
            }
        }
    }
}

struct Remote<'a, 'm> {
    app: &'a mut App,
    recorder: &'a mut Recorder<'m>,
    block: &'a Block,
    service: bool,
    /// Of an order, to be passed on.
    told: Option<Notice>,
    log: &'a mut Option<FileLog>,
    abilities: Abilities,
    settings: Option<&'a SettingsFile>,
    wants_restart: &'a mut bool,
}

impl Device for Remote<'_, '_> {
    fn state(&mut self) -> State {
        // QEMU says nothing about time, and no notice is lost.
        self.app.report(0, 0)
    }

    fn config(&mut self) -> Block {
        self.block.clone()
    }

    fn service(&mut self) -> bool {
        self.service
    }

    fn ordered(&mut self, notice: &Notice) {
        self.recorder.hear(notice);
        self.told = Some(*notice);
    }

    fn set_config(&mut self, block: &[u8], settings: &Settings) -> Result<(), Refusal> {
        if let Some(parameter) = self.abilities.misfit(&settings.monitor) {
            return Err(Refusal::parameter(parameter));
        }
        self.app.may_restart()?;
        self.settings.ok_or(Refusal::NoStore)?.store(block)?;
        *self.wants_restart = true;
        Ok(())
    }

    fn clear(&mut self) -> Result<(), Refusal> {
        Ok(self.app.clear()?)
    }

    fn recent(&mut self, step: u16) -> Recent {
        self.recorder.recent(step)
    }

    fn log(&mut self) -> &mut impl Log {
        self.log
    }
}
