//! Where the configuration is stored: the last sector of the flash, 128 Kbytes, of which an erase takes 2 s.

use stm32f4::stm32f405::FLASH;

use crate::board::slots::ConfigFlash;

impl ConfigFlash for FLASH {
    // Sector 11: RM0090, flash module organization. memory.x leaves it out.
    const START: usize = 0x080e_0000;
    const BYTES: usize = 128 * 1024;

    fn unlock(&self) {
        // RM0090, unlocking the flash control register.
        for key in [0x4567_0123, 0xcdef_89ab] {
            self.keyr().write(|w| w.key().set(key));
        }
    }

    fn program(&self, address: usize, bytes: [u8; 8]) {
        for (index, word) in bytes.as_chunks().0.iter().enumerate() {
            // One word at a time, 16 us.
            self.cr().write(|w| w.pg().set_bit().psize().psize32());
            // SAFETY: an erased word of this sector, aligned, programming enabled.
            unsafe {
                ((address + 4 * index) as *mut u32).write_volatile(u32::from_le_bytes(*word))
            };
            while self.sr().read().bsy().bit_is_set() {}
        }
    }

    fn lock(&self) {
        self.cr().write(|w| w.lock().set_bit());
    }
}
