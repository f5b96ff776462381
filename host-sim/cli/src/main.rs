//! The touchdown simulator.

use std::process::ExitCode;

use touchdown_sim::commands;

fn main() -> ExitCode {
    match commands::main() {
        Ok(()) => ExitCode::SUCCESS,
        Err(failure) => {
            commands::report_error(&failure);
            ExitCode::from(failure.status())
        }
    }
}
