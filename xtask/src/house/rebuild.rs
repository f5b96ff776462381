//! How long the program takes to build again after a line of the detector has changed.

use std::path::Path;
use std::time::Duration;

use anyhow::{Context, ensure};
use nix::sys::resource::{UsageWho, getrusage};
use nix::sys::time::TimeValLike;

use crate::faults::{Tree, faults};
use crate::toolchain::default_cargo;
use crate::workspace;

/// Where the line is: a planted fault is one that compiles.
const DETECTOR: &str = "shared/core/src/detect/";
/// What is built, as for every day.
const BUILD: [&str; 6] = [
    "build",
    "--quiet",
    "--profile",
    "quick",
    "-p",
    "touchdown-sim",
];

/// Processor time of that build. It changes a copy of the sources.
pub fn time() -> anyhow::Result<Duration> {
    let folder = workspace().join("target/rebuild");
    let target = folder.join("build");
    let tree = Tree::copy(workspace(), &folder.join("tree"))?;
    println!("Rebuild: building the program, then once more with another line in the detector");
    build(tree.folder(), &target)?;
    let faults = faults()?;
    let line = faults.iter().find(|it| it.file.starts_with(DETECTOR));
    let changed = tree.plant(line.context("no planted fault is in the detector")?)?;
    let time = build(tree.folder(), &target)?;
    drop(changed);
    Ok(time)
}

/// Processor time that a build in `tree` takes.
fn build(tree: &Path, target: &Path) -> anyhow::Result<Duration> {
    let before = of_children()?;
    let status = default_cargo()
        .args(BUILD)
        .env("CARGO_TARGET_DIR", target)
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
