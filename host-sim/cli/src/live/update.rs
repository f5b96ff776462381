//! What the watcher passes on.

use touchdown_core::event::Notice;
use touchdown_protocol::config_block::Settings;
use touchdown_protocol::link::{Hello, Recent, State};
use touchdown_protocol::log::counters::Counters;
use touchdown_protocol::log::header::Header;

/// Something that was heard, and when.
#[derive(Clone, Debug, PartialEq)]
pub struct Update {
    /// Since the watcher's start, s.
    pub at: f64,
    /// What.
    pub said: Said,
}

/// What was heard.
#[derive(Clone, Debug, PartialEq)]
pub enum Said {
    /// The line is open, and a controller answers; it has this configuration.
    Connected(Hello, Settings),
    /// The line is not open any more, or cannot be opened, and why.
    Lost(String),
    /// What goes on.
    State(State),
    /// What happened.
    Notice(Notice),
    /// Where the rotor has been.
    Recent(Recent),
    /// An episode is in the log; its header, where that is whole.
    Episode(u32, Option<Header>),
    /// What was counted over the monitor's life, at first and where it has changed.
    Lifetime(Counters),
    /// So many frames came damaged on this line so far.
    Damaged(u32),
}
