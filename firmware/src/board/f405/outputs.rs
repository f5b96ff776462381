//! The trip output, and the watchdog that makes it fail-safe against a stuck core.

use stm32f4::stm32f405::{DBGMCU, GPIOC, IWDG, RCC};

use crate::board::TripOutput;

/// PC6, high while energised. It floats during reset: the circuit behind it needs a pull-down.
pub struct TripPin(GPIOC);

impl TripPin {
    /// De-energised.
    pub fn new(pins: GPIOC, rcc: &RCC) -> Self {
        rcc.ahb1enr().modify(|_, w| w.gpiocen().enabled());
        let pin = Self(pins);
        pin.drive(TripOutput::Tripped);
        pin.0.moder().modify(|_, w| w.moder6().output());
        pin
    }

    /// Sets the level.
    pub fn drive(&self, output: TripOutput) {
        self.0.bsrr().write(|w| match output {
            TripOutput::Energised => w.bs6().set_(),
            TripOutput::Tripped => w.br6().reset(),
        });
    }
}

/// Resets the core, and so de-energises the trip output, when ticks stay away for 2 ms (1.3 to 3.8
/// ms over the tolerance of its oscillator, 17 to 47 kHz: DS8626, LSI characteristics).
pub struct Watchdog(IWDG);

impl Watchdog {
    /// Starts it; it stands still while a debugger halts the core.
    pub fn start(iwdg: IWDG, dbgmcu: &DBGMCU) -> Self {
        dbgmcu.apb1_fz().modify(|_, w| w.dbg_iwdg_stop().set_bit());
        iwdg.kr().write(|w| w.key().start());
        iwdg.kr().write(|w| w.key().unlock());
        iwdg.pr().write(|w| w.pr().divide_by4());
        iwdg.rlr().write(|w| w.rl().set(15));
        let watchdog = Self(iwdg);
        watchdog.feed();
        watchdog
    }

    /// Gives it another 2 ms.
    pub fn feed(&self) {
        self.0.kr().write(|w| w.key().feed());
    }

    /// Whether it has bitten since power was applied.
    pub fn has_bitten(rcc: &RCC) -> bool {
        rcc.csr().read().wdgrstf().bit_is_set()
    }
}
