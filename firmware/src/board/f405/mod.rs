//! STM32F405: sampled by its own converter, 20 000 times a second.
//!
//! The tick is the converter's interrupt, the only one and so the highest. It must be over before
//! the next sample, 50 us later; a tick that is not loses samples, which are counted and latched,
//! and goes on. What it reports goes through a queue to the idle loop, which logs and serves the link.

mod chip;
mod clocks;
mod converter;
mod inputs;
mod line;
mod outputs;
mod record;
mod remote;
mod store;

use core::cell::RefCell;
use core::mem::MaybeUninit;
use core::panic::PanicInfo;

use cortex_m::peripheral::{DWT, SCB};
use critical_section::Mutex;
use defmt::{error, info};
use embedded_hal::delay::DelayNs;
use heapless::spsc::{Consumer, Producer, Queue};
use stm32f4::stm32f405::{Interrupt, NVIC, Peripherals};
use touchdown_core::event::{Notice, Notices};
use touchdown_core::forecast::ForecastTask;
use touchdown_core::sample::Sample;
use touchdown_protocol::config_block::{self, Block, BlockError, Key, Settings};
use touchdown_protocol::controller::{Fault, Faults, Outputs, Shown};
use touchdown_protocol::link::Server;
use touchdown_rotor::error::ConfigError;

use self::chip::{Chip, Cycles, Spi};
use self::clocks::APB2_HZ;
use self::converter::Converter;
use self::inputs::Inputs;
use self::line::Line;
use self::outputs::{OutputPins, Watchdog};
use self::remote::Remote;
use super::image;
use super::{Abilities, BAUD, Board, SAMPLE_RATE_HZ, STATE_SAMPLES, default_settings};
use crate::app::App;
use crate::crash::{Cause, Crash, FaultStatus};
use crate::drop_log::DropLog;
use crate::journal;
use crate::memory;
use crate::overrun::Overruns;
use crate::recorder::{Identity, Recorder};
use crate::tick;
use crate::w25q::W25q;

/// The drop log in the chip on the board, 2 MiB.
type ChipLog = DropLog<Chip, LOG_SLOTS>;
const LOG_SLOTS: usize = 42;

/// What outlives main's frame.
pub struct Memory {
    /// Notices on their way to log and link. If it is full they are lost and counted; events are
    /// numbered, so a gap shows.
    outbox: Queue<Notice, 64>,
    monitor: memory::Memory,
    // Without a value of its own: one would take as much flash.
    tick: MaybeUninit<Tick>,
}

impl Memory {
    /// Empty.
    #[expect(clippy::new_without_default, reason = "for a static")]
    pub const fn new() -> Self {
        Self {
            outbox: Queue::new(),
            monitor: memory::Memory::EMPTY,
            tick: MaybeUninit::uninit(),
        }
    }
}

/// 12 bit; no pin takes the pulses of ring and cage.
const ABILITIES: Abilities = Abilities {
    sample_rate: SAMPLE_RATE_HZ as f32,
    full_scale: 4_095,
    tachometers: false,
};

static TICK: Mutex<RefCell<Option<&'static mut Tick>>> = Mutex::new(RefCell::new(None));

struct Silicon {
    pins: OutputPins,
    watchdog: Watchdog,
    outbox: Producer<'static, Notice>,
    lost_notices: u32,
    block: InForce,
}

/// The configuration block in force.
enum InForce {
    Stored(&'static [u8]),
    Default(Block),
}

impl InForce {
    fn bytes(&self) -> &[u8] {
        match self {
            Self::Stored(block) => block,
            Self::Default(block) => block,
        }
    }

    /// Without its key: the log tells the checksum, which would tell of it.
    fn told(&self, settings: &Settings) -> Block {
        config_block::blanked(self.bytes(), settings.key.is_some())
    }
}

impl Board for Silicon {
    fn report(&mut self, notice: &Notice) {
        let is_lost = self.outbox.enqueue(*notice).is_err();
        self.lost_notices = self.lost_notices.saturating_add(u32::from(is_lost));
    }

    fn drive(&mut self, shown: Shown) {
        self.pins.drive(shown.outputs);
    }

    fn config(&self) -> &[u8] {
        self.block.bytes()
    }

    fn service(&self) -> bool {
        self.pins.service()
    }

    fn feed(&mut self) {
        self.watchdog.feed();
    }
}

struct Tick {
    app: &'static mut App,
    recorder: &'static mut Recorder<'static>,
    converter: Converter,
    inputs: Inputs,
    board: Silicon,
    overruns: Overruns,
    notices: Notices,
    /// Cycle counter at its last start.
    at: u32,
}

/// What works below the tick.
struct Below {
    line: Line,
    remote: Remote,
    inbox: Consumer<'static, Notice>,
    forecast_task: ForecastTask,
    key: Option<Key>,
}

/// Starts sampling; looks ahead, logs, and serves the link.
pub fn main(memory: &'static mut Memory) -> ! {
    let Some(Below {
        mut line,
        mut remote,
        mut inbox,
        mut forecast_task,
        key,
    }) = start(memory)
    else {
        idle()
    };
    let mut server = Server::new(env!("CARGO_PKG_VERSION"), SAMPLE_RATE_HZ as f32, key);
    let mut known = (Shown::default(), Faults::NONE, 0);
    loop {
        while let Some(notice) = inbox.dequeue() {
            journal::notice(&notice);
            if !line.send(server.notice(&notice).as_ref()) {
                remote.lose_notice();
            }
        }
        let forecast_input = with_tick(|tick| tick.app.forecast_input(forecast_task.wants_input()));
        if let Some(outlook) = forecast_input.and_then(|it| forecast_task.work(&it)) {
            with_tick(|tick| {
                tick.board.report(&outlook);
                tick.recorder.hear(&outlook);
            });
        }
        remote.work();
        line.push();
        while let Some(byte) = line.next() {
            // An answer without room is asked for again.
            let _ = line.send(server.take(byte, &mut remote).as_ref());
        }
        let (shown, faults, samples) = with_tick(|tick| {
            let app = &*tick.app;
            (app.shown(), app.faults(), app.state().samples())
        })
        .unwrap_or_default();
        if shown != known.0 {
            journal::shown(shown);
        }
        if faults != known.1 {
            journal::faults(faults);
        }
        let is_due = samples.saturating_sub(known.2) >= STATE_SAMPLES;
        if is_due {
            // The next one tells more.
            let _ = line.send(server.state(&mut remote).as_ref());
        }
        known = (shown, faults, if is_due { samples } else { known.2 });
        if remote.wants_reset() && line.is_done() {
            SCB::sys_reset();
        }
    }
}

/// Brings everything up. A frame of its own: what is put in its place here is gone from the stack before
/// the first interrupt.
#[inline(never)]
fn start(memory: &'static mut Memory) -> Option<Below> {
    let (Some(core), Some(chip)) = (cortex_m::Peripherals::take(), Peripherals::take()) else {
        unreachable!("main runs once");
    };
    let pins = OutputPins::new(chip.GPIOC, &chip.RCC);
    info!("touchdown {=str} on stm32f405", env!("CARGO_PKG_VERSION"));
    let (block, settings, found) = found_at_power_on(&chip.RCC);
    journal::config(&settings.monitor);
    clocks::start(&chip.RCC, &chip.FLASH);
    let found = with_image(found);
    start_cycle_counter(core.DCB, core.DWT);
    let converter = Converter::new(
        chip.ADC1,
        &chip.ADC_COMMON,
        chip.TIM2,
        chip.TIM3,
        &chip.GPIOA,
        &chip.RCC,
    );
    remote::wire(&chip.GPIOB, &chip.RCC);
    let line = Line::new(chip.USART1, chip.DMA2, (APB2_HZ / BAUD) as u16, &chip.RCC);
    let log = mount(Spi::new(chip.SPI1, chip.GPIOA, &chip.GPIOB, &chip.RCC));
    let (outbox, inbox) = memory.outbox.split();
    let told = block.told(&settings);
    let identity = Identity::new(&told, log.as_ref().map_or(0, DropLog::boot));
    let filled = memory.monitor.fill(&settings.monitor, found, identity);
    let refused = |refusal: &ConfigError| error!("config: {=str}", refusal.parameter());
    let (app, recorder) = filled.inspect_err(refused).ok()?;
    app.recall(log.as_ref().and_then(DropLog::uncleared));
    let forecast_task = memory::forecast_task(&settings.monitor)
        .inspect_err(refused)
        .ok()?;
    let board = Silicon {
        pins,
        watchdog: Watchdog::start(chip.IWDG, &chip.DBGMCU),
        outbox,
        lost_notices: 0,
        block,
    };
    let tick = memory.tick.write(Tick {
        app,
        recorder,
        inputs: Inputs::new(chip.GPIOB, chip.TIM4, &chip.RCC, &settings),
        board,
        overruns: Overruns::default(),
        notices: Notices::new(),
        at: DWT::cycle_count(),
        converter,
    });
    tick.converter.start();
    critical_section::with(|cs| TICK.replace(cs, Some(tick)));
    // SAFETY: what the handler needs is in place, and no critical section is open.
    unsafe { NVIC::unmask(Interrupt::ADC) };
    Some(Below {
        line,
        remote: Remote::new(chip.FLASH, chip.RCC, chip.RNG, log),
        inbox,
        forecast_task,
        key: settings.key,
    })
}

/// The log in the chip, where one answers: without it the monitor works all the same.
fn mount(spi: Spi) -> Option<ChipLog> {
    // Data sheet W25Q64JV, power-up timing.
    Cycles.delay_ms(5);
    let chip = W25q::try_new(spi, Cycles).ok();
    let log = chip.and_then(|chip| ChipLog::mount(chip).ok());
    if log.is_none() {
        error!("no flash for the drop log");
    }
    log
}

/// What was wrong, and whether the image is.
fn with_image(found: Faults) -> Faults {
    if image::is_whole() {
        return found;
    }
    error!("image damaged");
    found.with(Fault::ImageDamaged)
}

/// The configuration, and what was wrong.
fn found_at_power_on(rcc: &stm32f4::stm32f405::RCC) -> (InForce, Settings, Faults) {
    let mut found = Faults::NONE;
    if Watchdog::has_bitten(rcc) {
        error!("watchdog reset");
        found = found.with(Fault::WatchdogReset);
    }
    if let Some(Crash {
        cause,
        place,
        detail,
        status,
    }) = record::read()
    {
        error!(
            "crash: cause {=u8}, at {=u32:#x}, {=u32:#x}; cfsr {=u32:#x}, hfsr {=u32:#x}, address {=u32:#x}",
            cause as u8, place, detail, status.configurable, status.hard, status.address
        );
        found = found.with(Fault::Crash);
    }
    match store::load() {
        Ok((block, settings)) if ABILITIES.misfit(&settings.monitor).is_none() => {
            (InForce::Stored(block), settings, found)
        }
        other => {
            let fault = match other {
                Ok(_) => Fault::ConfigMisfit,
                Err(BlockError::Blank) => Fault::Unconfigured,
                Err(_) => Fault::ConfigDamaged,
            };
            error!(
                "config: fault {=u8}, the defaults are in force",
                fault as u8
            );
            found = found.with(fault);
            let settings = default_settings();
            let block = InForce::Default(config_block::encode(&settings));
            (block, settings, found)
        }
    }
}

fn with_tick<T>(act: impl FnOnce(&mut Tick) -> T) -> Option<T> {
    critical_section::with(|cs| TICK.borrow_ref_mut(cs).as_mut().map(|tick| act(tick)))
}

/// The tick: the converter has a sample.
pub fn on_converted() {
    let now = DWT::cycle_count();
    with_tick(|tick| {
        tick.at = now;
        let lost = tick.overruns.tick(tick.converter.number());
        let sample = Sample {
            spin: tick.inputs.spin(),
            levitated: tick.inputs.levitated(),
            ..tick.converter.take()
        };
        let Tick {
            app,
            recorder,
            board,
            notices,
            ..
        } = tick;
        tick::tick(app, recorder, board, &sample, lost, notices);
    });
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
        Watchdog::start(chip.IWDG, &chip.DBGMCU);
    }
    left
}

/// The end of a program that panics: outputs dropped, a record left, reset.
pub fn on_panic(info: &PanicInfo) -> ! {
    record::stop(|| Crash::of_panic(info))
}

/// Likewise after a fault of the core at `pc`, called from `lr`.
pub fn on_hard_fault(pc: u32, lr: u32) -> ! {
    record::stop(|| Crash {
        cause: Cause::HardFault,
        place: pc,
        detail: lr,
        status: record::fault_status(),
    })
}

/// Likewise after an interrupt that nothing serves.
pub fn on_stray_interrupt(number: i16) -> ! {
    record::stop(|| Crash {
        cause: Cause::StrayInterrupt,
        place: number as u32,
        detail: 0,
        status: FaultStatus::default(),
    })
}

fn start_cycle_counter(mut dcb: cortex_m::peripheral::DCB, mut dwt: DWT) {
    dcb.enable_trace();
    dwt.enable_cycle_counter();
}

/// With the outputs without current there is nothing left to do.
fn idle() -> ! {
    loop {
        cortex_m::asm::wfi();
    }
}
