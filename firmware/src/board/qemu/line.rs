//! USART1 at the rate of a real line, in emulated time. QEMU's has no rate and no DMA: the sampling interrupt moves the
//! bytes.

use cortex_m::singleton;
use heapless::spsc::{Consumer, Producer, Queue};
use stm32f4::stm32f405::USART1;

use crate::board::BAUD;
use crate::outgoing::Outgoing;

/// Bits of a byte on the line.
const BITS: f32 = 10.0;

/// The end of the interrupt.
pub struct Wire {
    usart: USART1,
    came: Producer<'static, u8>,
    goes: Consumer<'static, u8>,
    /// Bytes that pass in an interrupt, and those of them that are still to come.
    rate: f32,
    credit: f32,
}

/// The end of the main loop.
pub struct Line {
    pub came: Consumer<'static, u8>,
    goes: Producer<'static, u8>,
    pub out: Outgoing,
}

/// Both ends, with so many interrupts a second; once.
pub fn open(usart: USART1, interrupts: f32) -> (Wire, Line) {
    let came = singleton!(: Queue<u8, 256> = Queue::new());
    let goes = singleton!(: Queue<u8, 64> = Queue::new());
    let (Some(came), Some(goes)) = (came, goes) else {
        unreachable!("one port, one line");
    };
    // SAFETY: any value of 16 bits from 16 on is a divider: RM0090, USART_BRR.
    usart.brr().write(|w| unsafe { w.bits(16) });
    usart
        .cr1()
        .write(|w| w.ue().set_bit().te().set_bit().re().set_bit());
    let (from_line, came) = came.split();
    let (goes, to_line) = goes.split();
    let wire = Wire {
        usart,
        came: from_line,
        goes: to_line,
        rate: BAUD as f32 / BITS / interrupts,
        credit: 0.0,
    };
    let out = Outgoing::default();
    (wire, Line { came, goes, out })
}

impl Wire {
    /// Moves what passes in an interrupt's time; `scripted` is the byte that a replay brings with its sample.
    pub fn step(&mut self, scripted: Option<u8>) {
        if let Some(byte) = scripted {
            let _ = self.came.enqueue(byte);
        }
        self.credit += self.rate;
        while self.credit >= 1.0 {
            self.credit -= 1.0;
            let status = self.usart.sr().read();
            // Reading status, then data clears an overrun as well. What has no room stays with QEMU.
            let has_come = status.rxne().bit_is_set() || status.ore().bit_is_set();
            if has_come && self.came.ready() {
                let _ = self.came.enqueue(self.usart.dr().read().dr().bits() as u8);
            }
            if status.txe().bit_is_set()
                && let Some(byte) = self.goes.dequeue()
            {
                self.usart.dr().write(|w| w.dr().set(u16::from(byte)));
            }
        }
    }
}

impl Line {
    /// Hands over what waits; whether nothing waits any more.
    pub fn push(&mut self) -> bool {
        while self.goes.ready()
            && let Some(byte) = self.out.pop()
        {
            let _ = self.goes.enqueue(byte);
        }
        self.out.is_empty()
    }

    pub fn is_done(&self) -> bool {
        self.out.is_empty() && self.goes.is_empty()
    }
}
