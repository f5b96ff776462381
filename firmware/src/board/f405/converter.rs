//! Four channels at a fixed rate: TIM2 starts the converter in hardware, so that software jitter
//! does not reach the sampling instant. TIM3 counts these starts in hardware.
//!
//! The four conversions follow each other by 40 converter cycles, 1.9 us: the channels of one
//! sample are up to 5.7 us apart.

use stm32f4::stm32f405::{ADC_COMMON, ADC1, GPIOA, RCC, TIM2, TIM3};
use touchdown_core::sample::{CHANNELS, Sample, TACHOMETERS};

use super::clocks::APB1_TIMER_HZ;
use crate::board::SAMPLE_RATE_HZ;

/// PA4 to PA7: plane a x, plane a y, plane b x, plane b y.
const INPUTS: [u8; CHANNELS] = [4, 5, 6, 7];

/// Timer and converter.
pub struct Converter {
    adc: ADC1,
    timer: TIM2,
    number: TIM3,
}

impl Converter {
    /// Sets both up, stopped.
    pub fn new(
        adc: ADC1,
        common: &ADC_COMMON,
        timer: TIM2,
        number: TIM3,
        pins: &GPIOA,
        rcc: &RCC,
    ) -> Self {
        rcc.ahb1enr().modify(|_, w| w.gpioaen().enabled());
        rcc.apb1enr()
            .modify(|_, w| w.tim2en().enabled().tim3en().enabled());
        rcc.apb2enr().modify(|_, w| w.adc1en().enabled());
        pins.moder().modify(|_, w| {
            w.moder4().analog().moder5().analog();
            w.moder6().analog().moder7().analog()
        });

        // 84 MHz / 4 = 21 MHz; 36 MHz is the limit (DS8626, 12-bit ADC characteristics).
        common.ccr().modify(|_, w| w.adcpre().div4());
        adc.cr1()
            .write(|w| w.scan().enabled().jeocie().enabled().res().twelve_bit());
        adc.smpr2().write(|w| {
            w.smp4().cycles28().smp5().cycles28();
            w.smp6().cycles28().smp7().cycles28()
        });
        adc.jsqr().write(|w| {
            // SAFETY: channels 4 to 7 exist, and they end in a data register each.
            unsafe {
                w.jsq1().bits(INPUTS[0]).jsq2().bits(INPUTS[1]);
                w.jsq3().bits(INPUTS[2]).jsq4().bits(INPUTS[3]);
            }
            w.jl().set(CHANNELS as u8 - 1)
        });
        adc.cr2().write(|w| {
            w.adon().enabled();
            w.jextsel().tim2trgo().jexten().rising_edge()
        });

        timer
            .arr()
            .write(|w| w.arr().set(APB1_TIMER_HZ / SAMPLE_RATE_HZ - 1));
        timer.cr2().write(|w| w.mms().update());
        // Its clock is TIM2's trigger: RM0090, TIMx internal trigger connection.
        number
            .smcr()
            .write(|w| w.ts().itr1().sms().ext_clock_mode());
        number.cr1().write(|w| w.cen().enabled());
        Self { adc, timer, number }
    }

    /// Starts sampling.
    pub fn start(&self) {
        self.timer.cr1().write(|w| w.cen().enabled());
    }

    /// Number of the newest sample, modulo 2^16.
    pub fn number(&self) -> u16 {
        self.number.cnt().read().cnt().bits() as u16
    }

    /// The sample just converted.
    pub fn take(&self) -> Sample {
        self.adc.sr().modify(|_, w| w.jeoc().clear());
        let mut counts = [0; CHANNELS];
        for (count, register) in counts.iter_mut().zip(self.adc.jdr_iter()) {
            *count = register.read().jdata().bits();
        }
        Sample {
            counts,
            valid: 0b1111,
            spin: None,
            levitated: None,
            edges: [None; TACHOMETERS],
        }
    }
}
