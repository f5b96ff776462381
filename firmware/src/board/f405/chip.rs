//! The W25Q flash chip on SPI1, polled: the one on the Feather STM32F405.

use core::convert::Infallible;

use embedded_hal::delay::DelayNs;
use embedded_hal::spi::{ErrorType, Operation, SpiDevice};
use stm32f4::stm32f405::{GPIOA, GPIOB, RCC, SPI1};

use super::clocks::CORE_HZ;
use crate::w25q::W25q;

/// The chip.
pub type Chip = W25q<Spi, Cycles>;

/// PB3 clock, PB4 in, PB5 out, PA15 chip select.
pub struct Spi {
    spi: SPI1,
    select: GPIOA,
}

impl Spi {
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
            w.moder3()
                .alternate()
                .moder4()
                .alternate()
                .moder5()
                .alternate()
        });
        spi.cr1().write(|w| {
            w.mstr().master().br().div4();
            w.ssm().enabled().ssi().slave_not_selected().spe().enabled()
        });
        Self { spi, select }
    }

    fn exchange(&mut self, byte: u8) -> u8 {
        while self.spi.sr().read().txe().bit_is_clear() {}
        self.spi.dr().write(|w| w.dr().set(byte.into()));
        while self.spi.sr().read().rxne().bit_is_clear() {}
        self.spi.dr().read().dr().bits() as u8
    }
}

impl ErrorType for Spi {
    type Error = Infallible;
}

impl SpiDevice for Spi {
    fn transaction(&mut self, operations: &mut [Operation<'_, u8>]) -> Result<(), Infallible> {
        self.select.bsrr().write(|w| w.br15().set_bit());
        for operation in operations {
            match operation {
                Operation::Read(bytes) => bytes.iter_mut().for_each(|it| *it = self.exchange(0)),
                Operation::Write(bytes) => bytes.iter().for_each(|it| {
                    self.exchange(*it);
                }),
                Operation::Transfer(into, from) => {
                    let mut from = from.iter();
                    for place in into.iter_mut() {
                        *place = self.exchange(from.next().copied().unwrap_or(0));
                    }
                    from.for_each(|it| {
                        self.exchange(*it);
                    });
                }
                Operation::TransferInPlace(bytes) => {
                    bytes.iter_mut().for_each(|it| *it = self.exchange(*it));
                }
                Operation::DelayNs(time) => Cycles.delay_ns(*time),
            }
        }
        while self.spi.sr().read().bsy().bit_is_set() {}
        self.select.bsrr().write(|w| w.bs15().set_bit());
        Ok(())
    }
}

/// Waits by counting cycles.
pub struct Cycles;

impl DelayNs for Cycles {
    fn delay_ns(&mut self, time: u32) {
        const CYCLES_A_MICROSECOND: u32 = CORE_HZ / 1_000_000;
        let rest = (CYCLES_A_MICROSECOND * (time % 1_000)).div_ceil(1_000);
        cortex_m::asm::delay(CYCLES_A_MICROSECOND * (time / 1_000) + rest);
    }
}
