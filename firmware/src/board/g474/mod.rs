//! STM32G474RE: sampled by an AD7606 on SPI, 20 000 times a second. Compiled; nobody has run it.
//!
//! The fall of BUSY is the highest interrupt: it reads the sample into the ring, and the guard on top may drop the outputs.
//! Ticks run in PendSV below it, and the main loop below that.

mod clocks;
mod converter;
mod inputs;
mod line;
mod outputs;
mod remote;
mod spi;

use defmt::info;
use stm32g4::stm32g474::{FLASH, Interrupt, Peripherals};
use touchdown_protocol::config_block::Settings;

use self::converter::ExternalConverter;
use self::inputs::TimerInputs;
use self::line::ChannelPort;
use self::outputs::{IndependentWatchdog, OutputPort};
pub use self::remote::G474;
use super::chip_platform::ChipPlatform;
use super::default_settings;
use super::line::Line;
use super::silicon::{self, Chip as _};
use crate::journal;
use crate::main_loop::MainLoop;
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
pub fn start(memory: &'static mut Memory) -> Option<(MainLoop, ChipPlatform<G474>)> {
    let (Some(mut core), Some(chip)) = (cortex_m::Peripherals::take(), Peripherals::take()) else {
        unreachable!("main runs once");
    };
    let rcc = &chip.RCC;
    let pins = OutputPort::new(chip.GPIOC, rcc);
    info!("touchdown {=str} on stm32g474", env!("CARGO_PKG_VERSION"));
    clocks::start(rcc, &chip.FLASH, &chip.PWR);
    // Since power was applied, or an order to clear was obeyed.
    let has_bitten = rcc.csr().read().iwdgrstf().bit_is_set();
    let (block, settings, found) =
        silicon::check::<FLASH>(fallback(), &G474::ABILITIES, has_bitten);
    journal::config(&settings.monitor);
    let converter = ExternalConverter::try_new(
        spi::converter(chip.SPI1, &chip.GPIOA, rcc),
        (chip.TIM2, chip.TIM3),
        (&chip.GPIOA, &chip.GPIOB),
        (chip.EXTI, &chip.SYSCFG),
        rcc,
    )?;
    let bus = spi::flash(chip.SPI3, &chip.GPIOA, &chip.GPIOB, rcc);
    let log = silicon::mount::<G474>(bus);
    let line = Line::new(ChannelPort::new(
        chip.USART1,
        chip.DMA1,
        &chip.DMAMUX,
        &chip.GPIOA,
        rcc,
    ));
    let watchdog = IndependentWatchdog::new(chip.IWDG, chip.DBGMCU);
    let tasks = G474::tasks();
    let found = (block, &settings, found);
    let (intake, below) = tasks.start_tick(memory, found, (pins, watchdog), log.as_ref())?;
    converter.start();
    let inputs = TimerInputs::wired(&settings, chip.GPIOB, chip.TIM4, rcc);
    tasks.start_sampling(&mut core, Interrupt::EXTI0, converter, inputs, intake);
    let below_tick = G474::new(chip.FLASH, chip.RCC, chip.RNG);
    Some((below, ChipPlatform::new(below_tick, line, log)))
}
