//! A chip below the tick, whatever its registers.

use core::sync::atomic::{AtomicU32, Ordering};

use cortex_m::peripheral::{DWT, SCB};
use touchdown_core::sample::Sample;
use touchdown_protocol::link::{Frame, Refusal};

use super::held::Held;
use super::line::{Line, LineRegisters};
use super::{Abilities, Board, record};
use crate::intake::{Incoming, Intake};
use crate::journal;
use crate::overrun::Overruns;
use crate::platform::{JournalEntry, LogStore, Platform, SampleSource};
use crate::tick::TickTask;

/// Registers of a chip that the main loop uses.
pub trait Chip: 'static {
    /// As the tick sees it.
    type Board: Board;
    /// Where drops are kept.
    type Log: LogStore;
    /// The line.
    type Port: LineRegisters;
    /// Of its core.
    const MHZ: u32;
    /// What a configuration has to fit.
    const ABILITIES: Abilities;

    /// The tick.
    fn tick() -> &'static Held<TickTask<'static, Self::Board>>;

    /// Cycle counter at the last sample.
    fn sampled() -> &'static AtomicU32;

    /// A word of the noise source; none where it fails.
    fn word(&self) -> Option<u32>;

    /// Keeps a valid configuration.
    fn store(&self, block: &[u8]) -> Result<(), Refusal>;

    /// Forgets that the watchdog has bitten.
    fn forget_reset(&self);
}

/// The chip, its line and the log.
pub struct ChipPlatform<C: Chip> {
    chip: C,
    line: Line<C::Port>,
    log: Option<C::Log>,
}

impl<C: Chip> ChipPlatform<C> {
    /// Of the parts that are up.
    pub fn new(chip: C, line: Line<C::Port>, log: Option<C::Log>) -> Self {
        Self { chip, line, log }
    }
}

impl<C: Chip> Platform for ChipPlatform<C> {
    type Board = C::Board;
    type Log = C::Log;

    fn abilities(&self) -> Abilities {
        C::ABILITIES
    }

    fn hold<T>(&mut self, act: impl FnOnce(&mut TickTask<'static, C::Board>) -> T) -> T {
        C::tick()
            .with(act)
            .unwrap_or_else(|| unreachable!("the tick is in its place, and held by one"))
    }

    fn receive(&mut self) -> Option<u8> {
        self.line.next()
    }

    fn send(&mut self, frame: &Frame) -> bool {
        self.line.send(frame)
    }

    fn is_idle(&mut self) -> bool {
        self.line.push()
    }

    fn is_sent(&mut self) -> bool {
        self.line.push() && self.line.is_done()
    }

    fn log(&mut self) -> &mut Option<C::Log> {
        &mut self.log
    }

    fn store(&mut self, block: &[u8]) -> Result<(), Refusal> {
        self.chip.store(block)
    }

    fn age_us(&mut self) -> u32 {
        DWT::cycle_count().wrapping_sub(C::sampled().load(Ordering::Relaxed)) / C::MHZ
    }

    fn unknown(&mut self) -> u64 {
        let [low, high] = [self.chip.word(), self.chip.word()].map(|it| u64::from(it.unwrap_or(0)));
        high << 32 | low
    }

    fn forget_reset(&mut self) {
        self.chip.forget_reset();
        record::clear();
    }

    fn write_down(&mut self, entry: &JournalEntry<'_>) {
        journal::entry(entry);
    }

    fn reset(&mut self) {
        SCB::sys_reset();
    }
}

/// What comes with the positions.
pub trait SampleInputs {
    /// Spin, rad/s, where it is known.
    fn spin(&mut self) -> Option<f32>;

    /// Whether levitation is commanded on, where that is wired.
    fn levitated(&self) -> Option<bool>;

    /// Whether the service input is on.
    fn service(&self) -> bool;
}

/// What a sampling interrupt has.
pub struct Sampling<S, I> {
    source: S,
    inputs: I,
    overruns: Overruns,
    intake: Intake<'static>,
}

impl<S: SampleSource, I: SampleInputs> Sampling<S, I> {
    /// Of what was not sampled yet.
    pub fn new(source: S, inputs: I, intake: Intake<'static>) -> Self {
        Self {
            source,
            inputs,
            overruns: Overruns::default(),
            intake,
        }
    }

    /// Takes what was converted; whether the outputs must be safe now.
    pub fn take(&mut self) -> bool {
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
