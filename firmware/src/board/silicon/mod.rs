//! The monitor on a chip, whatever its registers: its start, its interrupts, and what its tick has of it.

mod bus;
pub mod held;
pub mod image;
mod inputs;
mod line;
mod platform;
pub mod record;
mod slots;

use core::sync::atomic::{AtomicU32, Ordering};

use cortex_m::Peripherals;
use cortex_m::interrupt::InterruptNumber;
use cortex_m::peripheral::{DWT, SCB};
use defmt::error;
use embedded_hal::delay::DelayNs;
use touchdown_core::oversampling::ConverterConfig;
use touchdown_core::sample::{Sample, TACHOMETERS};
use touchdown_protocol::config_block::Settings;
use touchdown_protocol::controller::{Faults, Outputs, Shown};
use touchdown_protocol::wire::Incoming;
use touchdown_rotor::error::ConfigError;

pub use self::bus::{Bus, CycleDelay, SpiRegisters};
use self::held::Held;
pub use self::inputs::{InputRegisters, Inputs};
pub use self::line::{Line, LineRegisters, RING_BYTES};
pub use self::platform::ChipPlatform;
pub use self::slots::ConfigFlash;
use super::{Abilities, Board, CONVERSION_RATE_HZ};
use crate::drop_log::DropLog;
use crate::intake::Intake;
use crate::journal;
use crate::main_loop::MainLoop;
use crate::memory::Memory;
use crate::overrun::Overruns;
use crate::platform::{Platform, SampleSource};
use crate::power_on::{InForce, PowerOn};
use crate::tick::TickTask;
use crate::w25q::W25q;

/// The drop log in a W25Q of 2 MiB.
pub type ChipLog<C> = DropLog<W25q<Bus<<C as Chip>::Spi>, Wait<C>>, LOG_SLOTS>;
type Wait<C> = <<C as Chip>::Spi as SpiRegisters>::Wait;
const LOG_SLOTS: usize = 42;

/// Pins of the outputs, and the watchdog that makes them fail-safe against a stuck core.
pub trait OutputRegisters {
    /// Sets all levels at once, whatever else the program holds: to take the current off is the first act of one that
    /// stops, and of the guard on top.
    fn drive(outputs: Outputs);

    /// Starts the watchdog: it resets the core, and so takes the current off the outputs, when good ticks stay away for
    /// 2 ms. It stands still while a debugger halts the core.
    fn start_watchdog(&self);

    /// Gives it another 2 ms.
    fn feed(&self);
}

/// Registers of a chip.
pub trait Chip: ConfigFlash + Sized + 'static {
    /// Of outputs and watchdog.
    type Outputs: OutputRegisters;
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
        converter: ConverterConfig {
            rate: CONVERSION_RATE_HZ as f32,
            full_scale: Self::FULL_SCALE,
        },
        cycles: (Self::MHZ * 1_000_000 / CONVERSION_RATE_HZ) as f32,
        tachometers: false,
    };

    /// What interrupts and main loop share.
    fn tasks() -> &'static ChipTasks<Self>;

    /// A word of the noise source; none where it fails.
    fn word(&self) -> Option<u32>;

    /// Forgets that the watchdog has bitten.
    fn forget_reset(&self);
}

/// What the tick has of the chip.
pub struct ChipBoard<C: Chip> {
    outputs: C::Outputs,
    block: InForce,
}

impl<C: Chip> Board for ChipBoard<C> {
    fn drive(&mut self, shown: Shown) {
        C::Outputs::drive(shown.outputs);
    }

    fn config(&self) -> &[u8] {
        self.block.bytes()
    }

    fn feed(&mut self) {
        self.outputs.feed();
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
        let (spin, levitated) = (self.inputs.spin(), self.inputs.levitated());
        let counts = self.source.take();
        let sample = Sample {
            counts: counts.unwrap_or_default(),
            valid: if counts.is_some() { 0b1111 } else { 0 },
            spin,
            levitated,
            edges: [None; TACHOMETERS],
        };
        let arrival = Incoming {
            service: self.inputs.service(),
            ..sample.into()
        };
        self.intake.take(arrival, lost)
    }
}

/// The configuration in force, and what was wrong at power-on.
pub fn check<C: Chip>(fallback: Settings, has_bitten: bool) -> (InForce, Settings, Faults) {
    let found = PowerOn {
        stored: slots::load::<C>(),
        fallback,
        is_configured: false,
        is_whole: image::is_whole(C::START),
        crash: record::read(),
        has_bitten,
    };
    let checked = found.check(&C::ABILITIES);
    journal::config(&checked.1.monitor);
    checked
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
    tick: Held<TickTask<'static, ChipBoard<C>>>,
    /// Cycle counter at the last sample.
    sampled: AtomicU32,
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

    /// The converter has a sample.
    pub fn on_converted(&'static self) {
        self.sampled.store(DWT::cycle_count(), Ordering::Relaxed);
        if self.sampling.with(Sampling::take) == Some(true) {
            C::Outputs::drive(Outputs::SAFE);
        }
        SCB::set_pendsv();
    }

    /// PendSV: samples wait.
    pub fn on_waiting(&'static self) {
        while self.tick.with(TickTask::step) == Some(true) {}
    }
}

/// Parts of a chip that are up, the converter stopped.
pub struct ChipParts<C: Chip> {
    /// Without current, the watchdog not started.
    pub outputs: C::Outputs,
    /// The converter.
    pub source: C::Source,
    /// What comes with the positions.
    pub inputs: Inputs<C::Inputs>,
    /// What the main loop has of it.
    pub platform: ChipPlatform<C>,
}

/// What [`run`] runs.
pub type Started<C> = Option<(MainLoop, ChipPlatform<C>)>;

impl<C: Chip> ChipParts<C> {
    /// Puts tick and sampling in their places: the watchdog runs from now on, and samples come by this interrupt.
    pub fn start(
        self,
        memory: &'static mut Memory,
        (block, settings, found): (InForce, Settings, Faults),
        mut core: Peripherals,
        interrupt: impl InterruptNumber,
    ) -> Started<C> {
        let counters = self.platform.log.as_ref().map(ChipLog::<C>::counters);
        let boot = counters.map_or(0, |it| it.boots);
        let outputs = self.outputs;
        let board = ChipBoard::<C> { outputs, block };
        let refused = |refusal: &ConfigError| error!("config: {=str}", refusal.parameter());
        let filled = memory.fill(&settings, &C::ABILITIES, (found, boot), board);
        let (intake, tick, below) = filled.inspect_err(refused).ok()?;
        tick.app.recall(counters.and_then(|it| it.uncleared));
        tick.desk.board.outputs.start_watchdog();
        let tasks = C::tasks();
        tasks.tick.put(tick);
        self.source.start();
        core.DCB.enable_trace();
        core.DWT.enable_cycle_counter();
        tasks.sampling.put(Sampling {
            source: self.source,
            inputs: self.inputs,
            overruns: Overruns::default(),
            intake,
        });
        held::unmask(&mut core, interrupt);
        Some((below, self.platform))
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

/// The image of a chip, which this function starts and this interrupt samples.
#[macro_export]
macro_rules! chip_image {
    ($chip:ident, $start:path, $sampling:ident) => {
        #[cortex_m_rt::entry]
        fn main() -> ! {
            static mut MEMORY: $crate::memory::Memory = $crate::memory::Memory::empty();
            $crate::board::silicon::run($start(MEMORY))
        }

        #[interrupt]
        fn $sampling() {
            <$chip as $crate::board::silicon::Chip>::tasks().on_converted();
        }

        #[cortex_m_rt::exception]
        fn PendSV() {
            <$chip as $crate::board::silicon::Chip>::tasks().on_waiting();
        }

        $crate::last_acts!($chip);
    };
}

/// The end of a chip's image that panics, after a fault of the core, or after an interrupt that nothing serves: outputs
/// dropped, a record left, reset.
#[macro_export]
macro_rules! last_acts {
    ($chip:ty) => {
        #[panic_handler]
        fn panic(info: &core::panic::PanicInfo) -> ! {
            $crate::board::silicon::record::on_panic::<$chip>(info)
        }

        // The runtime asks for unsafe functions; there is nothing unsafe in them.
        #[cortex_m_rt::exception]
        unsafe fn HardFault(frame: &cortex_m_rt::ExceptionFrame) -> ! {
            $crate::board::silicon::record::on_hard_fault::<$chip>(frame.pc(), frame.lr())
        }

        #[cortex_m_rt::exception]
        unsafe fn DefaultHandler(number: i16) -> ! {
            $crate::board::silicon::record::on_stray_interrupt::<$chip>(number)
        }
    };
}
