//! Why the controller does not answer.

use std::fmt::Display;
use std::io::{self, ErrorKind};

use touchdown_protocol::config_block::BlockError;
use touchdown_protocol::controller::Busy;
use touchdown_protocol::link::{Refusal, VERSION};

use touchdown_base::failure::Failure;
use touchdown_base::input_error::reason;
use touchdown_base::plain::shown;

/// Why a request has no answer.
#[derive(Debug, thiserror::Error)]
pub enum LinkError {
    /// The port cannot be opened, or is gone.
    #[error("{}", of_line(.0))]
    Line(#[from] io::Error),
    /// Nothing came back.
    #[error("no answer: is a controller there, at 115 200 baud?")]
    Silent,
    /// It speaks another version.
    #[error("the controller speaks version {0} of the link, this program version {VERSION}")]
    Version(u8),
    /// It does not do what was asked.
    #[error("the controller refuses: {}", why(.0))]
    Refused(Refusal),
    /// Its configuration is none of this version.
    #[error("the controller's configuration: {0}")]
    Config(BlockError),
    /// It answers something else than was asked.
    #[error("the controller's answer makes no sense")]
    Senseless,
    /// It took another configuration, and has not been heard with it since.
    #[error("the configuration was taken, but the controller has not come back with it: {0}")]
    Away(String),
}

impl LinkError {
    /// Of a command that talked over `port`. A refusal is the controller's answer; all else is none.
    pub fn at(&self, port: &impl Display) -> Failure {
        let text = format!("{port}: {self}");
        match self {
            Self::Refused(_) => Failure::Check(text),
            _ => Failure::Target(text),
        }
    }
}

fn of_line(error: &io::Error) -> String {
    use ErrorKind::{BrokenPipe, ConnectionRefused, ConnectionReset, UnexpectedEof};
    match error.kind() {
        ConnectionRefused => "nobody is there".to_owned(),
        ConnectionReset | BrokenPipe | UnexpectedEof => "the line was closed".to_owned(),
        _ => reason(error),
    }
}

/// The reason of a refusal.
pub fn why(refusal: &Refusal) -> String {
    let text = match refusal {
        Refusal::Busy(busy) => busy_name(*busy),
        Refusal::Block => "that is no configuration of its version",
        Refusal::Parameter(name) => return format!("{} breaks its rule", shown(name)),
        Refusal::NoStore => "this board cannot keep it",
        Refusal::StoreFailed => "its flash failed",
        Refusal::NoEpisode => "there is no such episode, or it is being written",
        Refusal::NoRoom => "too few slots would be left for new episodes",
    };
    text.to_owned()
}

fn busy_name(busy: Busy) -> &'static str {
    match busy {
        Busy::DropRuns => "a drop runs",
        Busy::Blind => "no plane gives a position",
        Busy::Watching => "it watches, so the machine may run",
        Busy::Latched => "a drop is latched",
        Busy::NoRight => "no right: it takes the key of its configuration (--key-file), within 5 s",
        Busy::Service => "no right: it has no key, so its service input must be on",
        Busy::Locked => "the episode is locked",
        Busy::Last => "the episode is the newest one",
        Busy::Configuration => "the configuration is missing, damaged, or of another board: set it",
    }
}

/// The reason of a notice of an order, none where it was done.
pub fn refused_why(code: u8) -> Option<String> {
    Refusal::of_code(code).map(|it| why(&it))
}
