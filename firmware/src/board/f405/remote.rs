//! What the link may ask of this board.

use cortex_m::peripheral::DWT;
use stm32f4::stm32f405::{FLASH, GPIOB, RCC, RNG};
use touchdown_core::event::Notice;
use touchdown_protocol::config_block::{Block, Settings};
use touchdown_protocol::link::{Device, Log, Recent, Refusal, State};

use super::clocks::CORE_HZ;
use super::outputs::Watchdog;
use super::{ABILITIES, ChipLog, record, store, with_tick};
use crate::board::Board;

/// Looks at the noise source, far more than a word takes.
const WORD_POLLS: u32 = 1_000;

/// PB6 sends, PB7 receives: USART1.
pub fn wire(pins: &GPIOB, rcc: &RCC) {
    rcc.ahb1enr().modify(|_, w| w.gpioben().enabled());
    rcc.apb2enr().modify(|_, w| w.usart1en().enabled());
    pins.afrl().modify(|_, w| w.afrl6().af7().afrl7().af7());
    // A line that is not there reads as idle.
    pins.pupdr().modify(|_, w| w.pupdr7().pull_up());
    pins.moder()
        .modify(|_, w| w.moder6().alternate().moder7().alternate());
}

/// The board, as the link sees it.
pub struct Remote {
    flash: FLASH,
    rcc: RCC,
    random: RNG,
    log: Option<ChipLog>,
    wants_reset: bool,
    lost_notices: u32,
}

impl Remote {
    /// With nothing asked yet.
    pub fn new(flash: FLASH, rcc: RCC, random: RNG, log: Option<ChipLog>) -> Self {
        rcc.ahb2enr().modify(|_, w| w.rngen().enabled());
        random.cr().write(|w| w.rngen().enabled());
        Self {
            flash,
            rcc,
            random,
            log,
            wants_reset: false,
            lost_notices: 0,
        }
    }

    /// Does the log's next thing, if the chip is ready for it.
    pub fn work(&mut self) {
        let Some(log) = &mut self.log else { return };
        if log.flash().is_busy() == Ok(false) {
            let known = with_tick(|tick| (tick.recorder.counted(), tick.app.latched()));
            let (counted, latched) = known.unwrap_or_default();
            log.work(counted, latched, || {
                with_tick(|tick| tick.recorder.fetch()).flatten()
            });
        }
    }

    /// A word of the noise source; none where it fails: RM0090, random number generator. It takes 40 of its cycles.
    fn word(&self) -> Option<u32> {
        let is_ready = || self.random.sr().read().drdy().bit_is_set();
        let came = (0..WORD_POLLS).any(|_| is_ready());
        let status = self.random.sr().read();
        let failed = status.secs().bit_is_set() || status.cecs().bit_is_set();
        (came && !failed).then(|| self.random.dr().read().bits())
    }

    /// Counts a notice for which there was no room on the line.
    pub fn lose_notice(&mut self) {
        self.lost_notices = self.lost_notices.saturating_add(1);
    }

    /// Whether another configuration waits for a reset.
    pub fn wants_reset(&self) -> bool {
        self.wants_reset
    }
}

impl Device for Remote {
    fn state(&mut self) -> State {
        with_tick(|tick| {
            let age = DWT::cycle_count().wrapping_sub(tick.at);
            let lost = tick.board.lost_notices.saturating_add(self.lost_notices);
            tick.app.report(age / (CORE_HZ / 1_000_000), lost)
        })
        .unwrap_or(State::NONE)
    }

    fn config(&mut self) -> Block {
        with_tick(|tick| Block::from_slice(tick.board.config()).unwrap_or_default())
            .unwrap_or_default()
    }

    fn service(&mut self) -> bool {
        with_tick(|tick| tick.board.service()).unwrap_or(false)
    }

    fn unknown(&mut self) -> u64 {
        let [low, high] = [self.word(), self.word()].map(|it| u64::from(it.unwrap_or(0)));
        high << 32 | low
    }

    fn ordered(&mut self, notice: &Notice) {
        with_tick(|tick| {
            tick.board.report(notice);
            tick.recorder.hear(notice);
        });
    }

    fn set_config(&mut self, block: &[u8], settings: &Settings) -> Result<(), Refusal> {
        if let Some(parameter) = ABILITIES.misfit(&settings.monitor) {
            return Err(Refusal::parameter(parameter));
        }
        with_tick(|tick| tick.app.may_restart()).unwrap_or(Ok(()))?;
        store::store(&self.flash, block)?;
        self.wants_reset = true;
        Ok(())
    }

    fn clear(&mut self) -> Result<(), Refusal> {
        with_tick(|tick| tick.app.clear()).unwrap_or(Ok(()))?;
        Watchdog::forget(&self.rcc);
        record::clear();
        Ok(())
    }

    fn recent(&mut self, step: u16) -> Recent {
        with_tick(|tick| tick.recorder.recent(step)).unwrap_or_default()
    }

    fn log(&mut self) -> &mut impl Log {
        &mut self.log
    }
}
