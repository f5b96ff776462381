//! Checks the image against the chip's flash map, and programs it by probe-rs.

mod chip;
mod image;

use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

use anyhow::{Context, ensure};

use self::chip::{Chip, sectors, shown};
use crate::machine::finds;
use crate::{firmware, workspace};

/// The image for silicon.
const IMAGE: &str = "touchdown-firmware";

/// Checks `image`, by default that of `cargo xtask firmware`, and unless `dry` programs and starts it.
pub fn run(image: Option<PathBuf>, chip: &str, dry: bool) -> anyhow::Result<()> {
    let image = image.unwrap_or_else(|| firmware::images().join(IMAGE));
    check(&image)?;
    if dry {
        return Ok(());
    }
    ensure!(
        finds("probe-rs"),
        "the image fits, but there is no probe-rs to program it: `cargo install probe-rs-tools --locked`, or see \
         https://probe.rs"
    );
    for arguments in [&["download", "--verify"][..], &["reset"]] {
        let mut command = Command::new("probe-rs");
        command.args(arguments).args(["--chip", chip]);
        if arguments[0] == "download" {
            command.arg(&image);
        }
        println!("+ {command:?}");
        let status = command.status().context("cannot start probe-rs")?;
        ensure!(status.success(), "probe-rs failed ({status})");
    }
    Ok(())
}

fn check(image: &Path) -> anyhow::Result<()> {
    let elf = fs::read(image).with_context(|| {
        let image = image.display();
        format!("cannot read {image}: `cargo xtask firmware` builds it")
    })?;
    let memory_x = fs::read_to_string(workspace().join("memory.x"))?;
    let chip = Chip::of(&memory_x)?;
    let layout = image::check(&elf, &chip).with_context(|| format!("{}", image.display()))?;
    println!("{} fits {}:", image.display(), shown(&chip.flash));
    for range in &layout.programmed {
        println!("  {}, {} bytes", shown(range), range.end - range.start);
    }
    let erased = sectors().enumerate().filter(|(_, sector)| {
        let mut programmed = layout.programmed.iter();
        programmed.any(|it| it.start < sector.end && sector.start < it.end)
    });
    let erased: Vec<_> = erased.map(|(number, _)| number.to_string()).collect();
    println!(
        "  sectors {} are erased; it starts at {:#010x}",
        erased.join(", "),
        layout.start
    );
    Ok(())
}
