//! USART1 by DMA2: PB6 sends, PB7 receives.

use stm32f4::stm32f405::{DMA2, GPIOB, RCC, USART1};

use super::clocks::APB2_HZ;
use crate::board::BAUD;
use crate::board::silicon::{LineRegisters, RING_BYTES};

/// RM0090, DMA2 request mapping: USART1_RX is channel 4 of stream 2, USART1_TX channel 4 of stream 7.
const RECEIVES: usize = 2;
const SENDS: usize = 7;
const CHANNEL: u8 = 4;
/// USART_SR: transmission complete.
const TC: u16 = 1 << 6;

pub struct Port {
    usart: USART1,
    dma: DMA2,
}

impl Port {
    pub fn new(usart: USART1, dma: DMA2, pins: &GPIOB, rcc: &RCC) -> Self {
        rcc.ahb1enr()
            .modify(|_, w| w.gpioben().enabled().dma2en().enabled());
        rcc.apb2enr().modify(|_, w| w.usart1en().enabled());
        pins.afrl().modify(|_, w| w.afrl6().af7().afrl7().af7());
        // A line that is not there reads as idle.
        pins.pupdr().modify(|_, w| w.pupdr7().pull_up());
        pins.moder()
            .modify(|_, w| w.moder6().alternate().moder7().alternate());
        // SAFETY: any value of 16 bits from 16 on is a divider: RM0090, USART_BRR.
        usart
            .brr()
            .write(|w| unsafe { w.bits((APB2_HZ / BAUD) as u16) });
        usart.cr3().write(|w| w.dmar().set_bit().dmat().set_bit());
        usart
            .cr1()
            .write(|w| w.ue().set_bit().te().set_bit().re().set_bit());
        Self { usart, dma }
    }

    /// Aims a stream at the data register and so many bytes of memory from `at` on.
    fn aim(&self, stream: usize, at: u32, bytes: u32) {
        let stream = self.dma.st(stream);
        let register = self.usart.dr().as_ptr() as u32;
        // SAFETY: who calls gives static memory of so many bytes, or more.
        unsafe {
            stream.par().write(|w| w.bits(register));
            stream.m0ar().write(|w| w.bits(at));
            stream.ndtr().write(|w| w.bits(bytes));
        }
    }
}

impl LineRegisters for Port {
    fn receive(&mut self, ring: u32) {
        self.aim(RECEIVES, ring, RING_BYTES as u32);
        self.dma.st(RECEIVES).cr().write(|w| {
            w.chsel().set(CHANNEL).minc().incremented();
            w.circ().enabled().en().enabled()
        });
    }

    fn left(&self) -> u16 {
        self.dma.st(RECEIVES).ndtr().read().ndt().bits()
    }

    fn transmit(&mut self, batch: u32, length: u16) {
        self.dma.hifcr().write(|w| {
            w.ctcif7().clear().chtif7().clear().cteif7().clear();
            w.cdmeif7().clear().cfeif7().clear()
        });
        self.aim(SENDS, batch, length.into());
        // SAFETY: bits of the register. A 1 leaves what it is at, only "complete" is cleared: RM0090, USART_SR.
        self.usart.sr().write(|w| unsafe { w.bits(0x3ff & !TC) });
        self.dma.st(SENDS).cr().write(|w| {
            w.chsel().set(CHANNEL).minc().incremented();
            w.dir().memory_to_peripheral().en().enabled()
        });
    }

    fn sends(&self) -> bool {
        self.dma.st(SENDS).cr().read().en().is_enabled()
    }

    fn is_through(&self) -> bool {
        self.usart.sr().read().tc().bit_is_set()
    }
}
