//! Builds the images, and says how much of the chip they take.

use std::env;
use std::fs;
use std::path::{Path, PathBuf};

use anyhow::{Context, ensure};
use object::{Object, ObjectSection, ObjectSymbol, SectionFlags, elf};

use crate::machine::Machine;
use crate::toolchain::TARGET;
use crate::workspace;

/// For chip and emulator.
const IMAGES: [&str; 4] = [
    "touchdown-firmware",
    "touchdown-qemu",
    "touchdown-count-tick",
    "touchdown-crash",
];
/// The budget looks at it; without a stack, as it is never run.
const NEVER_RUN: &str = "touchdown-tick";
/// Their profile: small below the tick, fast in it.
const PROFILE: &str = "firmware";
/// They count what the model costs, as fast as it can be.
const COUNTING: [&str; 2] = ["touchdown-count-rigid", "touchdown-count"];
/// Profile of these.
const FASTEST: &str = "release";
/// Folder of the first of these, built without the other rungs in the library, for comparison.
const WITHOUT_RUNGS: &str = "without-rungs";
const RAM_START: u64 = 0x2000_0000;

/// Builds all images.
pub fn build() -> anyhow::Result<()> {
    println!("Firmware: building for {TARGET}");
    let images = images();
    let without = images.join(WITHOUT_RUNGS);
    fs::create_dir_all(&without).context("cannot make a folder for images")?;
    let counting = folder(FASTEST);
    let copy = |name: &str, to: &Path| {
        let copied = fs::copy(counting.join(name), to.join(name));
        copied.context("cannot copy an image").map(|_| ())
    };
    // This one first: the other takes its name.
    cargo(FASTEST, &COUNTING[..1], &["--no-default-features"])?;
    copy(COUNTING[0], &without)?;
    cargo(FASTEST, &COUNTING, &[])?;
    for name in COUNTING {
        copy(name, &images)?;
    }
    cargo(PROFILE, &[&IMAGES[..], &[NEVER_RUN]].concat(), &[])?;
    for name in IMAGES.iter().chain(&COUNTING) {
        let image = images.join(name);
        let (flash, ram) = size(&image)?;
        println!(
            "  {}: {flash} bytes of flash, {ram} bytes of RAM and the stack",
            image.display()
        );
    }
    Ok(())
}

/// Folder of images with faults planted, which the checks of the budget must find.
pub const PLANTED: &str = "planted";

/// Builds the images that the budget looks at with a panic, an f64 and a slow path planted.
pub fn build_planted() -> anyhow::Result<()> {
    let names = ["touchdown-tick", "touchdown-count-tick"];
    cargo(PROFILE, &names, &["--features", "plants"])?;
    let planted = images().join(PLANTED);
    fs::create_dir_all(&planted).context("cannot make a folder for images")?;
    for name in names {
        fs::copy(images().join(name), planted.join(name)).context("cannot copy an image")?;
    }
    Ok(())
}

/// What an image is built with besides.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Extra {
    /// Nothing.
    None,
    /// A section that tells each function's stack.
    StackSizes,
}

/// Builds one image.
pub fn build_one(name: &str, extra: Extra) -> anyhow::Result<()> {
    let mut cargo = Machine::look().toolchain.cargo("rustc");
    cargo.args([
        "--quiet",
        "--profile",
        PROFILE,
        "--package",
        "touchdown-firmware",
    ]);
    cargo.args(["--bin", name]).current_dir(workspace());
    if extra == Extra::StackSizes {
        // The flag is for nightly compilers; this one is stable.
        cargo.env("RUSTC_BOOTSTRAP", "1");
        cargo.args(["--", "-Zemit-stack-sizes"]);
    }
    let status = cargo.status().context("cannot start cargo")?;
    ensure!(status.success(), "{name} does not build ({status})");
    Ok(())
}

/// Folder of the images.
pub fn images() -> PathBuf {
    folder(PROFILE)
}

fn folder(profile: &str) -> PathBuf {
    target_directory().join(TARGET).join(profile)
}

fn cargo(profile: &str, images: &[&str], arguments: &[&str]) -> anyhow::Result<()> {
    let status = Machine::look()
        .toolchain
        .cargo("build")
        .args(["--quiet", "--profile", profile])
        .args(["--package", "touchdown-firmware"])
        .args(images.iter().flat_map(|name| ["--bin", *name]))
        .args(arguments)
        .current_dir(workspace())
        .status()
        .context("cannot start cargo for the firmware: `cargo xtask setup` installs it")?;
    ensure!(status.success(), "the firmware does not build ({status})");
    Ok(())
}

fn target_directory() -> PathBuf {
    env::var_os("CARGO_TARGET_DIR").map_or_else(|| workspace().join("target"), PathBuf::from)
}

/// Flash and RAM that an image takes, bytes.
pub fn size(image: &Path) -> anyhow::Result<(u64, u64)> {
    let bytes = fs::read(image).with_context(|| format!("cannot read {}", image.display()))?;
    let file = object::File::parse(&*bytes)?;
    let stack = file.symbols().find(|it| it.name() == Ok("_stack_start"));
    let stack = stack.context("the image has no stack")?.address();
    let (mut flash, mut ram) = (0, 0);
    for section in file.sections() {
        let SectionFlags::Elf { sh_flags } = section.flags() else {
            continue;
        };
        if sh_flags & u64::from(elf::SHF_ALLOC) == 0 {
            continue;
        }
        let in_ram = section.address() >= RAM_START;
        ensure!(
            !in_ram || section.size() == 0 || section.address() >= stack,
            "{}: data lie below the stack, which could overflow unseen",
            image.display()
        );
        let in_flash = !in_ram || section.kind() == object::SectionKind::Data;
        ram += if in_ram { section.size() } else { 0 };
        flash += if in_flash { section.size() } else { 0 };
    }
    Ok((flash, ram))
}
