//! NOR flash in a file of the desktop, by semihosting: what is programmed only clears bits.

use core::ffi::CStr;

use embedded_storage::nor_flash::{
    ErrorType, MultiwriteNorFlash, NorFlash, NorFlashErrorKind, ReadNorFlash, check_erase,
    check_read, check_write,
};
use semihosting::fs::File;
use semihosting::io::{self, Read, Seek, SeekFrom, Write};
use semihosting::process::exit;

use super::{EMULATED_SLOTS, Failure};
use crate::drop_log::bytes_of;
use crate::platform::Ready;

const SECTOR_BYTES: usize = 4096;
const PAGE_BYTES: usize = 256;
const BYTES: usize = bytes_of(EMULATED_SLOTS);

pub struct NorFile(File);

impl NorFile {
    /// A file that is there, or a new one, all erased.
    pub fn open(name: &CStr) -> Option<Self> {
        let open = || File::options().read(true).write(true).open(name).ok();
        if let Some(file) = open() {
            return Some(Self(file));
        }
        drop(File::create(name).ok()?);
        let mut flash = Self(open()?);
        flash.erase(0, BYTES as u32).ok()?;
        Some(flash)
    }

    /// Acts on the file at `offset`; a file that cannot be read or written ends the run.
    fn at(&mut self, offset: u32, act: impl FnOnce(&mut File) -> io::Result<()>) {
        let there = self.0.seek(SeekFrom::Start(offset.into()));
        let done = there.and_then(|_| act(&mut self.0));
        done.unwrap_or_else(|_| exit(Failure::Log as i32));
    }
}

impl ErrorType for NorFile {
    type Error = NorFlashErrorKind;
}

impl ReadNorFlash for NorFile {
    const READ_SIZE: usize = 1;

    fn read(&mut self, offset: u32, bytes: &mut [u8]) -> Result<(), Self::Error> {
        check_read(self, offset, bytes.len())?;
        self.at(offset, |file| file.read_exact(bytes));
        Ok(())
    }

    fn capacity(&self) -> usize {
        BYTES
    }
}

impl NorFlash for NorFile {
    const WRITE_SIZE: usize = 1;
    const ERASE_SIZE: usize = SECTOR_BYTES;

    fn erase(&mut self, from: u32, to: u32) -> Result<(), Self::Error> {
        check_erase(self, from, to)?;
        for page in (from..to).step_by(PAGE_BYTES) {
            self.at(page, |file| file.write_all(&[0xff; PAGE_BYTES]));
        }
        Ok(())
    }

    fn write(&mut self, offset: u32, bytes: &[u8]) -> Result<(), Self::Error> {
        check_write(self, offset, bytes.len())?;
        for (start, piece) in (offset..).step_by(PAGE_BYTES).zip(bytes.chunks(PAGE_BYTES)) {
            let mut held = [0; PAGE_BYTES];
            let Some(held) = held.get_mut(..piece.len()) else {
                continue;
            };
            self.read(start, held)?;
            held.iter_mut()
                .zip(piece)
                .for_each(|(held, new)| *held &= new);
            self.at(start, |file| file.write_all(held));
        }
        Ok(())
    }
}

impl MultiwriteNorFlash for NorFile {}

impl Ready for NorFile {
    fn is_ready(&mut self) -> bool {
        true
    }
}
