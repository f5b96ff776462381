//! STM32G474RE: sampled by an AD7606 on SPI, 20 000 times a second. Compiled; nobody has run it.
//!
//! The fall of BUSY is the highest interrupt: it reads the sample into the ring, and the guard on top may drop the outputs.
//! Ticks run in PendSV below it, and the main loop below that.

mod clocks;
mod converter;
mod inputs;
mod line;
mod outputs;
mod spi;

use defmt::info;
use stm32g4::stm32g474::{FLASH, Interrupt, Peripherals, RCC, RNG};
use touchdown_protocol::config_block::Settings;

use self::clocks::CORE_HZ;
use self::converter::ExternalConverter;
use self::inputs::TimerInputs;
use self::line::ChannelPort;
use self::outputs::OutputPort;
use self::spi::SelectedSpi;
use super::default_settings;
use super::silicon::{self, Chip, ChipParts, ChipPlatform, ChipTasks, ConfigFlash, Line, Started};
use crate::memory::Memory;

/// The rig by 16 bit over +-1000 um, where nothing is stored: there is never current.
fn fallback() -> Settings {
    let mut settings = default_settings();
    let sensing = &mut settings.monitor.sensing;
    (sensing.resolution, sensing.zero_count) = (2_000e-6 / 65_536.0, 32_768.0);
    sensing.full_scale = G474::FULL_SCALE;
    settings
}

/// Brings everything up, for [`silicon::run`]. A frame of its own: what is put in its place here is gone from the stack before
/// the first interrupt.
#[inline(never)]
pub fn start(memory: &'static mut Memory) -> Started<G474> {
    let (Some(core), Some(chip)) = (cortex_m::Peripherals::take(), Peripherals::take()) else {
        unreachable!("main runs once");
    };
    let rcc = &chip.RCC;
    let outputs = OutputPort::new(chip.GPIOC, chip.IWDG, chip.DBGMCU, rcc);
    info!("touchdown {=str} on stm32g474", env!("CARGO_PKG_VERSION"));
    clocks::start(rcc, &chip.FLASH, &chip.PWR);
    // Since power was applied, or an order to clear was obeyed.
    let has_bitten = rcc.csr().read().iwdgrstf().bit_is_set();
    let found = silicon::check::<G474>(fallback(), has_bitten);
    let pins = (&chip.GPIOA, &chip.GPIOB);
    let (timers, edges) = ((chip.TIM2, chip.TIM3), (chip.EXTI, &chip.SYSCFG));
    let bus = spi::converter(chip.SPI1, pins.0, rcc);
    let source = ExternalConverter::try_new(bus, timers, pins, edges, rcc)?;
    let bus = spi::flash(chip.SPI3, pins, rcc);
    let port = ChannelPort::new(chip.USART1, chip.DMA1, &chip.DMAMUX, &chip.GPIOA, rcc);
    let parts = ChipParts {
        outputs,
        source,
        inputs: TimerInputs::wired(&found.1, chip.GPIOB, chip.TIM4, rcc),
        platform: ChipPlatform {
            line: Line::new(port),
            log: silicon::mount::<G474>(bus),
            chip: G474::new(chip.FLASH, chip.RCC, chip.RNG),
        },
    };
    parts.start(memory, found, core, Interrupt::EXTI0)
}

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
    type Outputs = OutputPort;
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

    fn forget_reset(&self) {
        self.rcc.csr().modify(|_, w| w.rmvf().set_bit());
    }
}

impl ConfigFlash for G474 {
    // The last eight pages of 2 Kbytes: RM0440, flash module organization of two banks. memory.x leaves them out.
    const START: usize = 0x0807_c000;
    const BYTES: usize = 16 * 1024;

    fn program(&self, address: usize, bytes: [u8; 8]) {
        // RM0440, unlocking the flash control register.
        for key in [0x4567_0123, 0xcdef_89ab] {
            // SAFETY: the keys.
            self.flash.keyr().write(|w| unsafe { w.bits(key) });
        }
        // SAFETY: bits of the register, as above.
        self.flash.sr().write(|w| unsafe { w.bits(ERRORS) });
        self.flash.cr().modify(|_, w| w.pg().set_bit());
        // A double word, first half first: RM0440, standard programming.
        for (index, word) in bytes.as_chunks().0.iter().enumerate() {
            // SAFETY: erased words of these pages, aligned, programming enabled.
            unsafe {
                ((address + 4 * index) as *mut u32).write_volatile(u32::from_le_bytes(*word))
            };
        }
        while self.flash.sr().read().bsy().bit_is_set() {}
        self.flash.cr().modify(|_, w| w.pg().clear_bit());
        self.flash.cr().modify(|_, w| w.lock().set_bit());
    }
}
