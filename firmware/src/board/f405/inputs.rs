//! The speed pulse and "levitation on".

use stm32f4::stm32f405::{GPIOB, RCC, TIM4};
use touchdown_protocol::config_block::Settings;

use super::clocks::APB1_TIMER_HZ;
use super::outputs::OutputPins;
use crate::board::chip_platform::SampleInputs;
use crate::speed::{Speed, SpeedState, pulses_a_capture};

/// The timer counts every eighth tick: one turn of it takes 6.2 ms.
const PRESCALER: u32 = 8;

/// PB8 (timer 4, channel 3): rising edge of the speed pulse. PB9: high while levitation is on.
pub struct PinInputs {
    pins: GPIOB,
    timer: TIM4,
    speed: Option<Speed>,
    state: SpeedState,
    levitation: bool,
}

impl PinInputs {
    /// Sets up what `settings` say is wired.
    pub fn new(pins: GPIOB, timer: TIM4, rcc: &RCC, settings: &Settings) -> Self {
        rcc.ahb1enr().modify(|_, w| w.gpioben().enabled());
        rcc.apb1enr().modify(|_, w| w.tim4en().enabled());
        // A broken wire reads as "off": a fall is then confirmed at once.
        pins.pupdr().modify(|_, w| w.pupdr9().pull_down());
        pins.afrh().modify(|_, w| w.afrh8().af2());
        pins.moder().modify(|_, w| w.moder8().alternate());
        timer.psc().write(|w| w.psc().set(PRESCALER as u16 - 1));
        let Settings {
            monitor, wiring, ..
        } = settings;
        let (spin, rate) = (monitor.detector.machine.spin, monitor.detector.sample_rate);
        let captured = wiring
            .pulses_per_turn
            .map(|it| (it, pulses_a_capture(it, spin, rate)));
        let every = captured.map_or(1, |(_, every)| every).trailing_zeros() as u8;
        // Eight samples at 1/32 of the timer's clock, 3 us, are an edge.
        timer
            .ccmr2_input()
            .write(|w| w.cc3s().ti3().ic3f().set(0b1111).ic3psc().set(every));
        timer.ccer().write(|w| w.cc3e().set_bit());
        timer.egr().write(|w| w.ug().set_bit());
        timer.cr1().write(|w| w.cen().enabled());
        let hz = (APB1_TIMER_HZ / PRESCALER) as f32;
        Self {
            pins,
            timer,
            speed: captured.map(|(pulses, every)| {
                let turns = f32::from(every) / f32::from(pulses.max(1));
                Speed::new(turns, spin >= 0.0, hz)
            }),
            state: SpeedState::default(),
            levitation: wiring.levitation,
        }
    }
}

impl SampleInputs for PinInputs {
    fn spin(&mut self) -> Option<f32> {
        let speed = self.speed.as_ref()?;
        let is_new = self.timer.sr().read().cc3if().bit_is_set();
        // Reading what was captured clears the flag; before the timer, or it could be ahead of it.
        let captured = is_new.then(|| self.timer.ccr3().read().bits() as u16);
        // An edge that came before another was read is lost, and the time between the two is none of a period.
        let is_over = self.timer.sr().read().cc3of().bit_is_set();
        if is_over {
            self.timer.sr().modify(|_, w| w.cc3of().clear_bit());
        }
        let captured = captured.filter(|_| !is_over);
        let now = self.timer.cnt().read().bits() as u16;
        speed.take(&mut self.state, now, captured)
    }

    fn levitated(&self) -> Option<bool> {
        let is_high = self.pins.idr().read().idr9().bit_is_set();
        self.levitation.then_some(is_high)
    }

    fn service(&self) -> bool {
        OutputPins::service()
    }
}
