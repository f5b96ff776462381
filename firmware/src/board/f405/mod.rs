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
mod remote;

use defmt::info;
use stm32f4::stm32f405::{FLASH, Interrupt, Peripherals};
use touchdown_protocol::controller::Outputs;

use self::chip::Spi1;
use self::converter::Converter;
use self::inputs::PinInputs;
use self::line::Port;
use self::outputs::{IndependentWatchdog, OutputPins};
pub use self::remote::F405;
use super::bus::Bus;
use super::chip_platform::ChipPlatform;
use super::line::Line;
use super::silicon::{self, Chip as _, OutputRegisters as _, Watchdog as _};
use super::{default_settings, record};
use crate::crash::Crash;
use crate::journal;
use crate::main_loop::MainLoop;
use crate::memory::Memory;

/// Brings everything up, for [`silicon::run`]. A frame of its own: what is put in its place here is gone from the stack before
/// the first interrupt.
#[inline(never)]
pub fn start(memory: &'static mut Memory) -> Option<(MainLoop, ChipPlatform<F405>)> {
    let (Some(mut core), Some(chip)) = (cortex_m::Peripherals::take(), Peripherals::take()) else {
        unreachable!("main runs once");
    };
    let rcc = &chip.RCC;
    let pins = OutputPins::new(chip.GPIOC, rcc);
    info!("touchdown {=str} on stm32f405", env!("CARGO_PKG_VERSION"));
    clocks::start(rcc, &chip.FLASH);
    // Since power was applied, or an order to clear was obeyed.
    let has_bitten = rcc.csr().read().wdgrstf().bit_is_set();
    let (block, settings, found) =
        silicon::check::<FLASH>(default_settings(), &F405::ABILITIES, has_bitten);
    journal::config(&settings.monitor);
    let converter = Converter::new(
        (chip.ADC1, chip.ADC2),
        &chip.ADC_COMMON,
        chip.TIM2,
        chip.TIM3,
        &chip.GPIOA,
        rcc,
    );
    let line = Line::new(Port::new(chip.USART1, chip.DMA2, &chip.GPIOB, rcc));
    let spi = Spi1::new(chip.SPI1, chip.GPIOA, &chip.GPIOB, rcc);
    let log = silicon::mount::<F405>(Bus(spi));
    let watchdog = IndependentWatchdog::new(chip.IWDG, chip.DBGMCU);
    let tasks = F405::tasks();
    let found = (block, &settings, found);
    let (intake, below) = tasks.start_tick(memory, found, (pins, watchdog), log.as_ref())?;
    converter.start();
    let inputs = PinInputs::wired(&settings, chip.GPIOB, chip.TIM4, rcc);
    tasks.start_sampling(&mut core, Interrupt::ADC, converter, inputs, intake);
    let below_tick = F405::new(chip.FLASH, chip.RCC, chip.RNG);
    Some((below, ChipPlatform::new(below_tick, line, log)))
}

/// The outputs' pins and the watchdog alone, as [`start`] sets them up: for the image that stops on purpose.
/// What the program before this one left, if it crashed; it is cleared.
pub fn rehearse() -> Option<Crash> {
    let left = record::read();
    record::clear();
    if let Some(chip) = Peripherals::take() {
        OutputPins::new(chip.GPIOC, &chip.RCC).drive(Outputs {
            run: true,
            no_brake: true,
            permit: false,
            ready: true,
        });
        IndependentWatchdog::new(chip.IWDG, chip.DBGMCU).start();
    }
    left
}
