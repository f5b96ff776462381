//! The link of the emulator: USART1, which QEMU connects to what `-serial` names.

use stm32f4::stm32f405::Peripherals;
use touchdown_core::config_block::{Block, Settings};
use touchdown_core::event::Notice;
use touchdown_core::link::{Device, Log, Refusal, Server, State};

use super::FileLog;
use crate::app::App;
use crate::board::STATE_SAMPLES;
use crate::board::serial::Serial;

/// The line and who serves it.
pub struct Line {
    serial: Serial,
    server: Server,
    told: u64,
}

impl Line {
    /// Says `sample_rate` (Hz) to who asks.
    pub fn new(sample_rate: f32) -> Self {
        // SAFETY: called once, and nobody else takes them.
        let chip = unsafe { Peripherals::steal() };
        Self {
            // The emulated line has no speed.
            serial: Serial::new(chip.USART1, 16),
            server: Server::new(env!("CARGO_PKG_VERSION"), sample_rate),
            told: 0,
        }
    }

    /// Queues a notice.
    pub fn notice(&mut self, notice: &Notice) {
        let frame = self.server.notice(notice);
        frame.iter().for_each(|it| self.serial.send(it));
    }

    /// Takes what has come, and sends until nothing is left.
    pub fn serve(&mut self, app: &mut App, block: &Block, log: &mut Option<FileLog>) {
        let mut remote = Remote { app, block, log };
        if remote.app.state().samples() >= self.told + STATE_SAMPLES {
            self.told = remote.app.state().samples();
            let frame = self.server.state(&mut remote);
            frame.iter().for_each(|it| self.serial.send(it));
        }
        loop {
            let came = self.serial.poll();
            let answer = came.and_then(|byte| self.server.take(byte, &mut remote));
            answer.iter().for_each(|it| self.serial.send(it));
            if came.is_none() && self.serial.is_done() {
                return;
            }
        }
    }
}

struct Remote<'a> {
    app: &'a mut App,
    block: &'a Block,
    log: &'a mut Option<FileLog>,
}

impl Device for Remote<'_> {
    fn state(&mut self) -> State {
        // QEMU says nothing about time, and no notice is lost.
        self.app.report(0, 0)
    }

    fn config(&mut self) -> Block {
        self.block.clone()
    }

    fn set_config(&mut self, _: &[u8], _: &Settings) -> Result<(), Refusal> {
        self.app.may_restart()?;
        Err(Refusal::NoStore)
    }

    fn clear(&mut self) -> Result<(), Refusal> {
        Ok(self.app.clear()?)
    }

    fn log(&mut self) -> &mut impl Log {
        self.log
    }
}
