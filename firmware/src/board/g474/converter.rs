//! The AD7606, started by TIM2 in hardware, so that software jitter does not reach the sampling instant. TIM3 counts the
//! starts in hardware.
//!
//! PA0 (TIM2, channel 1) CONVST, PB0 BUSY, whose fall is the sampling interrupt, PB1 RESET.

use core::convert::Infallible;

use embedded_hal::digital::{ErrorType, InputPin, OutputPin};
use stm32g4::stm32g474::{EXTI, GPIOA, GPIOB, RCC, SYSCFG, TIM2, TIM3, gpiob};
use touchdown_core::sample::CHANNELS;

use super::clocks::CORE_HZ;
use super::spi::{SelectedSpi, Wait};
use crate::ad7606::Ad7606;
use crate::board::CONVERSION_RATE_HZ;
use crate::board::silicon::Bus;
use crate::platform::SampleSource;

/// Cycles for which CONVST is low before it rises: 0.4 us.
const LOW: u32 = 64;

/// BUSY and RESET.
pub struct PortBPin;

impl PortBPin {
    fn port() -> &'static gpiob::RegisterBlock {
        // SAFETY: here it is read, or written where that only sets and resets.
        unsafe { &*GPIOB::ptr() }
    }
}

impl ErrorType for PortBPin {
    type Error = Infallible;
}

impl InputPin for PortBPin {
    fn is_high(&mut self) -> Result<bool, Infallible> {
        Ok(Self::port().idr().read().idr0().bit_is_set())
    }

    fn is_low(&mut self) -> Result<bool, Infallible> {
        self.is_high().map(|it| !it)
    }
}

impl OutputPin for PortBPin {
    fn set_low(&mut self) -> Result<(), Infallible> {
        Self::port().bsrr().write(|w| w.br1().set_bit());
        Ok(())
    }

    fn set_high(&mut self) -> Result<(), Infallible> {
        Self::port().bsrr().write(|w| w.bs1().set_bit());
        Ok(())
    }
}

pub struct ExternalConverter {
    adc: Ad7606<Bus<SelectedSpi>, PortBPin>,
    timer: TIM2,
    number: TIM3,
    edges: EXTI,
}

impl ExternalConverter {
    /// Sets them up, stopped.
    pub fn try_new(
        bus: Bus<SelectedSpi>,
        (timer, number): (TIM2, TIM3),
        (convst, pins): (&GPIOA, &GPIOB),
        (edges, routes): (EXTI, &SYSCFG),
        rcc: &RCC,
    ) -> Option<Self> {
        rcc.ahb2enr()
            .modify(|_, w| w.gpioaen().set_bit().gpioben().set_bit());
        rcc.apb1enr1()
            .modify(|_, w| w.tim2en().set_bit().tim3en().set_bit());
        rcc.apb2enr().modify(|_, w| w.syscfgen().set_bit());
        // SAFETY: AF1 is TIM2 (DS12288, alternate functions); 0 is an input, 1 an output, 2 alternate. BUSY that is not there
        // stays low: no edge, no sample.
        unsafe {
            convst.afrl().modify(|_, w| w.afrl0().bits(1));
            convst.moder().modify(|_, w| w.moder0().bits(2));
            pins.pupdr().modify(|_, w| w.pupdr0().bits(2));
            pins.moder()
                .modify(|_, w| w.moder0().bits(0).moder1().bits(1));
            let period = CORE_HZ / CONVERSION_RATE_HZ;
            timer.arr().write(|w| w.bits(period - 1));
            timer.ccr(0).write(|w| w.bits(period - LOW));
            // High until the compare, so that the update is the rise: RM0440, PWM mode 1. The update is the trigger.
            timer.ccmr1_output().write(|w| w.bits(6 << 4));
            timer.ccer().write(|w| w.bits(1));
            timer.cr2().write(|w| w.bits(2 << 4));
            // Its clock is TIM2's trigger, ITR1: RM0440, TIMx internal trigger connection.
            number.smcr().write(|w| w.bits(1 << 4 | 7));
            number.cr1().write(|w| w.bits(1));
            // Port B.
            routes.exticr1().modify(|_, w| w.exti0().bits(1));
        }
        edges.ftsr1().modify(|_, w| w.ft0().set_bit());
        edges.imr1().modify(|_, w| w.im0().set_bit());
        let adc = Ad7606::try_new(bus, PortBPin, PortBPin, &mut Wait {})?;
        Some(Self {
            adc,
            timer,
            number,
            edges,
        })
    }
}

impl SampleSource for ExternalConverter {
    fn start(&self) {
        self.timer.cr1().write(|w| w.cen().set_bit());
    }

    fn number(&self) -> u16 {
        self.number.cnt().read().bits() as u16
    }

    fn take(&mut self) -> Option<[u16; CHANNELS]> {
        self.edges.pr1().write(|w| w.pif0().clear_bit_by_one());
        self.adc.take(&mut Wait {})
    }
}
