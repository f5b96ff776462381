//! A chip below the tick, whatever its registers.

use core::sync::atomic::Ordering;

use cortex_m::peripheral::{DWT, SCB};
use touchdown_protocol::link::{Frame, Refusal};

use super::{Chip, ChipBoard, ChipLog, Line, record, slots};
use crate::board::Abilities;
use crate::journal;
use crate::platform::{JournalEntry, Platform};
use crate::tick::TickTask;

/// The chip, its line and the log.
pub struct ChipPlatform<C: Chip> {
    /// The chip.
    pub chip: C,
    /// The line.
    pub line: Line<C::Port>,
    /// The log, where there is one.
    pub log: Option<ChipLog<C>>,
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
        slots::store(&self.chip, block)
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
