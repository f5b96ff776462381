//! What the main loop has of the chip.

use stm32g4::stm32g474::{FLASH, RCC, RNG};
use touchdown_protocol::link::Refusal;

use super::clocks::CORE_HZ;
use super::converter::ExternalConverter;
use super::inputs::TimerInputs;
use super::line::ChannelPort;
use super::outputs::{IndependentWatchdog, OutputPort};
use super::spi::SelectedSpi;
use crate::board::silicon::{Chip, ChipTasks};
use crate::board::slots::{self, ConfigFlash};

/// Looks at the noise source, far more than a word takes.
const WORD_POLLS: u32 = 10_000;
/// RM0440, FLASH_SR: what went wrong before, cleared by writing it.
const ERRORS: u32 = 0xc3fa;

/// The stored configuration, the noise source and what tells why it was reset.
pub struct G474 {
    flash: FLASH,
    rcc: RCC,
    random: RNG,
}

impl G474 {
    /// Starts the noise source, by the clock of 48 MHz that is its own after reset.
    pub fn new(flash: FLASH, rcc: RCC, random: RNG) -> Self {
        rcc.crrcr().modify(|_, w| w.hsi48on().set_bit());
        rcc.ahb2enr().modify(|_, w| w.rngen().set_bit());
        random.cr().write(|w| w.rngen().set_bit());
        Self { flash, rcc, random }
    }
}

impl Chip for G474 {
    type Pins = OutputPort;
    type Watchdog = IndependentWatchdog;
    type Source = ExternalConverter;
    type Inputs = TimerInputs;
    type Spi = SelectedSpi;
    type Port = ChannelPort;
    const MHZ: u32 = CORE_HZ / 1_000_000;
    const FULL_SCALE: u16 = 65_535;

    fn tasks() -> &'static ChipTasks<Self> {
        static TASKS: ChipTasks<G474> = ChipTasks::empty();
        &TASKS
    }

    // RM0440, random number generator.
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
    // The last eight pages of 2 Kbytes: RM0440, flash module organization of two banks. memory.x leaves them out.
    const START: usize = 0x0807_c000;
    const BYTES: usize = 16 * 1024;

    fn unlock(&self) {
        // RM0440, unlocking the flash control register.
        for key in [0x4567_0123, 0xcdef_89ab] {
            // SAFETY: the keys.
            self.keyr().write(|w| unsafe { w.bits(key) });
        }
    }

    fn program(&self, address: usize, bytes: [u8; 8]) {
        // SAFETY: bits of the register, as above.
        self.sr().write(|w| unsafe { w.bits(ERRORS) });
        self.cr().modify(|_, w| w.pg().set_bit());
        // A double word, first half first: RM0440, standard programming.
        for (index, word) in bytes.as_chunks().0.iter().enumerate() {
            // SAFETY: erased words of these pages, aligned, programming enabled.
            unsafe {
                ((address + 4 * index) as *mut u32).write_volatile(u32::from_le_bytes(*word))
            };
        }
        while self.sr().read().bsy().bit_is_set() {}
        self.cr().modify(|_, w| w.pg().clear_bit());
    }

    fn lock(&self) {
        self.cr().modify(|_, w| w.lock().set_bit());
    }
}
