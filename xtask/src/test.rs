//! Runs every test on the desktop, those that need the emulator included.

use std::io::{self, BufRead, BufReader};
use std::process::{Command, ExitStatus};
use std::thread;

use anyhow::{Context, ensure};

use crate::tally::Tally;
use crate::{files, toolchain, workspace};

/// All packages but this one: crates from elsewhere have the features that any of the chosen packages asks for, and this
/// one is already built with those that it asks for.
pub const OTHERS: &[&str] = &["--workspace", "--exclude=xtask"];
const PACKAGES: [&[&str]; 2] = [OTHERS, &["--package=xtask"]];
/// Without it the campaigns, which are examples, would be built as well.
const TESTS: &str = "--tests";

/// Builds all tests.
pub fn build() -> anyhow::Result<()> {
    for packages in PACKAGES {
        let mut cargo = cargo_test(packages);
        cargo.args([TESTS, "--no-run"]);
        toolchain::run(&mut cargo, "the tests do not build")?;
    }
    Ok(())
}

/// Runs all tests; fails if one fails or if a layer ran none.
pub fn run() -> anyhow::Result<()> {
    let (mut tally, mut late) = (Tally::default(), Vec::new());
    let mut print = |line: &str| {
        println!("{line}");
        tally.take(line);
    };
    // Beside each other: the last test of a layer leaves a processor idle.
    let [others, own] = PACKAGES;
    let statuses = thread::scope(|scope| {
        let own = scope.spawn(|| run_each(own, |line| late.push(line.to_owned())));
        let others = run_each(others, &mut print);
        [others, own.join().expect("it does not panic")]
    });
    late.iter().for_each(|line| print(line));
    println!("{} passed, {} failed", tally.passed, tally.failed);

    let empty = tally.empty_layers();
    ensure!(empty.is_empty(), "ran no tests: {}", empty.join(", "));
    let silent = tally.silent(claims()?);
    ensure!(silent.is_empty(), "ran no tests: {}", silent.join(", "));
    for status in statuses {
        let status = status?;
        ensure!(status.success(), "cargo test failed ({status})");
    }
    Ok(())
}

/// Gives `take` each line that the tests print.
fn run_each(packages: &[&str], mut take: impl FnMut(&str)) -> anyhow::Result<ExitStatus> {
    // One pipe for both, so that cargo's headings stay before the results below them.
    let (reader, writer) = io::pipe()?;
    let mut cargo = cargo_test(packages);
    cargo.args([TESTS, "--no-fail-fast"]);
    cargo.stdout(writer.try_clone()?).stderr(writer);
    let mut child = cargo.spawn().context("cannot start cargo")?;
    // It holds the writing ends, without which reading would never end.
    drop(cargo);
    for line in BufReader::new(reader).lines() {
        take(&line?);
    }
    Ok(child.wait()?)
}

/// `cargo test` of these packages.
pub fn cargo_test(packages: &[&str]) -> Command {
    let mut cargo = toolchain::default_cargo();
    cargo.arg("test").args(packages);
    cargo.current_dir(workspace());
    cargo
}

/// The files of `tests/claims`: target, as cargo calls it, and module.
fn claims() -> anyhow::Result<Vec<(String, String)>> {
    let folder = workspace().join("tests");
    let mut claims = Vec::new();
    for file in files::below(&folder.join("claims"), "rs")? {
        let target = file.with_file_name("main.rs");
        if file != target {
            let target = target.strip_prefix(&folder)?.display().to_string();
            let module = file.file_stem().unwrap_or_default();
            claims.push((target, module.to_string_lossy().into_owned()));
        }
    }
    Ok(claims)
}
