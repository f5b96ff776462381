//! STM32F405: sampled by its own converters, 20 000 times a second.
//!
//! The converters' interrupt is the highest: it puts samples into the ring, and the guard on top may drop the outputs.
//! Ticks run in PendSV below it, and the main loop below that.

mod chip;
mod clocks;
mod converter;
mod inputs;
mod line;
mod outputs;

use defmt::info;
use stm32f4::stm32f405::{FLASH, Interrupt, Peripherals, RCC, RNG};
use touchdown_protocol::controller::Outputs;

use self::chip::Spi1;
use self::clocks::CORE_HZ;
use self::converter::Converter;
use self::inputs::PinInputs;
use self::line::Port;
use self::outputs::OutputPins;
use super::default_settings;
use super::silicon::{self, Bus, Chip, ChipParts, ChipPlatform, ChipTasks, ConfigFlash, Line};
use super::silicon::{OutputRegisters as _, Started, record};
use crate::crash::Crash;
use crate::memory::Memory;

/// Brings everything up, for [`silicon::run`]. A frame of its own: what is put in its place here is gone from the stack before
/// the first interrupt.
#[inline(never)]
pub fn start(memory: &'static mut Memory) -> Started<F405> {
    let (Some(core), Some(chip)) = (cortex_m::Peripherals::take(), Peripherals::take()) else {
        unreachable!("main runs once");
    };
    let rcc = &chip.RCC;
    let outputs = OutputPins::new(chip.GPIOC, chip.IWDG, chip.DBGMCU, rcc);
    info!("touchdown {=str} on stm32f405", env!("CARGO_PKG_VERSION"));
    clocks::start(rcc, &chip.FLASH);
    // Since power was applied, or an order to clear was obeyed.
    let has_bitten = rcc.csr().read().wdgrstf().bit_is_set();
    let found = silicon::check::<F405>(default_settings(), has_bitten);
    let converters = (chip.ADC1, chip.ADC2, &chip.ADC_COMMON);
    let source = Converter::new(converters, (chip.TIM2, chip.TIM3), &chip.GPIOA, rcc);
    let port = Port::new(chip.USART1, chip.DMA2, &chip.GPIOB, rcc);
    let spi = Spi1::new(chip.SPI1, chip.GPIOA, &chip.GPIOB, rcc);
    let parts = ChipParts {
        outputs,
        source,
        inputs: PinInputs::wired(&found.1, chip.GPIOB, chip.TIM4, rcc),
        platform: ChipPlatform {
            line: Line::new(port),
            log: silicon::mount::<F405>(Bus(spi)),
            chip: F405::new(chip.FLASH, chip.RCC, chip.RNG),
        },
    };
    parts.start(memory, found, core, Interrupt::ADC)
}

/// The outputs' pins and the watchdog alone, as [`start`] sets them up: for the image that stops on purpose.
/// What the program before this one left, if it crashed; it is cleared.
pub fn rehearse() -> Option<Crash> {
    let left = record::read();
    record::clear();
    if let Some(chip) = Peripherals::take() {
        let outputs = OutputPins::new(chip.GPIOC, chip.IWDG, chip.DBGMCU, &chip.RCC);
        OutputPins::drive(Outputs {
            run: true,
            no_brake: true,
            permit: false,
            ready: true,
        });
        outputs.start_watchdog();
    }
    left
}

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
    type Outputs = OutputPins;
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

    fn forget_reset(&self) {
        self.rcc.csr().modify(|_, w| w.rmvf().set_bit());
    }
}

impl ConfigFlash for F405 {
    // Sector 11, 128 Kbytes, of which an erase takes 2 s: RM0090, flash module organization. memory.x leaves it out.
    const START: usize = 0x080e_0000;
    const BYTES: usize = 128 * 1024;

    fn program(&self, address: usize, bytes: [u8; 8]) {
        // RM0090, unlocking the flash control register.
        for key in [0x4567_0123, 0xcdef_89ab] {
            self.flash.keyr().write(|w| w.key().set(key));
        }
        for (index, word) in bytes.as_chunks().0.iter().enumerate() {
            // One word at a time, 16 us.
            self.flash
                .cr()
                .write(|w| w.pg().set_bit().psize().psize32());
            // SAFETY: an erased word of this sector, aligned, programming enabled.
            unsafe {
                ((address + 4 * index) as *mut u32).write_volatile(u32::from_le_bytes(*word))
            };
            while self.flash.sr().read().bsy().bit_is_set() {}
        }
        self.flash.cr().write(|w| w.lock().set_bit());
    }
}
