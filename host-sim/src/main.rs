//! The touchdown simulator.

use std::process::ExitCode;

use touchdown_sim::cli;

fn main() -> ExitCode {
    match cli::main() {
        Ok(()) => ExitCode::SUCCESS,
        Err(failure) => {
            cli::complain(&failure);
            ExitCode::from(failure.status())
        }
    }
}
