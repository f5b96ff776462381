//! USART1, polled: the emulator has no DMA.

use stm32f4::stm32f405::USART1;
use touchdown_protocol::link::Frame;

use crate::outgoing::Outgoing;

/// The line.
pub struct Serial {
    usart: USART1,
    out: Outgoing,
}

impl Serial {
    /// Takes a USART whose clock and pins are up; `divider` is its clock over the baud rate.
    pub fn new(usart: USART1, divider: u16) -> Self {
        // SAFETY: any value of 16 bits from 16 on is a divider: RM0090, USART_BRR.
        usart.brr().write(|w| unsafe { w.bits(divider) });
        usart
            .cr1()
            .write(|w| w.ue().set_bit().te().set_bit().re().set_bit());
        Self {
            usart,
            out: Outgoing::default(),
        }
    }

    /// Sends what it can, and hands out what came.
    pub fn poll(&mut self) -> Option<u8> {
        self.push();
        let status = self.usart.sr().read();
        // Reading status, then data clears an overrun as well.
        let came = status.rxne().bit_is_set() || status.ore().bit_is_set();
        came.then(|| self.usart.dr().read().dr().bits() as u8)
    }

    /// Sends what it can.
    pub fn push(&mut self) {
        if self.usart.sr().read().txe().bit_is_set()
            && let Some(byte) = self.out.pop()
        {
            self.usart.dr().write(|w| w.dr().set(u16::from(byte)));
        }
    }

    /// Queues a frame, where there is one; whether it had room.
    #[must_use]
    pub fn send(&mut self, frame: Option<&Frame>) -> bool {
        frame.is_none_or(|it| self.out.push(it))
    }

    /// Whether all has gone out.
    pub fn is_done(&self) -> bool {
        self.out.is_empty() && self.usart.sr().read().tc().bit_is_set()
    }
}
