//! How long the program takes to build again after a line of the detector has changed.

use std::path::Path;
use std::time::Duration;

use anyhow::{Context, ensure};
use nix::sys::resource::{UsageWho, getrusage};
use nix::sys::time::TimeValLike;

use super::layers::{Member, members};
use crate::faults::{faults, tree};
use crate::test;
use crate::toolchain::default_cargo;
use crate::workspace;

/// Where the line is: a planted fault is one that compiles.
const DETECTOR: &str = "shared/core/src/detect/";
/// What profile `quick` sets for the crates of the workspace.
const QUICK: [&str; 4] = [
    "opt-level=3",
    "codegen-units=16",
    "debug-assertions=false",
    "overflow-checks=false",
];

/// Processor time of that build. It changes a copy of the sources.
///
/// Crates from elsewhere are not built again after a change: they are those that the tests have built, in profile `dev`.
/// A test of the program stands for it, as the program itself would take the place of the user's own.
pub fn time() -> anyhow::Result<Duration> {
    let copy = workspace().join("target/rebuild");
    tree::copy(workspace(), &copy)?;
    println!("Rebuild: building the program, then once more with another line in the detector");
    let members = members()?;
    build(&copy, &members)?;
    let faults = faults()?;
    let line = faults.iter().find(|it| it.file.starts_with(DETECTOR));
    let line = line.context("no planted fault is in the detector")?;
    let _changed = tree::plant(line, &copy)?;
    build(&copy, &members)
}

/// Processor time that a build in `tree` takes, its `members` as by profile `quick`.
fn build(tree: &Path, members: &[Member]) -> anyhow::Result<Duration> {
    let mut cargo = default_cargo();
    cargo.args(["test", "--no-run", "--quiet", "--bin", "touchdown"]);
    cargo.args(test::OTHERS);
    for member in members {
        for setting in QUICK {
            cargo.arg("--config");
            cargo.arg(format!("profile.dev.package.{}.{setting}", member.name));
        }
    }
    let before = of_children()?;
    let status = cargo
        .env("CARGO_TARGET_DIR", workspace().join("target"))
        // The profile is incremental, whatever else is built without.
        .env("CARGO_INCREMENTAL", "1")
        .current_dir(tree)
        .status()
        .context("cannot start cargo")?;
    ensure!(status.success(), "the program does not build ({status})");
    Ok(of_children()? - before)
}

/// Processor time of all processes that have ended so far.
fn of_children() -> anyhow::Result<Duration> {
    let usage = getrusage(UsageWho::RUSAGE_CHILDREN)?;
    let micros = (usage.user_time() + usage.system_time()).num_microseconds();
    Ok(Duration::from_micros(micros.try_into()?))
}
