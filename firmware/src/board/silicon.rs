//! The monitor on a chip, whatever its registers: its start, its interrupts, and what its tick has of it.

use core::sync::atomic::{AtomicU32, Ordering};

use cortex_m::Peripherals;
use cortex_m::interrupt::InterruptNumber;
use cortex_m::peripheral::{DWT, SCB};
use defmt::error;
use embedded_hal::delay::DelayNs;
use touchdown_core::event::Notice;
use touchdown_core::sample::Sample;
use touchdown_protocol::config_block::Settings;
use touchdown_protocol::controller::{Faults, Outputs, Shown};
use touchdown_protocol::link::Refusal;
use touchdown_protocol::wire::Incoming;
use touchdown_rotor::error::ConfigError;

use super::bus::{Bus, SpiRegisters};
use super::held::{self, Held};
use super::inputs::{InputRegisters, Inputs};
use super::line::LineRegisters;
use super::slots::{self, ConfigFlash};
use super::{Abilities, Board, SAMPLE_RATE_HZ, image, record};
use crate::drop_log::DropLog;
use crate::intake::Intake;
use crate::main_loop::MainLoop;
use crate::memory::{self, Memory};
use crate::overrun::Overruns;
use crate::platform::{Platform, SampleSource};
use crate::power_on::{InForce, PowerOn};
use crate::tick::TickTask;
use crate::w25q::W25q;

/// The drop log in a W25Q of 2 MiB.
pub type ChipLog<C> = DropLog<W25q<Bus<<C as Chip>::Spi>, Wait<C>>, LOG_SLOTS>;
type Wait<C> = <<C as Chip>::Spi as SpiRegisters>::Wait;
const LOG_SLOTS: usize = 42;

/// Pins of the outputs.
pub trait OutputRegisters {
    /// Sets all levels at once.
    fn drive(&self, outputs: Outputs);

    /// Takes the current off all, whatever else the program holds: the first act of one that stops, and of the guard on
    /// top.
    fn drop_now();
}

/// Resets the core, and so takes the current off the outputs, when good ticks stay away for 2 ms.
pub trait Watchdog {
    /// Starts it; it stands still while a debugger halts the core.
    fn start(&self);

    /// Gives it another 2 ms.
    fn feed(&self);
}

/// Registers of a chip.
pub trait Chip: Sized + 'static {
    /// Of the outputs.
    type Pins: OutputRegisters;
    /// Of the watchdog.
    type Watchdog: Watchdog;
    /// The converter.
    type Source: SampleSource;
    /// What comes with the positions.
    type Inputs: InputRegisters;
    /// SPI of the log's flash.
    type Spi: SpiRegisters;
    /// The line.
    type Port: LineRegisters;
    /// Of its core.
    const MHZ: u32;
    /// Highest count of the converter.
    const FULL_SCALE: u16;
    /// What a configuration has to fit. No pin takes the pulses of ring and cage.
    const ABILITIES: Abilities = Abilities {
        sample_rate: SAMPLE_RATE_HZ as f32,
        full_scale: Self::FULL_SCALE,
        tachometers: false,
    };

    /// What interrupts and main loop share.
    fn tasks() -> &'static ChipTasks<Self>;

    /// Takes the current off the outputs.
    fn drop_outputs() {
        Self::Pins::drop_now();
    }

    /// A word of the noise source; none where it fails.
    fn word(&self) -> Option<u32>;

    /// Keeps a valid configuration.
    fn store(&self, block: &[u8]) -> Result<(), Refusal>;

    /// Forgets that the watchdog has bitten.
    fn forget_reset(&self);
}

/// What the tick has of the chip.
pub struct ChipBoard<C: Chip> {
    pins: C::Pins,
    watchdog: C::Watchdog,
    block: InForce,
}

impl<C: Chip> Board for ChipBoard<C> {
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

/// What the sampling interrupt has.
struct Sampling<C: Chip> {
    source: C::Source,
    inputs: Inputs<C::Inputs>,
    overruns: Overruns,
    intake: Intake<'static>,
}

impl<C: Chip> Sampling<C> {
    /// Takes what was converted; whether the outputs must be safe now.
    fn take(&mut self) -> bool {
        let lost = self.overruns.tick(self.source.number());
        let sample = Sample {
            spin: self.inputs.spin(),
            levitated: self.inputs.levitated(),
            ..self.source.take()
        };
        let arrival = Incoming {
            sample,
            service: self.inputs.service(),
            clear: false,
        };
        self.intake.take(arrival, lost)
    }
}

/// The configuration in force, and what was wrong at power-on.
pub fn check<F: ConfigFlash>(
    fallback: Settings,
    abilities: &Abilities,
    has_bitten: bool,
) -> (InForce, Settings, Faults) {
    let found = PowerOn {
        stored: slots::load::<F>(),
        fallback,
        is_configured: false,
        is_whole: image::is_whole(F::START),
        crash: record::read(),
        has_bitten,
    };
    found.check(abilities)
}

/// The log in the chip, where one answers: without it the monitor works all the same.
pub fn mount<C: Chip>(bus: Bus<C::Spi>) -> Option<ChipLog<C>> {
    let mut wait = Wait::<C>::default();
    // Data sheet W25Q64JV, power-up timing.
    wait.delay_ms(5);
    let chip = W25q::try_new(bus, wait).ok();
    let log = chip.and_then(|chip| DropLog::mount(chip).ok());
    if log.is_none() {
        error!("no flash for the drop log");
    }
    log
}

/// What interrupts and main loop share. In this order, what the uppermost interrupt needs is near its beginning.
#[repr(C)]
pub struct ChipTasks<C: Chip> {
    sampling: Held<Sampling<C>>,
    pub(super) tick: Held<TickTask<'static, ChipBoard<C>>>,
    /// Cycle counter at the last sample.
    pub(super) sampled: AtomicU32,
}

impl<C: Chip> ChipTasks<C> {
    /// Nothing in its place yet.
    pub const fn empty() -> Self {
        Self {
            sampling: Held::new(),
            tick: Held::new(),
            sampled: AtomicU32::new(0),
        }
    }

    /// Puts the tick in its place, with the outputs' pins and the watchdog, which runs from now on.
    pub fn start_tick(
        &'static self,
        memory: &'static mut Memory,
        (block, settings, found): (InForce, &Settings, Faults),
        (pins, watchdog): (C::Pins, C::Watchdog),
        log: Option<&ChipLog<C>>,
    ) -> Option<(Intake<'static>, MainLoop)> {
        let counters = log.map(ChipLog::<C>::counters);
        let boot = counters.map_or(0, |it| it.boots);
        let board = ChipBoard::<C> {
            pins,
            watchdog,
            block,
        };
        let refused = |refusal: &ConfigError| error!("config: {=str}", refusal.parameter());
        let filled = memory.fill(settings, found, boot, board);
        let (intake, tick) = filled.inspect_err(refused).ok()?;
        tick.app.recall(counters.and_then(|it| it.uncleared));
        let forecast = memory::forecast_task(&settings.monitor)
            .inspect_err(refused)
            .ok()?;
        tick.desk.board.watchdog.start();
        self.tick.put(tick);
        let below = MainLoop::new(settings.key, SAMPLE_RATE_HZ as f32, forecast);
        Some((intake, below))
    }

    /// Lets samples come, by this interrupt.
    pub fn start_sampling(
        &'static self,
        core: &mut Peripherals,
        interrupt: impl InterruptNumber,
        source: C::Source,
        inputs: Inputs<C::Inputs>,
        intake: Intake<'static>,
    ) {
        core.DCB.enable_trace();
        core.DWT.enable_cycle_counter();
        self.sampling.put(Sampling {
            source,
            inputs,
            overruns: Overruns::default(),
            intake,
        });
        held::unmask(core, interrupt);
    }

    /// The converter has a sample.
    pub fn on_converted(&'static self) {
        self.sampled.store(DWT::cycle_count(), Ordering::Relaxed);
        if self.sampling.with(Sampling::take) == Some(true) {
            C::Pins::drop_now();
        }
        SCB::set_pendsv();
    }

    /// PendSV: samples wait.
    pub fn on_waiting(&'static self) {
        while self.tick.with(TickTask::step) == Some(true) {}
    }
}

/// The main loop, where all is up.
#[inline(always)]
pub fn run<P: Platform>(started: Option<(MainLoop, P)>) -> ! {
    if let Some((mut below, mut chip)) = started {
        below.run(&mut chip);
    }
    // With the outputs without current there is nothing left to do.
    loop {
        cortex_m::asm::wfi();
    }
}

/// The end of an image that panics, after a fault of the core, or after an interrupt that nothing serves: outputs dropped
/// by this function, a record left, reset.
#[macro_export]
macro_rules! last_acts {
    ($drop_outputs:path) => {
        #[panic_handler]
        fn panic(info: &core::panic::PanicInfo) -> ! {
            $crate::board::record::on_panic($drop_outputs, info)
        }

        // The runtime asks for unsafe functions; there is nothing unsafe in them.
        #[cortex_m_rt::exception]
        unsafe fn HardFault(frame: &cortex_m_rt::ExceptionFrame) -> ! {
            $crate::board::record::on_hard_fault($drop_outputs, frame.pc(), frame.lr())
        }

        #[cortex_m_rt::exception]
        unsafe fn DefaultHandler(number: i16) -> ! {
            $crate::board::record::on_stray_interrupt($drop_outputs, number)
        }
    };
}
