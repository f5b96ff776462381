//! A device on an SPI bus of its own, polled.

use core::convert::Infallible;

use embedded_hal::delay::DelayNs;
use embedded_hal::spi::{ErrorType, Operation, SpiDevice};

/// Registers of an SPI with a device on it.
pub trait SpiRegisters {
    /// Waits.
    type Wait: DelayNs + Default;

    /// Selects the device, or lets it go once the bus is idle.
    fn select(&mut self, is_on: bool);

    /// Sends a byte; the one that comes meanwhile.
    fn exchange(&mut self, byte: u8) -> u8;
}

/// The device.
pub struct Bus<R>(pub R);

impl<R> ErrorType for Bus<R> {
    type Error = Infallible;
}

impl<R: SpiRegisters> Bus<R> {
    /// Sends bytes, then zeros, and takes what comes meanwhile, as far as there is room.
    fn exchange(&mut self, into: &mut [u8], from: &[u8]) {
        for at in 0..into.len().max(from.len()) {
            let byte = self.0.exchange(from.get(at).copied().unwrap_or(0));
            if let Some(place) = into.get_mut(at) {
                *place = byte;
            }
        }
    }
}

impl<R: SpiRegisters> SpiDevice for Bus<R> {
    fn transaction(&mut self, operations: &mut [Operation<'_, u8>]) -> Result<(), Infallible> {
        self.0.select(true);
        for operation in operations {
            match operation {
                Operation::Read(into) => self.exchange(into, &[]),
                Operation::Write(from) => self.exchange(&mut [], from),
                Operation::Transfer(into, from) => self.exchange(into, from),
                Operation::TransferInPlace(bytes) => {
                    bytes.iter_mut().for_each(|it| *it = self.0.exchange(*it));
                }
                Operation::DelayNs(time) => R::Wait::default().delay_ns(*time),
            }
        }
        self.0.select(false);
        Ok(())
    }
}

/// Waits by counting cycles of a core at so many MHz.
#[derive(Default)]
pub struct CycleDelay<const MHZ: u32>;

impl<const MHZ: u32> DelayNs for CycleDelay<MHZ> {
    fn delay_ns(&mut self, time: u32) {
        let rest = (MHZ * (time % 1_000)).div_ceil(1_000);
        cortex_m::asm::delay(MHZ * (time / 1_000) + rest);
    }
}
