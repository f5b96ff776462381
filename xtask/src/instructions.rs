//! Counts the instructions of the model on the emulated target, and writes the tables.

use crate::toolchain::{default_cargo, run};

/// Runs the test that checks the tables, told to write them: one way to count for both.
pub fn count() -> anyhow::Result<()> {
    println!("Instructions: counting");
    let mut cargo = default_cargo();
    cargo.args(["test", "--quiet", "--release", "-p", "touchdown-tests"]);
    cargo.args(["--test", "chip", "--", "--exact"]);
    cargo.arg("instructions::tables_are_current");
    run(cargo.env("TOUCHDOWN_WRITE_TABLES", "1"), "counting failed")?;
    println!("  host-sim/data/instructions.csv\n  host-sim/data/functions.csv");
    Ok(())
}
