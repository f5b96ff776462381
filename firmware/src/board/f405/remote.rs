//! What the main loop has of the chip.

use stm32f4::stm32f405::{FLASH, RCC, RNG};
use touchdown_protocol::link::Refusal;

use super::chip::Spi1;
use super::clocks::CORE_HZ;
use super::converter::Converter;
use super::inputs::PinInputs;
use super::line::Port;
use super::outputs::{IndependentWatchdog, OutputPins};
use crate::board::silicon::{Chip, ChipTasks};
use crate::board::slots::{self, ConfigFlash};

/// Looks at the noise source, far more than a word takes.
const WORD_POLLS: u32 = 1_000;

/// The stored configuration, the noise source and what tells why it was reset.
pub struct F405 {
    flash: FLASH,
    rcc: RCC,
    random: RNG,
}

impl F405 {
    /// Starts the noise source.
    pub fn new(flash: FLASH, rcc: RCC, random: RNG) -> Self {
        rcc.ahb2enr().modify(|_, w| w.rngen().enabled());
        random.cr().write(|w| w.rngen().enabled());
        Self { flash, rcc, random }
    }
}

impl Chip for F405 {
    type Pins = OutputPins;
    type Watchdog = IndependentWatchdog;
    type Source = Converter;
    type Inputs = PinInputs;
    type Spi = Spi1;
    type Port = Port;
    const MHZ: u32 = CORE_HZ / 1_000_000;
    const FULL_SCALE: u16 = 4_095;

    fn tasks() -> &'static ChipTasks<Self> {
        static TASKS: ChipTasks<F405> = ChipTasks::empty();
        &TASKS
    }

    // RM0090, random number generator. It takes 40 of its cycles.
    fn word(&self) -> Option<u32> {
        let is_ready = || self.random.sr().read().drdy().bit_is_set();
        let came = (0..WORD_POLLS).any(|_| is_ready());
        let status = self.random.sr().read();
        let failed = status.secs().bit_is_set() || status.cecs().bit_is_set();
        (came && !failed).then(|| self.random.dr().read().bits())
    }

    fn store(&self, block: &[u8]) -> Result<(), Refusal> {
        slots::store(&self.flash, block)
    }

    fn forget_reset(&self) {
        self.rcc.csr().modify(|_, w| w.rmvf().set_bit());
    }
}

impl ConfigFlash for FLASH {
    // Sector 11, 128 Kbytes, of which an erase takes 2 s: RM0090, flash module organization. memory.x leaves it out.
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
