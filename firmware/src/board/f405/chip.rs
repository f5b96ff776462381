//! The W25Q flash chip on SPI1, polled: the one on the Feather STM32F405.

use stm32f4::stm32f405::{GPIOA, GPIOB, RCC, SPI1};

use super::clocks::CORE_HZ;
use crate::board::silicon::{CycleDelay, SpiRegisters};

/// PB3 clock, PB4 in, PB5 out, PA15 chip select.
pub struct Spi1 {
    spi: SPI1,
    select: GPIOA,
}

impl Spi1 {
    /// Sets up pins and SPI, mode 0 at 21 MHz. PB3, PB4 and PA15 are no longer those of JTAG; a probe talks SWD.
    pub fn new(spi: SPI1, select: GPIOA, pins: &GPIOB, rcc: &RCC) -> Self {
        rcc.ahb1enr()
            .modify(|_, w| w.gpioaen().enabled().gpioben().enabled());
        rcc.apb2enr().modify(|_, w| w.spi1en().enabled());
        select.bsrr().write(|w| w.bs15().set_bit());
        select.moder().modify(|_, w| w.moder15().output());
        select.pupdr().modify(|_, w| w.pupdr15().floating());
        pins.afrl()
            .modify(|_, w| w.afrl3().af5().afrl4().af5().afrl5().af5());
        // A chip that is not there reads as ones: busy for ever, and so refused.
        pins.pupdr()
            .modify(|_, w| w.pupdr3().floating().pupdr4().pull_up());
        pins.ospeedr()
            .modify(|_, w| w.ospeedr3().high_speed().ospeedr5().high_speed());
        pins.moder().modify(|_, w| {
            w.moder3().alternate().moder4().alternate();
            w.moder5().alternate()
        });
        spi.cr1().write(|w| {
            w.mstr().master().br().div4();
            w.ssm().enabled().ssi().slave_not_selected().spe().enabled()
        });
        Self { spi, select }
    }
}

impl SpiRegisters for Spi1 {
    type Wait = CycleDelay<{ CORE_HZ / 1_000_000 }>;

    fn select(&mut self, is_on: bool) {
        while self.spi.sr().read().bsy().bit_is_set() {}
        self.select
            .bsrr()
            .write(|w| w.br15().bit(is_on).bs15().bit(!is_on));
    }

    fn exchange(&mut self, byte: u8) -> u8 {
        while self.spi.sr().read().txe().bit_is_clear() {}
        self.spi.dr().write(|w| w.dr().set(byte.into()));
        while self.spi.sr().read().rxne().bit_is_clear() {}
        self.spi.dr().read().dr().bits() as u8
    }
}
