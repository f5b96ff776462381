//! Why a command could not do what it was asked.

use std::io;

use miette::Diagnostic;
use thiserror::Error;

use crate::input_error::{InputError, reason};
use crate::plain::shown;

/// What an option's FILE means for standard output.
pub const STDOUT: &str = "-";
/// What an error calls standard output.
pub const STANDARD_OUTPUT: &str = "standard output";

/// Ends a command with [`Failure::status`].
#[derive(Debug, Error, Diagnostic)]
pub enum Failure {
    /// A scene or stream that cannot be used.
    #[error(transparent)]
    #[diagnostic(transparent)]
    Input(#[from] InputError),
    /// A file that cannot be written.
    #[error("{}: cannot be written: {}", shown(.file), reason(.error))]
    Output {
        /// The file.
        file: String,
        /// Why.
        error: io::Error,
    },
    /// Options that contradict each other.
    #[error("{}", shown(.0))]
    Usage(String),
    /// The place where the detector should run is not ready.
    #[error("{}", shown(.0))]
    Target(String),
    /// A check that the command exists for did not hold.
    #[error("{}", shown(.0))]
    Check(String),
}

impl Failure {
    /// Exit status: 1 for a check that did not hold, else 2.
    pub fn status(&self) -> u8 {
        match self {
            Self::Check(_) => 1,
            Self::Input(_) | Self::Output { .. } | Self::Usage(_) | Self::Target(_) => 2,
        }
    }

    /// For `map_err` on writing `file`.
    pub fn output(file: &str) -> impl Fn(io::Error) -> Self + '_ {
        let shown = if file == STDOUT {
            STANDARD_OUTPUT
        } else {
            file
        };
        move |error| Self::Output {
            file: shown.to_owned(),
            error,
        }
    }
}
