//! The line by DMA, both ways: a long tick or a busy log loses no byte and holds none back.

use core::sync::atomic::{AtomicU8, Ordering};

use touchdown_protocol::link::Frame;

use crate::outgoing::Outgoing;

/// Of what comes: 22 ms of the line.
pub const RING_BYTES: usize = 256;
/// Of what goes at once: 5.6 ms.
const BATCH_BYTES: usize = 64;

static RING: [AtomicU8; RING_BYTES] = [const { AtomicU8::new(0) }; RING_BYTES];
static BATCH: [AtomicU8; BATCH_BYTES] = [const { AtomicU8::new(0) }; BATCH_BYTES];

/// Registers of a serial port and its DMA.
pub trait LineRegisters {
    /// Receives into [`RING_BYTES`] from this address on, round and round.
    fn receive(&mut self, ring: u32);

    /// What is left of the round.
    fn left(&self) -> u16;

    /// Sends so many bytes from this address on.
    fn transmit(&mut self, batch: u32, length: u16);

    /// Whether bytes are still on their way to the port.
    fn sends(&self) -> bool;

    /// Whether the last byte has left the port.
    fn is_through(&self) -> bool;
}

/// The line.
pub struct Line<R> {
    registers: R,
    /// Place of the next byte to be taken.
    at: usize,
    out: Outgoing,
}

impl<R: LineRegisters> Line<R> {
    /// Of a port that is up; it receives from now on.
    pub fn new(mut registers: R) -> Self {
        registers.receive(RING.as_ptr() as u32);
        Self {
            registers,
            at: 0,
            out: Outgoing::default(),
        }
    }

    /// The next byte that came.
    pub fn next(&mut self) -> Option<u8> {
        // What is left of a round counts down, and is whole again at its end.
        let end = (RING_BYTES - usize::from(self.registers.left())) % RING_BYTES;
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
        if self.out.is_empty() || self.registers.sends() {
            return self.out.is_empty();
        }
        let mut length = 0;
        for (place, byte) in BATCH.iter().zip(core::iter::from_fn(|| self.out.pop())) {
            place.store(byte, Ordering::Relaxed);
            length += 1;
        }
        // The bytes before the transfer of them.
        cortex_m::asm::dmb();
        self.registers.transmit(BATCH.as_ptr() as u32, length);
        self.out.is_empty()
    }

    /// Whether all has gone out.
    pub fn is_done(&self) -> bool {
        self.out.is_empty() && !self.registers.sends() && self.registers.is_through()
    }
}
