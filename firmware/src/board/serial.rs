//! USART1, polled: in the emulator as on silicon.

use heapless::Deque;
use stm32f4::stm32f405::USART1;
use touchdown_core::link::{FRAME_BYTES, Frame};

/// Bytes on their way out: two of the longest frames.
const OUT_BYTES: usize = 2 * FRAME_BYTES;

/// The line.
pub struct Serial {
    usart: USART1,
    out: Deque<u8, OUT_BYTES>,
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
            out: Deque::new(),
        }
    }

    /// Sends what it can, and hands out what came.
    pub fn poll(&mut self) -> Option<u8> {
        let status = self.usart.sr().read();
        if status.txe().bit_is_set()
            && let Some(byte) = self.out.pop_front()
        {
            self.usart.dr().write(|w| w.dr().set(u16::from(byte)));
        }
        // Reading status, then data clears an overrun as well.
        let came = status.rxne().bit_is_set() || status.ore().bit_is_set();
        came.then(|| self.usart.dr().read().dr().bits() as u8)
    }

    /// Queues a frame; without room for all of it, none of it.
    pub fn send(&mut self, frame: &Frame) {
        if frame.len() <= OUT_BYTES - self.out.len() {
            for &byte in frame {
                let _ = self.out.push_back(byte);
            }
        }
    }

    /// Whether all has gone out.
    pub fn is_done(&self) -> bool {
        self.out.is_empty() && self.usart.sr().read().tc().bit_is_set()
    }
}
