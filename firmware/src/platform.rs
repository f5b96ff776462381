//! What the main loop asks of a board. All that a port writes is in a folder under `board`.

use embedded_storage::nor_flash::MultiwriteNorFlash;
use touchdown_core::event::Notice;
use touchdown_core::forecast::ForecastTask;
use touchdown_core::sample::CHANNELS;
use touchdown_protocol::controller::{Cause, Faults, Shown};
use touchdown_protocol::link::{Frame, Log, Refusal};
use touchdown_protocol::log::block;

use crate::board::{Abilities, Board};
use crate::drop_log::DropLog;
use crate::recorder::Counted;
use crate::tick::TickTask;

/// A board below the tick.
///
/// Its sampling interrupt, of the highest priority, gives samples to [`crate::intake::Intake::take`] and takes the current off the
/// outputs where that says so. It pends an interrupt of its own below, which calls [`TickTask::step`] until nothing
/// waits. Then comes the main loop.
pub trait Platform {
    /// As the tick sees it.
    type Board: Board;
    /// Where drops are kept.
    type Log: LogStore;
    /// Samples between two rounds of the log.
    const LOG_SAMPLES: u64 = 1;

    /// What a configuration has to fit.
    fn abilities(&self) -> Abilities;

    /// Acts on what the tick works on, with the tick held off, but not the sampling.
    fn hold<T>(&mut self, act: impl FnOnce(&mut TickTask<'static, Self::Board>) -> T) -> T;

    /// The next byte of the line.
    fn receive(&mut self) -> Option<u8>;

    /// Queues a frame for the line, all of it or none; whether it had room.
    #[must_use]
    fn send(&mut self, frame: &Frame) -> bool;

    /// Whether nothing waits to be handed to the line; hands over what can be.
    fn is_idle(&mut self) -> bool;

    /// Whether all has left the line.
    fn is_sent(&mut self) -> bool;

    /// The log, where there is one.
    fn log(&mut self) -> &mut Option<Self::Log>;

    /// Keeps a valid configuration for the next start.
    fn store(&mut self, block: &[u8]) -> Result<(), Refusal>;

    /// Time since the last sample, us; 0 where nothing tells the time.
    fn age_us(&mut self) -> u32 {
        0
    }

    /// What nobody can know before; 0 without a source of it.
    fn unknown(&mut self) -> u64 {
        0
    }

    /// Forgets why it was reset, where that is kept: an order to clear was obeyed.
    fn forget_reset(&mut self) {}

    /// Starts anew; a board that stops in another way may return.
    fn reset(&mut self);

    /// Writes down what is new, where there is a journal.
    fn write_down(&mut self, _entry: &JournalEntry<'_>) {}

    /// After the slice of the forecast that follows a sample.
    fn after_slice(&mut self, _forecast: &ForecastTask) {}

    /// Whether no more samples come, so that the log need not wait.
    fn is_over(&self) -> bool {
        false
    }

    /// All that follows from the first `samples` is done.
    fn done(&mut self, _samples: u64) {}
}

/// Where samples come from: a converter of the chip's own, or one on a bus.
pub trait SampleSource {
    /// Starts sampling.
    fn start(&self);

    /// Number of the newest sample that has begun, modulo 2^16, as hardware counts.
    fn number(&self) -> u16;

    /// What was just converted; none where the converter fails.
    fn take(&mut self) -> Option<[u16; CHANNELS]>;
}

/// Of a board's journal.
pub enum JournalEntry<'a> {
    /// What the monitor says.
    Notice(&'a Notice),
    /// Outputs, mode and cause, where they changed.
    Shown(Shown),
    /// The latched faults, where they changed.
    Faults(Faults),
}

/// A drop log, of any size.
pub trait LogStore: Log {
    /// Writes or erases once at most, if the flash is ready for it; whether there may be more to do.
    fn work(
        &mut self,
        counted: Counted,
        latched: Option<Cause>,
        fetch: impl FnOnce() -> Option<block::Block>,
    ) -> bool;
}

impl<F: Ready, const SLOTS: usize> LogStore for DropLog<F, SLOTS> {
    fn work(
        &mut self,
        counted: Counted,
        latched: Option<Cause>,
        fetch: impl FnOnce() -> Option<block::Block>,
    ) -> bool {
        !self.flash().is_ready() || self.work(counted, latched, fetch).unwrap_or(false)
    }
}

/// Flash that tells whether it is ready, so that nobody waits for it.
pub trait Ready: MultiwriteNorFlash {
    /// Whether it is.
    fn is_ready(&mut self) -> bool;
}
