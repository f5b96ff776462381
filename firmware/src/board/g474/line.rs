//! USART1 by DMA1: PA9 sends, PA10 receives.

use stm32g4::stm32g474::{DMA1, DMAMUX, GPIOA, RCC, USART1};

use super::clocks::CORE_HZ;
use crate::board::BAUD;
use crate::board::silicon::{LineRegisters, RING_BYTES};

/// Channels of DMA1, and of the multiplexer one less; requests of USART1_RX and USART1_TX: RM0440, DMAMUX request mapping, held against
/// NuttX, stm32g4xxxx_dmamux.h.
const RECEIVES: (usize, u32) = (1, 24);
const SENDS: (usize, u32) = (2, 25);
/// RM0440, DMA_CCRx: enabled, from memory, round and round, addresses of memory go up.
const EN: u32 = 1;
const FROM_MEMORY: u32 = 1 << 4;
const CIRCULAR: u32 = 1 << 5;
const UP: u32 = 1 << 7;

pub struct ChannelPort {
    usart: USART1,
    dma: DMA1,
}

impl ChannelPort {
    pub fn new(usart: USART1, dma: DMA1, requests: &DMAMUX, pins: &GPIOA, rcc: &RCC) -> Self {
        rcc.ahb1enr()
            .modify(|_, w| w.dma1en().set_bit().dmamux1en().set_bit());
        rcc.apb2enr().modify(|_, w| w.usart1en().set_bit());
        // SAFETY: AF7 and "alternate" exist (DS12288, alternate functions), pull-up is 1, the divider is 16 or more, and the requests are the
        // port's.
        unsafe {
            pins.afrh()
                .modify(|_, w| w.afrh9().bits(7).afrh10().bits(7));
            pins.pupdr().modify(|_, w| w.pupdr10().bits(1));
            pins.moder()
                .modify(|_, w| w.moder9().bits(2).moder10().bits(2));
            usart.brr().write(|w| w.bits(CORE_HZ / BAUD));
            for (channel, request) in [RECEIVES, SENDS] {
                requests.ccr(channel - 1).write(|w| w.bits(request));
            }
        }
        // An overrun must not stop what comes.
        usart
            .cr3()
            .write(|w| w.dmar().set_bit().dmat().set_bit().ovrdis().set_bit());
        usart
            .cr1()
            .write(|w| w.ue().set_bit().te().set_bit().re().set_bit());
        Self { usart, dma }
    }

    /// Moves so many bytes between memory at `at` and the register of the port.
    fn go(&self, channel: usize, register: u32, at: u32, bytes: u32, how: u32) {
        let channel = self.dma.ch(channel - 1);
        // SAFETY: who calls gives static memory of so many bytes, and a data register.
        unsafe {
            channel.cr().write(|w| w.bits(0));
            channel.par().write(|w| w.bits(register));
            channel.mar().write(|w| w.bits(at));
            channel.ndtr().write(|w| w.bits(bytes));
            channel.cr().write(|w| w.bits(how | UP | EN));
        }
    }
}

impl LineRegisters for ChannelPort {
    fn receive(&mut self, ring: u32) {
        let register = self.usart.rdr().as_ptr() as u32;
        self.go(RECEIVES.0, register, ring, RING_BYTES as u32, CIRCULAR);
    }

    fn left(&self) -> u16 {
        self.dma.ch(RECEIVES.0 - 1).ndtr().read().bits() as u16
    }

    fn transmit(&mut self, batch: u32, length: u16) {
        self.usart.icr().write(|w| w.tccf().clear_bit_by_one());
        let register = self.usart.tdr().as_ptr() as u32;
        self.go(SENDS.0, register, batch, length.into(), FROM_MEMORY);
    }

    fn sends(&self) -> bool {
        // Unlike a stream of the F405 a channel stays enabled at its end.
        self.dma.ch(SENDS.0 - 1).ndtr().read().bits() != 0
    }

    fn is_through(&self) -> bool {
        self.usart.isr().read().tc().bit_is_set()
    }
}
