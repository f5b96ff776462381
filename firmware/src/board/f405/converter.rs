//! Four channels at a fixed rate by two converters at once: TIM2 starts them in hardware, so that software jitter does
//! not reach the sampling instant. TIM3 counts these starts in hardware.
//!
//! ADC1 converts x and ADC2 y: both of a plane at one instant, plane b 40 converter cycles, 1.9 us, after plane a.

use stm32f4::stm32f405::{ADC_COMMON, ADC1, ADC2, GPIOA, RCC, TIM2, TIM3, adc1};
use touchdown_core::sample::CHANNELS;

use super::clocks::APB1_TIMER_HZ;
use crate::board::CONVERSION_RATE_HZ;
use crate::platform::SampleSource;

/// Of ADC1 and ADC2, plane a then plane b: PA4 and PA6 are x, PA5 and PA7 are y. Both converters reach all four pins
/// (DS8626, pin definitions).
const INPUTS: [[u8; 2]; 2] = [[4, 6], [5, 7]];

pub struct Converter {
    x: ADC1,
    y: ADC2,
    timer: TIM2,
    number: TIM3,
}

impl Converter {
    /// Sets them up, stopped.
    pub fn new(
        (x, y, common): (ADC1, ADC2, &ADC_COMMON),
        (timer, number): (TIM2, TIM3),
        pins: &GPIOA,
        rcc: &RCC,
    ) -> Self {
        rcc.ahb1enr().modify(|_, w| w.gpioaen().enabled());
        rcc.apb1enr()
            .modify(|_, w| w.tim2en().enabled().tim3en().enabled());
        rcc.apb2enr()
            .modify(|_, w| w.adc1en().enabled().adc2en().enabled());
        pins.moder().modify(|_, w| {
            w.moder4().analog().moder5().analog();
            w.moder6().analog().moder7().analog()
        });

        // 84 MHz / 4 = 21 MHz; 36 MHz is the limit (DS8626, 12-bit ADC characteristics).
        // RM0090, injected simultaneous mode: ADC1's trigger starts both.
        common
            .ccr()
            .modify(|_, w| w.adcpre().div4().multi().dual_j());
        set_up(&x, INPUTS[0]);
        set_up(&y, INPUTS[1]);
        x.cr1().modify(|_, w| w.jeocie().enabled());
        x.cr2()
            .modify(|_, w| w.jextsel().tim2trgo().jexten().rising_edge());

        timer
            .arr()
            .write(|w| w.arr().set(APB1_TIMER_HZ / CONVERSION_RATE_HZ - 1));
        timer.cr2().write(|w| w.mms().update());
        // Its clock is TIM2's trigger: RM0090, TIMx internal trigger connection.
        number
            .smcr()
            .write(|w| w.ts().itr1().sms().ext_clock_mode());
        number.cr1().write(|w| w.cen().enabled());
        Self {
            x,
            y,
            timer,
            number,
        }
    }
}

impl SampleSource for Converter {
    fn start(&self) {
        self.timer.cr1().write(|w| w.cen().enabled());
    }

    fn number(&self) -> u16 {
        self.number.cnt().read().cnt().bits() as u16
    }

    // Both converters are through: they began together, and take as long.
    fn take(&mut self) -> Option<[u16; CHANNELS]> {
        self.x.sr().modify(|_, w| w.jeoc().clear());
        self.y.sr().modify(|_, w| w.jeoc().clear());
        let [ax, bx] = results(&self.x);
        let [ay, by] = results(&self.y);
        Some([ax, ay, bx, by])
    }
}

fn set_up(adc: &adc1::RegisterBlock, [a, b]: [u8; 2]) {
    adc.cr1().write(|w| w.scan().enabled().res().twelve_bit());
    adc.smpr2().write(|w| {
        w.smp4().cycles28().smp5().cycles28();
        w.smp6().cycles28().smp7().cycles28()
    });
    adc.jsqr().write(|w| {
        // SAFETY: channels 4 to 7 exist. Two conversions are the last two of the sequence: RM0090, ADC_JSQR.
        unsafe { w.jsq3().bits(a).jsq4().bits(b) };
        w.jl().set(1)
    });
    adc.cr2().write(|w| w.adon().enabled());
}

fn results(adc: &adc1::RegisterBlock) -> [u16; 2] {
    [adc.jdr1(), adc.jdr2()].map(|it| it.read().jdata().bits())
}
