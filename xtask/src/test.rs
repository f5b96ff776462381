//! Runs every test on the desktop, those that need the emulator included.

use std::fs;
use std::io::{self, BufRead, BufReader};

use anyhow::{Context, ensure};

use crate::tally::Tally;
use crate::toolchain::default_cargo;
use crate::workspace;

/// Runs all tests; fails if one fails or if a layer ran none.
pub fn run() -> anyhow::Result<()> {
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
    let silent = tally.silent(claims()?);
    ensure!(silent.is_empty(), "ran no tests: {}", silent.join(", "));
    ensure!(tally.layers() > 0, "ran no test layer at all");
    ensure!(status.success(), "cargo test failed ({status})");
    Ok(())
}

/// The files of `tests/claims`: target, as cargo calls it, and module.
fn claims() -> anyhow::Result<Vec<(String, String)>> {
    let mut claims = Vec::new();
    for subject in fs::read_dir(workspace().join("tests/claims"))? {
        let subject = subject?;
        let target = format!("claims/{}/main.rs", subject.file_name().to_string_lossy());
        for file in fs::read_dir(subject.path())? {
            let module = file?.path().with_extension("");
            let module = module.file_name().unwrap_or_default().to_string_lossy();
            if module != "main" {
                claims.push((target.clone(), module.into_owned()));
            }
        }
    }
    Ok(claims)
}
