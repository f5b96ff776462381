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
mod store;

use core::panic::PanicInfo;
use core::sync::atomic::{AtomicU32, Ordering};

use cortex_m::peripheral::{DWT, SCB};
use defmt::{error, info};
use embedded_hal::delay::DelayNs;
use stm32f4::stm32f405::{FLASH, Interrupt, NVIC, Peripherals};
use touchdown_core::event::Notice;
use touchdown_protocol::controller::{Outputs, Shown};
use touchdown_rotor::error::ConfigError;

use self::chip::{Chip, Spi, Spi1, Wait};
use self::clocks::APB2_HZ;
use self::converter::Converter;
use self::inputs::PinInputs;
use self::line::Port;
use self::outputs::{OutputPins, Watchdog};
use self::remote::F405;
use super::bus::Bus;
use super::chip_platform::{ChipPlatform, Sampling};
use super::held::{self, Held};
use super::line::Line;
use super::slots::ConfigFlash;
use super::{Abilities, BAUD, Board, SAMPLE_RATE_HZ, default_settings, image, record, slots};
use crate::crash::Crash;
use crate::drop_log::DropLog;
use crate::journal;
use crate::main_loop::MainLoop;
use crate::memory::{self, Memory};
use crate::power_on::{InForce, PowerOn};
use crate::recorder::Identity;
use crate::tick::TickTask;
use crate::w25q::W25q;

/// The drop log in the chip on the board, 2 MiB.
type ChipLog = DropLog<Chip, LOG_SLOTS>;
const LOG_SLOTS: usize = 42;

/// 12 bit; no pin takes the pulses of ring and cage.
const ABILITIES: Abilities = Abilities {
    sample_rate: SAMPLE_RATE_HZ as f32,
    full_scale: 4_095,
    tachometers: false,
};

static SAMPLING: Held<Sampling<Converter, PinInputs>> = Held::new();
static TICK: Held<TickTask<'static, Silicon>> = Held::new();
/// Cycle counter at the last sample.
static SAMPLED: AtomicU32 = AtomicU32::new(0);

/// What the tick has of the chip.
pub struct Silicon {
    pins: OutputPins,
    watchdog: Watchdog,
    block: InForce,
}

impl Board for Silicon {
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

/// The converters have a sample.
pub fn on_converted() {
    SAMPLED.store(DWT::cycle_count(), Ordering::Relaxed);
    if SAMPLING.with(Sampling::take) == Some(true) {
        OutputPins::drop_now();
    }
    SCB::set_pendsv();
}

/// PendSV: samples wait.
pub fn on_waiting() {
    while TICK.with(TickTask::step) == Some(true) {}
}

/// Starts sampling, and the main loop.
pub fn main(memory: &'static mut Memory) -> ! {
    match start(memory) {
        Some((mut below, mut chip)) => below.run(&mut chip),
        None => idle(),
    }
}

/// Brings everything up. A frame of its own: what is put in its place here is gone from the stack before
/// the first interrupt.
#[inline(never)]
fn start(memory: &'static mut Memory) -> Option<(MainLoop, ChipPlatform<F405>)> {
    let (Some(mut core), Some(chip)) = (cortex_m::Peripherals::take(), Peripherals::take()) else {
        unreachable!("main runs once");
    };
    let pins = OutputPins::new(chip.GPIOC, &chip.RCC);
    info!("touchdown {=str} on stm32f405", env!("CARGO_PKG_VERSION"));
    clocks::start(&chip.RCC, &chip.FLASH);
    let (block, settings, found) = PowerOn {
        stored: slots::load::<FLASH>(),
        fallback: default_settings(),
        is_configured: false,
        is_whole: image::is_whole(FLASH::START),
        crash: record::read(),
        has_bitten: Watchdog::has_bitten(&chip.RCC),
    }
    .check(&ABILITIES);
    journal::config(&settings.monitor);
    core.DCB.enable_trace();
    core.DWT.enable_cycle_counter();
    let converter = Converter::new(
        (chip.ADC1, chip.ADC2),
        &chip.ADC_COMMON,
        chip.TIM2,
        chip.TIM3,
        &chip.GPIOA,
        &chip.RCC,
    );
    remote::wire(&chip.GPIOB, &chip.RCC);
    let port = Port::new(chip.USART1, chip.DMA2, (APB2_HZ / BAUD) as u16, &chip.RCC);
    let line = Line::new(port);
    let log = mount(Bus(Spi1::new(
        chip.SPI1,
        chip.GPIOA,
        &chip.GPIOB,
        &chip.RCC,
    )));
    let identity = Identity::new(
        &block.told(&settings),
        log.as_ref().map_or(0, DropLog::boot),
    );
    let board = Silicon {
        pins,
        watchdog: Watchdog::new(chip.IWDG),
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
    let inputs = PinInputs::new(chip.GPIOB, chip.TIM4, &chip.RCC, &settings);
    SAMPLING.put(Sampling::new(converter, inputs, intake));
    held::set_tick_priority(&mut core.SCB);
    // SAFETY: what the handlers need is in place.
    unsafe {
        core.NVIC.set_priority(Interrupt::ADC, held::SAMPLING);
        NVIC::unmask(Interrupt::ADC);
    }
    let below = MainLoop::new(settings.key, SAMPLE_RATE_HZ as f32, forecast);
    let below_tick = F405::new(chip.FLASH, chip.RCC, chip.RNG);
    Some((below, ChipPlatform::new(below_tick, line, log)))
}

/// The log in the chip, where one answers: without it the monitor works all the same.
fn mount(spi: Spi) -> Option<ChipLog> {
    // Data sheet W25Q64JV, power-up timing.
    Wait {}.delay_ms(5);
    let chip = W25q::try_new(spi, Wait {}).ok();
    let log = chip.and_then(|chip| ChipLog::mount(chip).ok());
    if log.is_none() {
        error!("no flash for the drop log");
    }
    log
}

/// The outputs' pins and the watchdog alone, as [`main`] sets them up: for the image that stops on purpose.
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
        Watchdog::new(chip.IWDG).start(&chip.DBGMCU);
    }
    left
}

/// The end of a program that panics: outputs dropped, a record left, reset.
pub fn on_panic(info: &PanicInfo) -> ! {
    record::on_panic(OutputPins::drop_now, info)
}

/// Likewise after a fault of the core at `pc`, called from `lr`.
pub fn on_hard_fault(pc: u32, lr: u32) -> ! {
    record::on_hard_fault(OutputPins::drop_now, pc, lr)
}

/// Likewise after an interrupt that nothing serves.
pub fn on_stray_interrupt(number: i16) -> ! {
    record::on_stray_interrupt(OutputPins::drop_now, number)
}

/// With the outputs without current there is nothing left to do.
fn idle() -> ! {
    loop {
        cortex_m::asm::wfi();
    }
}
