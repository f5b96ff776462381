//! A chip below the tick, whatever its registers.

use core::sync::atomic::Ordering;

use cortex_m::peripheral::{DWT, SCB};
use embedded_hal::delay::DelayNs;
use touchdown_protocol::link::{Frame, Refusal};

use super::bus::SpiRegisters;
use super::inputs::InputRegisters;
use super::line::{Line, LineRegisters};
use super::silicon::{ChipBoard, ChipLog, ChipTasks, OutputRegisters, Watchdog};
use super::{Abilities, record};
use crate::journal;
use crate::platform::{JournalEntry, Platform, SampleSource};
use crate::tick::TickTask;

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
    /// Waits.
    type Wait: DelayNs + Copy;
    /// The line.
    type Port: LineRegisters;
    /// Of its core.
    const MHZ: u32;
    /// What a configuration has to fit.
    const ABILITIES: Abilities;

    /// What interrupts and main loop share.
    fn tasks() -> &'static ChipTasks<Self>;

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
    log: Option<ChipLog<C>>,
}

impl<C: Chip> ChipPlatform<C> {
    /// Of the parts that are up.
    pub fn new(chip: C, line: Line<C::Port>, log: Option<ChipLog<C>>) -> Self {
        Self { chip, line, log }
    }
}

impl<C: Chip> Platform for ChipPlatform<C> {
    type Board = ChipBoard<C>;
    type Log = ChipLog<C>;

    fn abilities(&self) -> Abilities {
        C::ABILITIES
    }

    fn hold<T>(&mut self, act: impl FnOnce(&mut TickTask<'static, ChipBoard<C>>) -> T) -> T {
        C::tasks()
            .tick
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

    fn log(&mut self) -> &mut Option<ChipLog<C>> {
        &mut self.log
    }

    fn store(&mut self, block: &[u8]) -> Result<(), Refusal> {
        self.chip.store(block)
    }

    fn age_us(&mut self) -> u32 {
        DWT::cycle_count().wrapping_sub(C::tasks().sampled.load(Ordering::Relaxed)) / C::MHZ
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
