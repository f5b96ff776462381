//! Progress of a long run, on the terminal.

use std::io::IsTerminal;
use std::time::{Duration, Instant};

use indicatif::{ProgressBar, ProgressStyle};

/// A run shorter than this shows nothing.
const QUIET: Duration = Duration::from_secs(2);
/// Samples between two looks at the clock.
const LOOK: u64 = 16_384;

/// Shows how far a run is; nothing where standard error is no terminal.
pub struct Progress {
    what: &'static str,
    /// Samples or jobs in all; 0 if not known.
    total: u64,
    done: u64,
    /// Of these between two looks at the clock.
    look: u64,
    start: Instant,
    bar: Option<ProgressBar>,
    terminal: bool,
    style: &'static str,
}

const JOBS: &str = "{msg} {wide_bar} {percent} %, {eta} left";
const BYTES: &str = "{msg} {wide_bar} {bytes} of {total_bytes}, {eta} left";

impl Progress {
    /// Starts the clock.
    pub fn new(what: &'static str, total: u64) -> Self {
        Self {
            what,
            total,
            done: 0,
            look: LOOK,
            start: Instant::now(),
            bar: None,
            terminal: std::io::stderr().is_terminal(),
            style: JOBS,
        }
    }

    /// Of a file of `total` bytes; what is counted is its rows.
    pub fn of_bytes(what: &'static str, total: u64) -> Self {
        let mut progress = Self::new(what, total);
        progress.style = BYTES;
        progress
    }

    /// Of jobs that each take long enough for a look at the clock.
    pub fn of_jobs(what: &'static str, total: u64) -> Self {
        let mut progress = Self::new(what, total);
        progress.look = 1;
        progress
    }

    /// One more is through.
    pub fn advance(&mut self) {
        self.at(self.done + 1);
    }

    /// `done` are through.
    pub fn at(&mut self, done: u64) {
        self.done = done;
        self.passed(done, || done);
    }

    /// So many rows are through; `place` is where in the total that is.
    pub fn passed(&mut self, rows: u64, place: impl FnOnce() -> u64) {
        if !self.terminal || !rows.is_multiple_of(self.look) {
            return;
        }
        if self.bar.is_none() && self.start.elapsed() > QUIET {
            self.bar = Some(styled(self.what, self.total, self.style));
        }
        if let Some(bar) = &self.bar {
            bar.set_position(place());
        }
    }
}

/// A bar of `total` parts; draws on a terminal only.
pub fn bar(what: &'static str, total: u64) -> ProgressBar {
    styled(what, total, JOBS)
}

fn styled(what: &'static str, total: u64, style: &str) -> ProgressBar {
    if total == 0 {
        return ProgressBar::new_spinner().with_message(what);
    }
    let style =
        ProgressStyle::with_template(style).unwrap_or_else(|_| ProgressStyle::default_bar());
    ProgressBar::new(total).with_style(style).with_message(what)
}

impl Drop for Progress {
    fn drop(&mut self) {
        if let Some(bar) = &self.bar {
            bar.finish_and_clear();
        }
    }
}
