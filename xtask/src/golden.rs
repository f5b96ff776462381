//! Writes anew what tests hold, by these tests.

use crate::test::OTHERS;
use crate::toolchain::{default_cargo, run as run_cargo};

/// The expected texts; before them the streams, if `streams`.
pub fn run(streams: bool) -> anyhow::Result<()> {
    if streams {
        cargo(&["run", "-ptouchdown-tests", "--example=golden_streams"])?;
    }
    let targets = ["--test=golden", "--test=golden_controller"];
    cargo(&[&["test"], OTHERS, &targets].concat())?;
    println!("`git diff` shows what has changed");
    Ok(())
}

fn cargo(arguments: &[&str]) -> anyhow::Result<()> {
    let failure = format!("cargo {} failed", arguments.join(" "));
    let mut cargo = default_cargo();
    run_cargo(cargo.args(arguments).env("UPDATE_EXPECT", "1"), &failure)
}

/// The model's instructions, counted on the emulated target.
pub fn instructions() -> anyhow::Result<()> {
    println!("Instructions: counting");
    let mut cargo = default_cargo();
    cargo.args(["test", "--quiet", "--release", "-p", "touchdown-tests"]);
    cargo.args(["--test", "chip", "--", "--exact"]);
    cargo.arg("instructions::tables_are_current");
    run_cargo(cargo.env("TOUCHDOWN_WRITE_TABLES", "1"), "counting failed")?;
    println!("  host-sim/data/instructions.csv\n  host-sim/data/functions.csv");
    Ok(())
}
