//! The touchdown simulator.

use std::process::ExitCode;

use clap::Parser;
use touchdown_sim::cli::{self, Cli};

fn main() -> ExitCode {
    match cli::run(Cli::parse()) {
        Ok(()) => ExitCode::SUCCESS,
        Err(failure) => {
            cli::complain(&failure);
            ExitCode::from(failure.status())
        }
    }
}
