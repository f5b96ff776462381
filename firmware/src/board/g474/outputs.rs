//! The outputs, and the watchdog that makes them fail-safe against a stuck core.

use stm32g4::stm32g474::{DBGMCU, GPIOC, IWDG, RCC};
use touchdown_protocol::controller::Outputs;

use crate::board::silicon::OutputRegisters;

/// PC6 run, PC7 no brake, PC2 permit, PC3 ready, high with current. They float during reset: the
/// circuits behind them need pull-downs. PC4 is the service input, high while on.
///
/// The watchdog resets the core when good ticks stay away for 2 ms of its oscillator.
pub struct OutputPort {
    watchdog: IWDG,
    debug: DBGMCU,
}

impl OutputPort {
    /// All without current, the watchdog not started.
    pub fn new(pins: GPIOC, watchdog: IWDG, debug: DBGMCU, rcc: &RCC) -> Self {
        rcc.ahb2enr().modify(|_, w| w.gpiocen().set_bit());
        Self::drive(Outputs::SAFE);
        // SAFETY: pull-down is 2: a broken wire reads as off. An output is 1, an input 0; after reset all are analog.
        unsafe {
            pins.pupdr().modify(|_, w| w.pupdr4().bits(2));
            pins.moder().modify(|_, w| {
                w.moder6().bits(1).moder7().bits(1);
                w.moder2().bits(1).moder3().bits(1).moder4().bits(0)
            });
        }
        Self { watchdog, debug }
    }
}

impl OutputRegisters for OutputPort {
    fn drive(outputs: Outputs) {
        // SAFETY: a single write to a register that only sets and resets.
        let pins = unsafe { &*GPIOC::ptr() };
        // Where a bit of the lower half is set the upper half does nothing: RM0440, GPIOx_BSRR.
        pins.bsrr().write(|w| {
            w.br6()
                .set_bit()
                .br7()
                .set_bit()
                .br2()
                .set_bit()
                .br3()
                .set_bit();
            w.bs6().bit(outputs.run).bs7().bit(outputs.no_brake);
            w.bs2().bit(outputs.permit).bs3().bit(outputs.ready)
        });
    }

    fn start_watchdog(&self) {
        self.debug
            .apb1l_fz()
            .modify(|_, w| w.dbg_iwdg_stop().set_bit());
        // SAFETY: keys of RM0440, IWDG_KR: start, unlock. A quarter of 32 kHz, 16 of it.
        unsafe {
            self.watchdog.kr().write(|w| w.bits(0xcccc));
            self.watchdog.kr().write(|w| w.bits(0x5555));
            self.watchdog.pr().write(|w| w.bits(0));
            self.watchdog.rlr().write(|w| w.bits(15));
        }
        self.feed();
    }

    fn feed(&self) {
        // SAFETY: the key of RM0440, IWDG_KR.
        self.watchdog.kr().write(|w| unsafe { w.bits(0xaaaa) });
    }
}
