//! The speed pulse, "levitation on" and the service input.

use stm32g4::stm32g474::{GPIOB, RCC, TIM4};
use touchdown_protocol::config_block::Settings;

use super::clocks::CORE_HZ;
use super::outputs::OutputPort;
use crate::board::chip_platform::SampleInputs;
use crate::speed::{Speed, SpeedState, pulses_a_capture};

/// The timer counts every sixteenth tick: one turn of it takes 6.2 ms.
const PRESCALER: u32 = 16;
/// RM0440, TIMx_SR: captured, and captured again before it was read.
const CAPTURED: u32 = 1 << 1;
const OVER: u32 = 1 << 9;

/// PB6 (timer 4, channel 1): rising edge of the speed pulse. PB7: high while levitation is on.
pub struct TimerInputs {
    pins: GPIOB,
    timer: TIM4,
    speed: Option<Speed>,
    state: SpeedState,
    levitation: bool,
}

impl TimerInputs {
    /// Sets up what `settings` say is wired.
    pub fn new(pins: GPIOB, timer: TIM4, rcc: &RCC, settings: &Settings) -> Self {
        rcc.apb1enr1().modify(|_, w| w.tim4en().set_bit());
        let Settings {
            monitor, wiring, ..
        } = settings;
        let (spin, rate) = (monitor.detector.machine.spin, monitor.detector.sample_rate);
        let captured = wiring
            .pulses_per_turn
            .map(|it| (it, pulses_a_capture(it, spin, rate)));
        let every = captured.map_or(1, |(_, every)| every).trailing_zeros();
        // SAFETY: AF2 is TIM4 (DS12288, alternate functions), pull-down is 2. Eight samples at 1/32 of the timer's clock,
        // 1.5 us, are an edge of the input: RM0440, TIMx_CCMR1.
        unsafe {
            pins.pupdr().modify(|_, w| w.pupdr7().bits(2));
            pins.afrl().modify(|_, w| w.afrl6().bits(2));
            pins.moder()
                .modify(|_, w| w.moder6().bits(2).moder7().bits(0));
            timer.psc().write(|w| w.bits((PRESCALER - 1) as _));
            timer
                .ccmr1_input()
                .write(|w| w.bits(1 | every << 2 | 0b1111 << 4));
            timer.ccer().write(|w| w.bits(1));
        }
        timer.egr().write(|w| w.ug().set_bit());
        timer.cr1().write(|w| w.cen().set_bit());
        let hz = (CORE_HZ / PRESCALER) as f32;
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

impl SampleInputs for TimerInputs {
    fn spin(&mut self) -> Option<f32> {
        let speed = self.speed.as_ref()?;
        let is_new = self.timer.sr().read().bits() & CAPTURED != 0;
        // Reading what was captured clears the flag; before the timer, or it could be ahead of it.
        let captured = is_new.then(|| self.timer.ccr(0).read().bits() as u16);
        // An edge that came before another was read is lost, and the time between the two is none of a period.
        let is_over = self.timer.sr().read().bits() & OVER != 0;
        if is_over {
            // SAFETY: a 1 leaves what it is at.
            self.timer.sr().write(|w| unsafe { w.bits(!OVER) });
        }
        let captured = captured.filter(|_| !is_over);
        let now = self.timer.cnt().read().bits() as u16;
        speed.take(&mut self.state, now, captured)
    }

    fn levitated(&self) -> Option<bool> {
        let is_high = self.pins.idr().read().idr7().bit_is_set();
        self.levitation.then_some(is_high)
    }

    fn service(&self) -> bool {
        OutputPort::service()
    }
}
