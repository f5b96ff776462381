//! Writes anew what the golden tests hold.

use crate::test::OTHERS;
use crate::toolchain::{default_cargo, run as run_cargo};

/// The expected texts; before them the streams, if `streams`.
pub fn run(streams: bool) -> anyhow::Result<()> {
    if streams {
        cargo(&[
            "run",
            "-p",
            "touchdown-tests",
            "--example",
            "golden_streams",
        ])?;
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
