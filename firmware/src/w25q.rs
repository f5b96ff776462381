//! Winbond W25Q serial NOR flash up to 16 MiB, over SPI.
//!
//! A program or erase is started, not waited for: the next command waits. So a task that asks
//! [`W25q::is_busy`] first never waits at all. Commands and times: Winbond data sheet W25Q64JV,
//! instruction set table and AC electrical characteristics; its smaller and larger sisters have the same.

use embedded_hal::delay::DelayNs;
use embedded_hal::spi::{Operation, SpiDevice};
use embedded_storage::nor_flash::{
    ErrorType, MultiwriteNorFlash, NorFlash, NorFlashError, NorFlashErrorKind, ReadNorFlash,
    check_erase, check_read, check_write,
};

use crate::platform::Ready;

const WRITE_ENABLE: u8 = 0x06;
const PAGE_PROGRAM: u8 = 0x02;
const READ_DATA: u8 = 0x03;
const SECTOR_ERASE: u8 = 0x20;
const READ_STATUS: u8 = 0x05;
const READ_ID: u8 = 0x9f;

const BUSY: u8 = 1 << 0;
const WRITE_ENABLED: u8 = 1 << 1;

const WINBOND: u8 = 0xef;
/// Capacity codes, the logarithm of the bytes: 1 MiB to 16 MiB, which three address bytes reach.
const CAPACITIES: core::ops::RangeInclusive<u8> = 0x14..=0x18;

const PAGE_BYTES: usize = 256;
const SECTOR_BYTES: u32 = 4096;

/// Between two looks at the status, us.
const POLL: u32 = 100;
/// Longest erase of a sector, 400 ms, and a quarter more, in looks. A program takes 3 ms at most.
const POLLS: u32 = 5_000;

/// What can go wrong.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Error<E> {
    /// Of the bus.
    Spi(E),
    /// Another part, or none: maker, type, capacity as read.
    Part([u8; 3]),
    /// Busy for longer than it ever is.
    Busy,
    /// It refuses to be written.
    Protected,
    /// Address or length.
    Range(NorFlashErrorKind),
}

impl<E: core::fmt::Debug> NorFlashError for Error<E> {
    fn kind(&self) -> NorFlashErrorKind {
        match *self {
            Self::Range(kind) => kind,
            _ => NorFlashErrorKind::Other,
        }
    }
}

/// The flash on its chip select.
pub struct W25q<S, D> {
    spi: S,
    delay: D,
    capacity: usize,
}

impl<S: SpiDevice, D: DelayNs> W25q<S, D> {
    /// Asks what it is. SPI mode 0 or 3, at most 50 MHz, 5 ms or more after power-on.
    pub fn try_new(spi: S, delay: D) -> Result<Self, Error<S::Error>> {
        let mut flash = Self {
            spi,
            delay,
            capacity: 0,
        };
        // A reset of the microcontroller alone may come in the middle of an erase.
        flash.wait()?;
        let mut id = [0; 3];
        flash.command(&mut [Operation::Write(&[READ_ID]), Operation::Read(&mut id)])?;
        let [maker, _, capacity] = id;
        if maker != WINBOND || !CAPACITIES.contains(&capacity) {
            return Err(Error::Part(id));
        }
        flash.capacity = 1 << capacity;
        Ok(flash)
    }

    /// Whether it still programs or erases.
    pub fn is_busy(&mut self) -> Result<bool, Error<S::Error>> {
        Ok(self.status()? & BUSY != 0)
    }

    fn command(&mut self, operations: &mut [Operation<'_, u8>]) -> Result<(), Error<S::Error>> {
        self.spi.transaction(operations).map_err(Error::Spi)
    }

    fn status(&mut self) -> Result<u8, Error<S::Error>> {
        let mut status = [0];
        self.command(&mut [
            Operation::Write(&[READ_STATUS]),
            Operation::Read(&mut status),
        ])?;
        Ok(status[0])
    }

    fn wait(&mut self) -> Result<(), Error<S::Error>> {
        for _ in 0..POLLS {
            if !self.is_busy()? {
                return Ok(());
            }
            self.delay.delay_us(POLL);
        }
        Err(Error::Busy)
    }

    /// Waits for the last change and allows the next one.
    fn enable(&mut self) -> Result<(), Error<S::Error>> {
        self.wait()?;
        self.command(&mut [Operation::Write(&[WRITE_ENABLE])])?;
        if self.status()? & WRITE_ENABLED == 0 {
            return Err(Error::Protected);
        }
        Ok(())
    }
}

/// A command with the three bytes of an address.
fn addressed(command: u8, address: u32) -> [u8; 4] {
    let [_, high, middle, low] = address.to_be_bytes();
    [command, high, middle, low]
}

impl<S: SpiDevice, D> ErrorType for W25q<S, D> {
    type Error = Error<S::Error>;
}

impl<S: SpiDevice, D: DelayNs> ReadNorFlash for W25q<S, D> {
    const READ_SIZE: usize = 1;

    fn read(&mut self, offset: u32, bytes: &mut [u8]) -> Result<(), Self::Error> {
        check_read(self, offset, bytes.len()).map_err(Error::Range)?;
        self.wait()?;
        self.command(&mut [
            Operation::Write(&addressed(READ_DATA, offset)),
            Operation::Read(bytes),
        ])
    }

    fn capacity(&self) -> usize {
        self.capacity
    }
}

impl<S: SpiDevice, D: DelayNs> NorFlash for W25q<S, D> {
    const WRITE_SIZE: usize = 1;
    const ERASE_SIZE: usize = SECTOR_BYTES as usize;

    fn erase(&mut self, from: u32, to: u32) -> Result<(), Self::Error> {
        check_erase(self, from, to).map_err(Error::Range)?;
        for sector in (from..to).step_by(SECTOR_BYTES as usize) {
            self.enable()?;
            self.command(&mut [Operation::Write(&addressed(SECTOR_ERASE, sector))])?;
        }
        Ok(())
    }

    fn write(&mut self, offset: u32, bytes: &[u8]) -> Result<(), Self::Error> {
        check_write(self, offset, bytes.len()).map_err(Error::Range)?;
        let (mut offset, mut rest) = (offset, bytes);
        while !rest.is_empty() {
            // Beyond the end of its page the chip would go on at the beginning of it.
            let room = PAGE_BYTES - offset as usize % PAGE_BYTES;
            let (page, after) = rest.split_at(room.min(rest.len()));
            self.enable()?;
            self.command(&mut [
                Operation::Write(&addressed(PAGE_PROGRAM, offset)),
                Operation::Write(page),
            ])?;
            offset += page.len() as u32;
            rest = after;
        }
        Ok(())
    }
}

impl<S: SpiDevice, D: DelayNs> MultiwriteNorFlash for W25q<S, D> {}

impl<S: SpiDevice, D: DelayNs> Ready for W25q<S, D> {
    fn is_ready(&mut self) -> bool {
        matches!(self.is_busy(), Ok(false))
    }
}
