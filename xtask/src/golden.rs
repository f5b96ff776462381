//! Writes anew what the golden tests hold.

use anyhow::{Context, ensure};

use crate::toolchain::default_cargo;
use crate::workspace;

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
    let packages = ["-p", "touchdown-core", "-p", "touchdown-firmware"];
    cargo(&[&["test"][..], &packages, &["--test", "golden"]].concat())?;
    println!("`git diff` shows what has changed");
    Ok(())
}

fn cargo(arguments: &[&str]) -> anyhow::Result<()> {
    let mut cargo = default_cargo();
    cargo
        .args(arguments)
        .env("UPDATE_EXPECT", "1")
        .current_dir(workspace());
    let status = cargo.status().context("cannot start cargo")?;
    ensure!(
        status.success(),
        "cargo {} failed ({status})",
        arguments.join(" ")
    );
    Ok(())
}
