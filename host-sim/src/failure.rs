//! Why a command could not do what it was asked.

use std::io;

use miette::Diagnostic;
use thiserror::Error;

use crate::input_error::{InputError, reason};

/// Ends a command with exit status 2.
#[derive(Debug, Error, Diagnostic)]
pub enum Failure {
    /// A scene or stream that cannot be used.
    #[error(transparent)]
    #[diagnostic(transparent)]
    Input(#[from] InputError),
    /// A file that cannot be written.
    #[error("{file}: cannot be written: {}", reason(.error))]
    Output {
        /// The file.
        file: String,
        /// Why.
        error: io::Error,
    },
    /// Options that contradict each other.
    #[error("{0}")]
    Usage(String),
    /// The place where the detector should run is not ready.
    #[error("{0}")]
    Target(String),
}

impl Failure {
    /// For `map_err` on writing `file`.
    pub fn output(file: &str) -> impl Fn(io::Error) -> Self + '_ {
        move |error| Self::Output {
            file: file.to_owned(),
            error,
        }
    }
}
