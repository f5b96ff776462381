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

use core::panic::PanicInfo;
use core::sync::atomic::{AtomicU32, Ordering};

use cortex_m::peripheral::{DWT, SCB};
use defmt::{error, info};
use embedded_hal::delay::DelayNs;
use stm32g4::stm32g474::{FLASH, Interrupt, NVIC, Peripherals, RCC};
use touchdown_core::event::Notice;
use touchdown_protocol::config_block::Settings;
use touchdown_protocol::controller::{Faults, Shown};
use touchdown_rotor::error::ConfigError;

use self::converter::ExternalConverter;
use self::inputs::TimerInputs;
use self::line::ChannelPort;
use self::outputs::{IndependentWatchdog, OutputPort};
use self::remote::G474;
use self::spi::{SelectedSpi, Wait};
use super::bus::Bus;
use super::chip_platform::{ChipPlatform, Sampling};
use super::held::{self, Held};
use super::line::Line;
use super::slots::ConfigFlash;
use super::{Abilities, Board, SAMPLE_RATE_HZ, default_settings, image, record, slots};
use crate::drop_log::DropLog;
use crate::journal;
use crate::main_loop::MainLoop;
use crate::memory::{self, Memory};
use crate::power_on::{InForce, PowerOn};
use crate::recorder::Identity;
use crate::tick::TickTask;
use crate::w25q::W25q;

/// The drop log in a W25Q of 2 MiB.
type ChipLog = DropLog<W25q<Bus<SelectedSpi>, Wait>, LOG_SLOTS>;
const LOG_SLOTS: usize = 42;

/// 16 bit; no pin takes the pulses of ring and cage.
const ABILITIES: Abilities = Abilities {
    sample_rate: SAMPLE_RATE_HZ as f32,
    full_scale: 65_535,
    tachometers: false,
};

static SAMPLING: Held<Sampling<ExternalConverter, TimerInputs>> = Held::new();
static TICK: Held<TickTask<'static, Nucleo>> = Held::new();
/// Cycle counter at the last sample.
static SAMPLED: AtomicU32 = AtomicU32::new(0);

/// What the tick has of the chip.
pub struct Nucleo {
    pins: OutputPort,
    watchdog: IndependentWatchdog,
    block: InForce,
}

impl Board for Nucleo {
    fn report(&mut self, _: &Notice) {}

    fn drive(&mut self, shown: Shown) {
        self.pins.drive(shown.outputs);
    }

    fn config(&self) -> &[u8] {
        self.block.bytes()
    }

    fn feed(&mut self) {
        self.watchdog.feed();
    }
}

/// BUSY fell: the converter has a sample.
pub fn on_converted() {
    SAMPLED.store(DWT::cycle_count(), Ordering::Relaxed);
    if SAMPLING.with(Sampling::take) == Some(true) {
        OutputPort::drop_now();
    }
    SCB::set_pendsv();
}

/// PendSV: samples wait.
pub fn on_waiting() {
    while TICK.with(TickTask::step) == Some(true) {}
}

/// Starts sampling, and the main loop.
pub fn main(memory: &'static mut Memory) -> ! {
    if let Some((mut below, mut chip)) = start(memory) {
        below.run(&mut chip);
    }
    // With the outputs without current there is nothing left to do.
    loop {
        cortex_m::asm::wfi();
    }
}

/// The rig by 16 bit over +-1000 um, where nothing is stored: there is never current.
fn fallback() -> Settings {
    let mut settings = default_settings();
    let sensing = &mut settings.monitor.sensing;
    (sensing.resolution, sensing.zero_count) = (2_000e-6 / 65_536.0, 32_768.0);
    sensing.full_scale = ABILITIES.full_scale;
    settings
}

/// Brings everything up. A frame of its own: what is put in its place here is gone from the stack before
/// the first interrupt.
#[inline(never)]
fn start(memory: &'static mut Memory) -> Option<(MainLoop, ChipPlatform<G474>)> {
    let (Some(mut core), Some(chip)) = (cortex_m::Peripherals::take(), Peripherals::take()) else {
        unreachable!("main runs once");
    };
    let rcc = &chip.RCC;
    let pins = OutputPort::new(chip.GPIOC, rcc);
    info!("touchdown {=str} on stm32g474", env!("CARGO_PKG_VERSION"));
    clocks::start(rcc, &chip.FLASH, &chip.PWR);
    let (block, settings, found) = check(rcc);
    journal::config(&settings.monitor);
    core.DCB.enable_trace();
    core.DWT.enable_cycle_counter();
    let converter = ExternalConverter::try_new(
        spi::converter(chip.SPI1, &chip.GPIOA, rcc),
        (chip.TIM2, chip.TIM3),
        (&chip.GPIOA, &chip.GPIOB),
        (chip.EXTI, &chip.SYSCFG),
        rcc,
    )
    .ok()?;
    let log = mount(spi::flash(chip.SPI3, &chip.GPIOA, &chip.GPIOB, rcc));
    let line = Line::new(ChannelPort::new(
        chip.USART1,
        chip.DMA1,
        &chip.DMAMUX,
        &chip.GPIOA,
        rcc,
    ));
    let boot = log.as_ref().map_or(0, DropLog::boot);
    let identity = Identity::new(&block.told(&settings), boot);
    let board = Nucleo {
        pins,
        watchdog: IndependentWatchdog::new(chip.IWDG),
        block,
    };
    let refused = |refusal: &ConfigError| error!("config: {=str}", refusal.parameter());
    let filled = memory.fill(&settings.monitor, found, identity, board);
    let (intake, tick) = filled.inspect_err(refused).ok()?;
    tick.app.recall(log.as_ref().and_then(DropLog::uncleared));
    let forecast = memory::forecast_task(&settings.monitor)
        .inspect_err(refused)
        .ok()?;
    tick.desk.board.watchdog.start(&chip.DBGMCU);
    TICK.put(tick);
    converter.start();
    let inputs = TimerInputs::new(chip.GPIOB, chip.TIM4, rcc, &settings);
    SAMPLING.put(Sampling::new(converter, inputs, intake));
    held::set_tick_priority(&mut core.SCB);
    unmask(&mut core.NVIC);
    let below = MainLoop::new(settings.key, SAMPLE_RATE_HZ as f32, forecast);
    let below_tick = G474::new(chip.FLASH, chip.RCC, chip.RNG);
    Some((below, ChipPlatform::new(below_tick, line, log)))
}

/// What is stored, and what was wrong.
fn check(rcc: &RCC) -> (InForce, Settings, Faults) {
    let found = PowerOn {
        stored: slots::load::<FLASH>(),
        fallback: fallback(),
        is_configured: false,
        is_whole: image::is_whole(FLASH::START),
        crash: record::read(),
        has_bitten: IndependentWatchdog::has_bitten(rcc),
    };
    found.check(&ABILITIES)
}

/// Lets samples come: what the handlers need is in place.
fn unmask(interrupts: &mut NVIC) {
    // SAFETY: it is, and the priority is that of sampling.
    unsafe {
        interrupts.set_priority(Interrupt::EXTI0, held::SAMPLING);
        NVIC::unmask(Interrupt::EXTI0);
    }
}

/// The log in the chip, where one answers: without it the monitor works all the same.
fn mount(spi: Bus<SelectedSpi>) -> Option<ChipLog> {
    // Data sheet W25Q64JV, power-up timing.
    Wait {}.delay_ms(5);
    let chip = W25q::try_new(spi, Wait {}).ok();
    let log = chip.and_then(|chip| ChipLog::mount(chip).ok());
    if log.is_none() {
        error!("no flash for the drop log");
    }
    log
}

/// The end of a program that panics: outputs dropped, a record left, reset.
pub fn on_panic(info: &PanicInfo) -> ! {
    record::on_panic(OutputPort::drop_now, info)
}

/// Likewise after a fault of the core at `pc`, called from `lr`.
pub fn on_hard_fault(pc: u32, lr: u32) -> ! {
    record::on_hard_fault(OutputPort::drop_now, pc, lr)
}

/// Likewise after an interrupt that nothing serves.
pub fn on_stray_interrupt(number: i16) -> ! {
    record::on_stray_interrupt(OutputPort::drop_now, number)
}
