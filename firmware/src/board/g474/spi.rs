//! SPI1 with the AD7606, and SPI3 with the W25Q of the drop log, polled.

use stm32g4::stm32g474::{GPIOA, GPIOB, RCC, SPI1, SPI3, gpioa, spi1};

use super::clocks::CORE_HZ;
use crate::board::silicon::{Bus, CycleDelay, SpiRegisters};

pub type Wait = CycleDelay<{ CORE_HZ / 1_000_000 }>;

/// A SPI and the pin of port A that selects its device.
pub struct SelectedSpi {
    spi: *const spi1::RegisterBlock,
    pin: u32,
}

// SAFETY: each SPI is one device's alone.
unsafe impl Send for SelectedSpi {}

/// RM0440, SPI_CR1: clock idles high, master, and the select is software's; its divider at bit 3.
const CPOL: u32 = 1 << 1;
const MASTER: u32 = 1 << 2 | 1 << 8 | 1 << 9 | 1 << 6;
/// RM0440, SPI_CR2: 8 bits, and each byte that came counts.
const BYTES: u32 = 7 << 8 | 1 << 12;

/// PA5 clock, PA6 in, PA4 select: mode 2 at 10.6 MHz.
pub fn converter(_: SPI1, pins: &GPIOA, rcc: &RCC) -> Bus<SelectedSpi> {
    rcc.ahb2enr().modify(|_, w| w.gpioaen().set_bit());
    rcc.apb2enr().modify(|_, w| w.spi1en().set_bit());
    // SAFETY: AF5 is SPI1: DS12288, alternate functions.
    unsafe {
        pins.afrl().modify(|_, w| w.afrl5().bits(5).afrl6().bits(5));
        pins.moder()
            .modify(|_, w| w.moder5().bits(2).moder6().bits(2));
    }
    device(SPI1::ptr(), pins, 4, CPOL | 3 << 3)
}

/// PB3 clock, PB4 in, PB5 out, PA15 select: mode 0 at 21 MHz.
pub fn flash(_: SPI3, (pins, bus): (&GPIOA, &GPIOB), rcc: &RCC) -> Bus<SelectedSpi> {
    rcc.ahb2enr()
        .modify(|_, w| w.gpioaen().set_bit().gpioben().set_bit());
    rcc.apb1enr1().modify(|_, w| w.spi3en().set_bit());
    // SAFETY: AF6 is SPI3: DS12288, alternate functions. A chip that is not there reads as ones.
    unsafe {
        bus.afrl()
            .modify(|_, w| w.afrl3().bits(6).afrl4().bits(6).afrl5().bits(6));
        bus.pupdr()
            .modify(|_, w| w.pupdr3().bits(0).pupdr4().bits(1));
        bus.ospeedr()
            .modify(|_, w| w.ospeedr3().bits(2).ospeedr5().bits(2));
        bus.moder()
            .modify(|_, w| w.moder3().bits(2).moder4().bits(2).moder5().bits(2));
    }
    device(SPI3::ptr(), pins, 15, 2 << 3)
}

fn device(spi: *const spi1::RegisterBlock, pins: &GPIOA, pin: u32, how: u32) -> Bus<SelectedSpi> {
    let mut device = SelectedSpi { spi, pin };
    device.select(false);
    // SAFETY: bits of the registers, as above. An output is 1.
    unsafe {
        pins.moder()
            .modify(|r, w| w.bits(r.bits() & !(3 << (2 * pin)) | 1 << (2 * pin)));
        let registers = device.registers();
        registers.cr2().write(|w| w.bits(BYTES as _));
        registers.cr1().write(|w| w.bits((how | MASTER) as _));
    }
    Bus(device)
}

impl SelectedSpi {
    fn registers(&self) -> &spi1::RegisterBlock {
        // SAFETY: of the chip, and nobody else's.
        unsafe { &*self.spi }
    }
}

impl SpiRegisters for SelectedSpi {
    type Wait = Wait;

    fn select(&mut self, is_on: bool) {
        while self.registers().sr().read().bsy().bit_is_set() {}
        // SAFETY: a single write to a register that only sets and resets.
        let port: &gpioa::RegisterBlock = unsafe { &*GPIOA::ptr() };
        let half = if is_on { 16 } else { 0 };
        // SAFETY: likewise.
        port.bsrr()
            .write(|w| unsafe { w.bits(1 << (self.pin + half)) });
    }

    fn exchange(&mut self, byte: u8) -> u8 {
        let registers = self.registers();
        while registers.sr().read().txe().bit_is_clear() {}
        // SAFETY: any byte.
        registers.dr8().write(|w| unsafe { w.bits(byte) });
        while registers.sr().read().rxne().bit_is_clear() {}
        registers.dr8().read().bits()
    }
}
