//! Progress of a long run, on the terminal.

use std::time::Duration;

use indicatif::{ProgressBar, ProgressFinish, ProgressStyle};

/// A run shorter than this shows nothing.
const QUIET: Duration = Duration::from_secs(2);
/// Samples between two looks at the clock.
const LOOK: u64 = 16_384;

/// Shows how far a run is; nothing where standard error is no terminal.
pub struct Progress {
    bar: ProgressBar,
    done: u64,
    /// Samples or jobs between two looks at the clock.
    look: u64,
}

const JOBS: &str = "{msg} {wide_bar} {percent} %, {eta} left";
const BYTES: &str = "{msg} {wide_bar} {bytes} of {total_bytes}, {eta} left";

impl Progress {
    /// Starts the clock; `total` samples, 0 if not known.
    pub fn new(what: &'static str, total: u64) -> Self {
        Self::of(bar(what, total), LOOK)
    }

    /// Of a file of `total` bytes; what is counted is its rows.
    pub fn of_bytes(what: &'static str, total: u64) -> Self {
        Self::of(styled(what, total, BYTES), LOOK)
    }

    /// Of jobs that each take long enough for a look at the clock.
    pub fn of_jobs(what: &'static str, total: u64) -> Self {
        Self::of(bar(what, total), 1)
    }

    fn of(bar: ProgressBar, look: u64) -> Self {
        Self { bar, done: 0, look }
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
    pub fn passed(&self, rows: u64, place: impl FnOnce() -> u64) {
        if rows.is_multiple_of(self.look) && self.bar.elapsed() > QUIET {
            self.bar.set_position(place());
        }
    }
}

/// A bar of `total` parts, until it is dropped; draws on a terminal only.
pub fn bar(what: &'static str, total: u64) -> ProgressBar {
    styled(what, total, JOBS)
}

fn styled(what: &'static str, total: u64, style: &str) -> ProgressBar {
    let bar = if total == 0 {
        ProgressBar::new_spinner()
    } else {
        let style = ProgressStyle::with_template(style);
        ProgressBar::new(total).with_style(style.unwrap_or_else(|_| ProgressStyle::default_bar()))
    };
    bar.with_message(what).with_finish(ProgressFinish::AndClear)
}
