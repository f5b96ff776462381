//! Runs every test on the desktop, those that need the emulator included.

use std::io::{self, BufRead, BufReader};

use anyhow::{Context, ensure};

use crate::tally::Tally;
use crate::toolchain::default_cargo;
use crate::workspace;

/// Runs all tests; fails if one fails or if a layer ran none.
pub fn run() -> anyhow::Result<()> {
    println!("Tests: building");
    // One pipe for both, so that cargo's headings stay before the results below them.
    let (reader, writer) = io::pipe()?;
    let mut cargo = default_cargo();
    cargo
        .args(["test", "--workspace", "--no-fail-fast"])
        .current_dir(workspace())
        .stdout(writer.try_clone()?)
        .stderr(writer);
    let mut child = cargo.spawn().context("cannot start cargo")?;
    // It holds the writing ends, without which reading would never end.
    drop(cargo);

    let mut tally = Tally::default();
    for line in BufReader::new(reader).lines() {
        let line = line?;
        println!("{line}");
        tally.take(&line);
    }
    let status = child.wait()?;
    println!("{} passed, {} failed", tally.passed, tally.failed);

    let empty = tally.empty_layers();
    ensure!(empty.is_empty(), "ran no tests: {}", empty.join(", "));
    ensure!(tally.layers() > 0, "ran no test layer at all");
    ensure!(status.success(), "cargo test failed ({status})");
    Ok(())
}
