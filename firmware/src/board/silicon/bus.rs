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

impl<R: SpiRegisters> SpiDevice for Bus<R> {
    fn transaction(&mut self, operations: &mut [Operation<'_, u8>]) -> Result<(), Infallible> {
        let registers = &mut self.0;
        registers.select(true);
        for operation in operations {
            match operation {
                Operation::Read(bytes) => {
                    bytes.iter_mut().for_each(|it| *it = registers.exchange(0));
                }
                Operation::Write(bytes) => bytes.iter().for_each(|it| {
                    registers.exchange(*it);
                }),
                Operation::Transfer(into, from) => {
                    let mut from = from.iter();
                    for place in into.iter_mut() {
                        *place = registers.exchange(from.next().copied().unwrap_or(0));
                    }
                    from.for_each(|it| {
                        registers.exchange(*it);
                    });
                }
                Operation::TransferInPlace(bytes) => {
                    bytes
                        .iter_mut()
                        .for_each(|it| *it = registers.exchange(*it));
                }
                Operation::DelayNs(time) => R::Wait::default().delay_ns(*time),
            }
        }
        registers.select(false);
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
