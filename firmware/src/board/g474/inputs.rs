//! The speed pulse, "levitation on" and the service input.

use stm32g4::stm32g474::{GPIOB, GPIOC, RCC, TIM4};
use touchdown_protocol::config_block::Settings;

use super::clocks::CORE_HZ;
use crate::board::silicon::{InputRegisters, Inputs};

/// The timer counts every sixteenth tick: one turn of it takes 6.2 ms.
const PRESCALER: u32 = 16;
/// RM0440, TIMx_SR: captured, and captured again before it was read.
const CAPTURED: u32 = 1 << 1;
const OVER: u32 = 1 << 9;

/// PB6 (timer 4, channel 1): rising edge of the speed pulse. PB7: high while levitation is on.
pub struct TimerInputs {
    pins: GPIOB,
    timer: TIM4,
}

impl TimerInputs {
    /// Sets up what `settings` say is wired.
    pub fn wired(settings: &Settings, pins: GPIOB, timer: TIM4, rcc: &RCC) -> Inputs<Self> {
        Inputs::new(settings, CORE_HZ / PRESCALER, |every| {
            rcc.apb1enr1().modify(|_, w| w.tim4en().set_bit());
            // SAFETY: AF2 is TIM4 (DS12288, alternate functions), pull-down is 2. Eight samples at 1/32 of the timer's
            // clock, 1.5 us, are an edge of the input: RM0440, TIMx_CCMR1.
            unsafe {
                pins.pupdr().modify(|_, w| w.pupdr7().bits(2));
                pins.afrl().modify(|_, w| w.afrl6().bits(2));
                pins.moder()
                    .modify(|_, w| w.moder6().bits(2).moder7().bits(0));
                timer.psc().write(|w| w.bits((PRESCALER - 1) as _));
                timer
                    .ccmr1_input()
                    .write(|w| w.bits(1 | u32::from(every) << 2 | 0b1111 << 4));
                timer.ccer().write(|w| w.bits(1));
            }
            timer.egr().write(|w| w.ug().set_bit());
            timer.cr1().write(|w| w.cen().set_bit());
            Self { pins, timer }
        })
    }
}

impl InputRegisters for TimerInputs {
    fn capture(&mut self) -> (Option<u16>, u16) {
        let is_new = self.timer.sr().read().bits() & CAPTURED != 0;
        let captured = is_new.then(|| self.timer.ccr(0).read().bits() as u16);
        let is_over = self.timer.sr().read().bits() & OVER != 0;
        if is_over {
            // SAFETY: a 1 leaves what it is at.
            self.timer.sr().write(|w| unsafe { w.bits(!OVER) });
        }
        let now = self.timer.cnt().read().bits() as u16;
        (captured.filter(|_| !is_over), now)
    }

    fn levitated(&self) -> bool {
        self.pins.idr().read().idr7().bit_is_set()
    }

    fn service(&self) -> bool {
        // SAFETY: a read of a register that reading does not change; `OutputPort` has set up the port.
        let pins = unsafe { &*GPIOC::ptr() };
        pins.idr().read().idr4().bit_is_set()
    }
}
