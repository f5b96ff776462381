//! USART1 by DMA, both ways: a long tick or a busy log loses no byte and holds none back.

use core::sync::atomic::{AtomicU8, Ordering};

use stm32f4::stm32f405::{DMA2, RCC, USART1};
use touchdown_protocol::link::Frame;

use crate::outgoing::Outgoing;

/// Of what comes: 22 ms of the line.
const RING_BYTES: usize = 256;
/// Of what goes at once: 5.6 ms.
const BATCH_BYTES: usize = 64;
/// RM0090, DMA2 request mapping: USART1_RX is channel 4 of stream 2, USART1_TX channel 4 of stream 7.
const RECEIVES: usize = 2;
const SENDS: usize = 7;
const CHANNEL: u8 = 4;
/// USART_SR: transmission complete.
const TC: u16 = 1 << 6;

static RING: [AtomicU8; RING_BYTES] = [const { AtomicU8::new(0) }; RING_BYTES];
static BATCH: [AtomicU8; BATCH_BYTES] = [const { AtomicU8::new(0) }; BATCH_BYTES];

/// The line.
pub struct Line {
    usart: USART1,
    dma: DMA2,
    /// Place of the next byte to be taken.
    at: usize,
    out: Outgoing,
}

impl Line {
    /// Takes a USART whose clock and pins are up, and receives from now on; `divider` is its clock over the baud rate.
    pub fn new(usart: USART1, dma: DMA2, divider: u16, rcc: &RCC) -> Self {
        rcc.ahb1enr().modify(|_, w| w.dma2en().enabled());
        // SAFETY: any value of 16 bits from 16 on is a divider: RM0090, USART_BRR.
        usart.brr().write(|w| unsafe { w.bits(divider) });
        usart.cr3().write(|w| w.dmar().set_bit().dmat().set_bit());
        usart
            .cr1()
            .write(|w| w.ue().set_bit().te().set_bit().re().set_bit());
        let (register, ring) = (usart.dr().as_ptr() as u32, RING.as_ptr() as u32);
        let stream = dma.st(RECEIVES);
        // SAFETY: from the data register into the ring, which is static and has so many bytes.
        unsafe {
            stream.par().write(|w| w.bits(register));
            stream.m0ar().write(|w| w.bits(ring));
            stream.ndtr().write(|w| w.bits(RING_BYTES as u32));
        }
        stream.cr().write(|w| {
            w.chsel().set(CHANNEL).minc().incremented();
            w.circ().enabled().en().enabled()
        });
        Self {
            usart,
            dma,
            at: 0,
            out: Outgoing::default(),
        }
    }

    /// The next byte that came.
    pub fn next(&mut self) -> Option<u8> {
        // What is left of a round counts down, and is whole again at its end.
        let left = self.dma.st(RECEIVES).ndtr().read().ndt().bits();
        let end = (RING_BYTES - usize::from(left)) % RING_BYTES;
        if self.at == end {
            return None;
        }
        let byte = RING.get(self.at)?.load(Ordering::Relaxed);
        self.at = (self.at + 1) % RING_BYTES;
        Some(byte)
    }

    /// Queues a frame; whether it had room.
    #[must_use]
    pub fn send(&mut self, frame: &Frame) -> bool {
        self.out.push(frame)
    }

    /// Hands over what waits, once the bytes before have gone; whether nothing waits any more.
    pub fn push(&mut self) -> bool {
        if self.out.is_empty() || self.sends() {
            return self.out.is_empty();
        }
        let mut length = 0;
        for (place, byte) in BATCH.iter().zip(core::iter::from_fn(|| self.out.pop())) {
            place.store(byte, Ordering::Relaxed);
            length += 1;
        }
        // The bytes before the transfer of them.
        cortex_m::asm::dmb();
        let stream = self.dma.st(SENDS);
        self.dma.hifcr().write(|w| {
            w.ctcif7().clear().chtif7().clear().cteif7().clear();
            w.cdmeif7().clear().cfeif7().clear()
        });
        let (register, batch) = (self.usart.dr().as_ptr() as u32, BATCH.as_ptr() as u32);
        // SAFETY: from the batch, which is static and has as many bytes or more, into the data register.
        unsafe {
            stream.par().write(|w| w.bits(register));
            stream.m0ar().write(|w| w.bits(batch));
            stream.ndtr().write(|w| w.bits(length));
        }
        // SAFETY: bits of the register. A 1 leaves what it is at, only "complete" is cleared: RM0090, USART_SR.
        self.usart.sr().write(|w| unsafe { w.bits(0x3ff & !TC) });
        stream.cr().write(|w| {
            w.chsel().set(CHANNEL).minc().incremented();
            w.dir().memory_to_peripheral().en().enabled()
        });
        self.out.is_empty()
    }

    /// Whether all has gone out.
    pub fn is_done(&self) -> bool {
        self.out.is_empty() && !self.sends() && self.usart.sr().read().tc().bit_is_set()
    }

    /// Whether a batch is on its way.
    fn sends(&self) -> bool {
        self.dma.st(SENDS).cr().read().en().is_enabled()
    }
}
