//! Counts the instructions of the model on the emulated target, and writes the tables.

use anyhow::{Context, ensure};

use crate::toolchain::default_cargo;
use crate::workspace;

/// Runs the test that checks the tables, told to write them: one way to count for both.
pub fn count() -> anyhow::Result<()> {
    println!("Instructions: counting");
    let status = default_cargo()
        .args([
            "test",
            "--quiet",
            "--release",
            "--package",
            "touchdown-tests",
        ])
        .args(["--test", "chip", "--", "--exact"])
        .arg("instructions::tables_are_current_and_counts_repeat")
        .env("TOUCHDOWN_WRITE_TABLES", "1")
        .current_dir(workspace())
        .status()
        .context("cannot start cargo")?;
    ensure!(status.success(), "counting failed ({status})");
    println!("  host-sim/data/instructions.csv\n  host-sim/data/functions.csv");
    Ok(())
}
