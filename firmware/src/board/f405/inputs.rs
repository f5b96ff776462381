//! The speed pulse, "levitation on" and the service input.

use stm32f4::stm32f405::{GPIOB, GPIOC, RCC, TIM4};
use touchdown_protocol::config_block::Settings;

use super::clocks::APB1_TIMER_HZ;
use crate::board::silicon::{InputRegisters, Inputs};

/// The timer counts every eighth tick: one turn of it takes 6.2 ms.
const PRESCALER: u32 = 8;

/// PB8 (timer 4, channel 3): rising edge of the speed pulse. PB9: high while levitation is on.
pub struct PinInputs {
    pins: GPIOB,
    timer: TIM4,
}

impl PinInputs {
    /// Sets up what `settings` say is wired.
    pub fn wired(settings: &Settings, pins: GPIOB, timer: TIM4, rcc: &RCC) -> Inputs<Self> {
        Inputs::new(settings, APB1_TIMER_HZ / PRESCALER, |every| {
            rcc.ahb1enr().modify(|_, w| w.gpioben().enabled());
            rcc.apb1enr().modify(|_, w| w.tim4en().enabled());
            // A broken wire reads as "off": a fall is then confirmed at once.
            pins.pupdr().modify(|_, w| w.pupdr9().pull_down());
            pins.afrh().modify(|_, w| w.afrh8().af2());
            pins.moder().modify(|_, w| w.moder8().alternate());
            timer.psc().write(|w| w.psc().set(PRESCALER as u16 - 1));
            // Eight samples at 1/32 of the timer's clock, 3 us, are an edge.
            timer
                .ccmr2_input()
                .write(|w| w.cc3s().ti3().ic3f().set(0b1111).ic3psc().set(every));
            timer.ccer().write(|w| w.cc3e().set_bit());
            timer.egr().write(|w| w.ug().set_bit());
            timer.cr1().write(|w| w.cen().enabled());
            Self { pins, timer }
        })
    }
}

impl InputRegisters for PinInputs {
    fn capture(&mut self) -> (Option<u16>, u16) {
        let is_new = self.timer.sr().read().cc3if().bit_is_set();
        let captured = is_new.then(|| self.timer.ccr3().read().bits() as u16);
        let is_over = self.timer.sr().read().cc3of().bit_is_set();
        if is_over {
            self.timer.sr().modify(|_, w| w.cc3of().clear_bit());
        }
        let now = self.timer.cnt().read().bits() as u16;
        (captured.filter(|_| !is_over), now)
    }

    fn levitated(&self) -> bool {
        self.pins.idr().read().idr9().bit_is_set()
    }

    fn service(&self) -> bool {
        // SAFETY: a read of a register that reading does not change; `OutputPins` has set up the port.
        let pins = unsafe { &*GPIOC::ptr() };
        pins.idr().read().idr4().bit_is_set()
    }
}
