//! The outputs, and the watchdog that makes them fail-safe against a stuck core.

use stm32g4::stm32g474::{DBGMCU, GPIOC, IWDG, RCC};
use touchdown_protocol::controller::Outputs;

use crate::board::silicon::OutputRegisters;

/// PC6 run, PC7 no brake, PC2 permit, PC3 ready, high with current. They float during reset: the
/// circuits behind them need pull-downs. PC4 is the service input, high while on.
///
/// The watchdog resets the core when good ticks stay away for 2 ms of its oscillator.
pub struct OutputPort {
    pins: GPIOC,
    watchdog: IWDG,
    debug: DBGMCU,
}

/// RM0440, GPIOx_BSRR: the upper half resets.
const DROP_ALL: u32 = (1 << 6 | 1 << 7 | 1 << 2 | 1 << 3) << 16;

impl OutputPort {
    /// All without current, the watchdog not started.
    pub fn new(pins: GPIOC, watchdog: IWDG, debug: DBGMCU, rcc: &RCC) -> Self {
        rcc.ahb2enr().modify(|_, w| w.gpiocen().set_bit());
        let outputs = Self {
            pins,
            watchdog,
            debug,
        };
        outputs.drive(Outputs::SAFE);
        // SAFETY: pull-down is 2: a broken wire reads as off. An output is 1, an input 0; after reset all are analog.
        unsafe {
            outputs.pins.pupdr().modify(|_, w| w.pupdr4().bits(2));
            outputs.pins.moder().modify(|_, w| {
                w.moder6().bits(1).moder7().bits(1);
                w.moder2().bits(1).moder3().bits(1).moder4().bits(0)
            });
        }
        outputs
    }
}

impl OutputRegisters for OutputPort {
    fn drive(&self, outputs: Outputs) {
        let levels = [
            (outputs.run, 6),
            (outputs.no_brake, 7),
            (outputs.permit, 2),
            (outputs.ready, 3),
        ];
        let set = levels.map(|(level, pin)| u32::from(level) << pin);
        // SAFETY: where a bit of the lower half is set the upper half does nothing: RM0440, GPIOx_BSRR.
        self.pins
            .bsrr()
            .write(|w| unsafe { w.bits(set.iter().fold(DROP_ALL, |all, it| all | it)) });
    }

    fn drop_now() {
        // SAFETY: a single write to a register that only sets and resets.
        let pins = unsafe { &*GPIOC::ptr() };
        // SAFETY: likewise.
        pins.bsrr().write(|w| unsafe { w.bits(DROP_ALL) });
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
