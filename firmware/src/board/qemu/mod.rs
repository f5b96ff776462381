//! QEMU's netduinoplus2: samples from a replay file, notices to an answer file, both by
//! semihosting. Formats: [`touchdown_protocol::wire`].
//!
//! TIM2's interrupt gives a sample each period, in emulated time: by default only once all that follows from the one
//! before is done, so that any rate gives the same bits on any desktop; in real time whatever becomes of it.

mod files;
mod line;
mod nor;
mod remote;
mod settings;

use core::sync::atomic::{AtomicBool, AtomicU32, Ordering};

use cortex_m::peripheral::SCB;
use defmt::{Debug2Format, Display2Format, error, info};
use semihosting::fs::File;
use semihosting::io::Write as _;
use semihosting::process::exit;
use stm32f4::stm32f405::{Interrupt, Peripherals, TIM2};
use touchdown_core::event::Notice;
use touchdown_core::monitor::Fingerprint;
use touchdown_core::oversampling::ConverterConfig;
use touchdown_protocol::config_block::BlockError;
use touchdown_protocol::controller::Shown;
use touchdown_protocol::wire::{self, Record, ReplayHead, Switching};

use self::files::{Files, Replay};
use self::line::Wire;
use self::nor::NorFile;
use self::remote::EmulatorPlatform;
use self::settings::SettingsFile;
use super::f405::F405;
use super::silicon::ConfigFlash as _;
use super::silicon::held::{self, Held};
use super::silicon::image;
use super::{Abilities, Board, EMULATED_SLOTS};
use crate::drop_log::DropLog;
use crate::intake::Intake;
use crate::journal;
use crate::main_loop::MainLoop;
use crate::memory::Memory;
use crate::power_on::{InForce, PowerOn};
use crate::tick::TickTask;

/// TIM2's clock in QEMU, Hz.
const TIMER_HZ: f32 = 1e9;

/// Why a run failed; the exit status.
#[derive(Clone, Copy, Debug)]
#[repr(u8)]
pub enum Failure {
    /// The command line is not two file names.
    CommandLine = 2,
    /// The replay file is missing, damaged or of another version.
    Replay = 3,
    /// The monitor refused the configuration.
    Config = 4,
    /// The answer could not be written.
    Answer = 5,
    /// The log's file could not be used.
    Log = 6,
}

/// Exit status once a configuration was stored, which waits for a start: silicon would reset.
const RESTART: i32 = 7;

/// The name of a file of the desktop.
type Name = heapless::CString<256>;
/// The drop log in a file.
pub(crate) type FileLog = DropLog<NorFile, EMULATED_SLOTS>;

static SAMPLING: Held<Sampling> = Held::new();
static TICK: Held<TickTask<'static, Emulated>> = Held::new();
/// Samples of which all that follows is done.
static DONE: AtomicU32 = AtomicU32::new(0);
/// No sample is left.
static IS_OVER: AtomicBool = AtomicBool::new(false);

/// What the tick has of the emulator.
pub struct Emulated {
    answer: File,
    shown: Option<Shown>,
    ticks: u64,
    block: InForce,
}

impl Emulated {
    fn write(&mut self, record: &Record) {
        let written = self.answer.write_all(&wire::encode_record(record));
        written.unwrap_or_else(|_| exit(Failure::Answer as i32));
    }
}

impl Board for Emulated {
    fn report(&mut self, notice: &Notice) {
        self.write(&Record::Notice(*notice));
    }

    fn drive(&mut self, shown: Shown) {
        if self.shown != Some(shown) {
            self.shown = Some(shown);
            let sample = self.ticks;
            self.write(&Record::Switching(Switching { sample, shown }));
        }
        self.ticks += 1;
    }

    fn config(&self) -> &[u8] {
        self.block.bytes()
    }
}

/// What the sampling interrupt has.
struct Sampling {
    timer: TIM2,
    replay: Replay,
    wire: Wire,
    intake: Intake<'static>,
    /// Conversions that were given, and those of a sample.
    given: u32,
    conversions: u32,
    in_real_time: bool,
}

impl Sampling {
    fn take(&mut self) {
        self.timer.sr().modify(|_, w| w.uif().clear_bit());
        let is_done = self.given / self.conversions == DONE.load(Ordering::Acquire);
        let is_free = self.in_real_time || is_done;
        if !is_free || IS_OVER.load(Ordering::Relaxed) {
            self.wire.step(None);
            return;
        }
        let next = self.replay.next();
        let next = next.unwrap_or_else(|failure| exit(failure as i32));
        let Some((arrival, scripted)) = next else {
            IS_OVER.store(true, Ordering::Release);
            return;
        };
        self.given = self.given.wrapping_add(1);
        self.wire.step(scripted);
        // There are no pins to drop.
        let _ = self.intake.take(arrival, 0);
    }
}

/// TIM2: a period is over.
pub fn on_timer() {
    SAMPLING.with(Sampling::take);
    SCB::set_pendsv();
}

/// PendSV: samples wait.
pub fn on_waiting() {
    while TICK.with(TickTask::step) == Some(true) {}
}

/// Runs the replay file that the command line names, and exits the emulator.
pub fn main(memory: &'static mut Memory) -> ! {
    info!("touchdown {=str} on qemu", env!("CARGO_PKG_VERSION"));
    match start(memory) {
        Ok((mut below, mut emulator)) => below.run(&mut emulator),
        Err(failure) => {
            error!("failed: {}", Debug2Format(&failure));
            exit(failure as i32)
        }
    }
}

/// Brings everything up. A frame of its own: what is put in its place here is gone from the stack before the first
/// interrupt.
#[inline(never)]
fn start(memory: &'static mut Memory) -> Result<(MainLoop, EmulatorPlatform), Failure> {
    let (Some(mut core), Some(chip)) = (cortex_m::Peripherals::take(), Peripherals::take()) else {
        unreachable!("main runs once");
    };
    let mut files = Files::open()?;
    let head = files.replay.head().ok_or(Failure::Replay)?;
    // Those of a board that gives the samples of this configuration.
    let converter = converter(&head);
    let abilities = Abilities {
        converter,
        cycles: f32::INFINITY,
        tachometers: head.config.tachometers.is_some(),
    };
    let (block, settings, found) = power_on(&head, files.settings.as_ref()).check(&abilities);
    journal::config(&settings.monitor);
    let counters = files.log.as_ref().map(FileLog::counters);
    let boot = counters.map_or(0, |it| it.boots);
    let board = Emulated {
        answer: files.answer,
        shown: None,
        ticks: 0,
        block,
    };
    let filled = memory.fill(&settings, &abilities, (found, boot), board);
    let (intake, tick, below) = filled.map_err(|refusal| {
        error!("config: {}", Display2Format(&refusal));
        Failure::Config
    })?;
    if head.powers_on {
        tick.app.recall(counters.and_then(|it| it.uncleared));
    } else {
        tick.app.assume_lift();
    }
    TICK.put(tick);
    let (wire, line) = line::open(chip.USART1, converter.rate);
    SAMPLING.put(Sampling {
        timer: chip.TIM2,
        replay: files.replay,
        wire,
        conversions: intake.conversions(),
        intake,
        given: 0,
        in_real_time: head.in_real_time,
    });
    SAMPLING.with(|it| start_timer(&it.timer, converter.rate));
    held::unmask(&mut core, Interrupt::TIM2);
    let platform = EmulatorPlatform {
        line,
        abilities,
        settings: files.settings,
        log: files.log,
        fingerprint: Some(Fingerprint::default()),
        heard: None,
        was_over: false,
    };
    Ok((below, platform))
}

/// Whose conversions the replay has.
fn converter(head: &ReplayHead) -> ConverterConfig {
    ConverterConfig {
        rate: head.config.detector.sample_rate,
        full_scale: head.config.sensing.full_scale,
    }
}

/// An interrupt each conversion, at so many a second.
fn start_timer(timer: &TIM2, rate: f32) {
    timer.cr1().write(|w| w.cen().enabled());
    timer.dier().write(|w| w.uie().set_bit());
    // QEMU 7.2 adds its time of the last update to each period, which is 0 as long as there was none; the last of these
    // starts it (hw/timer/stm32f2xx_timer.c).
    timer.arr().write(|w| w.arr().set((TIMER_HZ / rate) as u32));
}

/// What is found: the configuration of the replay where none is stored.
fn power_on(head: &ReplayHead, file: Option<&SettingsFile>) -> PowerOn {
    PowerOn {
        stored: file.map_or(Err(BlockError::Blank), SettingsFile::load),
        fallback: head.config.into(),
        is_configured: head.is_configured,
        is_whole: image::is_whole(F405::START),
        crash: None,
        has_bitten: false,
    }
}
