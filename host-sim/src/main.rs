//! The touchdown simulator.

use std::process::ExitCode;

use clap::Parser;
use touchdown_sim::cli::{self, Cli, Verdict};

fn main() -> ExitCode {
    match cli::run(Cli::parse()) {
        Ok(Verdict::Done) => ExitCode::SUCCESS,
        Ok(Verdict::DoesNotHold) => ExitCode::from(1),
        Err(failure) => {
            cli::complain(&failure);
            ExitCode::from(2)
        }
    }
}
