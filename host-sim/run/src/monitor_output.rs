//! What the monitor said over a run.

use touchdown_core::event::Notice;
use touchdown_core::monitor::Summary;
use touchdown_core::severity::Severity;

/// Notices that are kept; a recording of any length has to fit.
const MOST_NOTICES: usize = 100_000;

/// What the monitor said over a run.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct MonitorOutput {
    /// In the order of the ticks.
    pub notices: Vec<Notice>,
    /// Later ones, counted.
    pub left_out: u64,
    /// Of the last drop in it.
    pub severity: Severity,
    /// Last.
    pub summary: Summary,
    /// What the target printed.
    pub log: Vec<String>,
}

impl MonitorOutput {
    /// Takes the next notice, while there is room.
    pub(crate) fn hear(&mut self, notice: Notice) {
        if self.notices.len() < MOST_NOTICES {
            self.notices.push(notice);
        } else {
            self.left_out += 1;
        }
    }
}
