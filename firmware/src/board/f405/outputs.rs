//! The outputs, and the watchdog that makes them fail-safe against a stuck core.

use stm32f4::stm32f405::{DBGMCU, GPIOC, IWDG, RCC};
use touchdown_protocol::controller::Outputs;

use crate::board::silicon::OutputRegisters;

/// PC6 run, PC7 no brake, PC2 permit, PC3 ready, high with current. They float during reset: the
/// circuits behind them need pull-downs. PC4, of the same port, is the service input, high while on.
///
/// The watchdog resets the core when good ticks stay away for 2 ms (1.3 to 3.8 ms over the tolerance of its oscillator, 17
/// to 47 kHz: DS8626, LSI characteristics).
pub struct OutputPins {
    watchdog: IWDG,
    debug: DBGMCU,
}

impl OutputPins {
    /// All without current, the watchdog not started.
    pub fn new(pins: GPIOC, watchdog: IWDG, debug: DBGMCU, rcc: &RCC) -> Self {
        rcc.ahb1enr().modify(|_, w| w.gpiocen().enabled());
        Self::drive(Outputs::SAFE);
        // A broken wire reads as off.
        pins.pupdr().modify(|_, w| w.pupdr4().pull_down());
        pins.moder().modify(|_, w| {
            w.moder6().output().moder7().output();
            w.moder2().output().moder3().output()
        });
        Self { watchdog, debug }
    }
}

impl OutputRegisters for OutputPins {
    fn drive(outputs: Outputs) {
        // SAFETY: a single write to a register that only sets and resets.
        let pins = unsafe { &*GPIOC::ptr() };
        // Where a bit of the lower half is set the upper half does nothing: RM0090, GPIOx_BSRR.
        pins.bsrr().write(|w| {
            w.br6().reset().br7().reset().br2().reset().br3().reset();
            w.bs6().bit(outputs.run).bs7().bit(outputs.no_brake);
            w.bs2().bit(outputs.permit).bs3().bit(outputs.ready)
        });
    }

    fn start_watchdog(&self) {
        self.debug
            .apb1_fz()
            .modify(|_, w| w.dbg_iwdg_stop().set_bit());
        self.watchdog.kr().write(|w| w.key().start());
        self.watchdog.kr().write(|w| w.key().unlock());
        self.watchdog.pr().write(|w| w.pr().divide_by4());
        self.watchdog.rlr().write(|w| w.rl().set(15));
        self.feed();
    }

    fn feed(&self) {
        self.watchdog.kr().write(|w| w.key().feed());
    }
}
