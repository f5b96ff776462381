//! The chip below the tick.

use core::sync::atomic::Ordering;

use cortex_m::peripheral::{DWT, SCB};
use stm32f4::stm32f405::{FLASH, GPIOB, RCC, RNG};
use touchdown_protocol::link::{Frame, Refusal};

use super::clocks::CORE_HZ;
use super::line::Line;
use super::outputs::Watchdog;
use super::{ABILITIES, ChipLog, SAMPLED, Silicon, TICK, record, store};
use crate::board::Abilities;
use crate::journal;
use crate::platform::{JournalEntry, Platform};
use crate::tick::TickTask;

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

/// The line, the stored configuration, the log and what tells why it was reset.
pub struct ChipPlatform {
    line: Line,
    flash: FLASH,
    rcc: RCC,
    random: RNG,
    log: Option<ChipLog>,
}

impl ChipPlatform {
    /// Of the parts that are up; the noise source is started.
    pub fn new(line: Line, flash: FLASH, rcc: RCC, random: RNG, log: Option<ChipLog>) -> Self {
        rcc.ahb2enr().modify(|_, w| w.rngen().enabled());
        random.cr().write(|w| w.rngen().enabled());
        Self {
            line,
            flash,
            rcc,
            random,
            log,
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
}

impl Platform for ChipPlatform {
    type Board = Silicon;
    type Log = ChipLog;

    fn abilities(&self) -> Abilities {
        ABILITIES
    }

    fn hold<T>(&mut self, act: impl FnOnce(&mut TickTask<'static, Silicon>) -> T) -> T {
        TICK.with(act)
            .unwrap_or_else(|| unreachable!("the tick is in its place, and held by one"))
    }

    fn receive(&mut self) -> Option<u8> {
        self.line.next()
    }

    fn send(&mut self, frame: &Frame) -> bool {
        self.line.send(frame)
    }

    fn is_idle(&mut self) -> bool {
        self.line.push()
    }

    fn is_sent(&mut self) -> bool {
        self.line.push() && self.line.is_done()
    }

    fn log(&mut self) -> &mut Option<ChipLog> {
        &mut self.log
    }

    fn store(&mut self, block: &[u8]) -> Result<(), Refusal> {
        store::store(&self.flash, block)
    }

    fn age_us(&mut self) -> u32 {
        let age = DWT::cycle_count().wrapping_sub(SAMPLED.load(Ordering::Relaxed));
        age / (CORE_HZ / 1_000_000)
    }

    fn unknown(&mut self) -> u64 {
        let [low, high] = [self.word(), self.word()].map(|it| u64::from(it.unwrap_or(0)));
        high << 32 | low
    }

    fn forget_reset(&mut self) {
        Watchdog::forget(&self.rcc);
        record::clear();
    }

    fn write_down(&mut self, entry: &JournalEntry<'_>) {
        journal::entry(entry);
    }

    fn reset(&mut self) {
        SCB::sys_reset();
    }
}
