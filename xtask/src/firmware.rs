//! Builds the images, and says how much of the chip they take.

use std::env::{
    self,
    consts::{DLL_PREFIX, DLL_SUFFIX},
};
use std::fs;
use std::ops::Range;
use std::path::{Path, PathBuf};

use anyhow::{Context, ensure};
use object::{Object, ObjectSection, ObjectSymbol};

use crate::image_check;
use crate::machine::Machine;
use crate::toolchain::{TARGET, default_cargo, run};
use crate::{files, workspace};

/// An image: its package, name, profile and features.
struct Image {
    package: &'static str,
    name: &'static str,
    profile: &'static str,
    features: &'static str,
}

/// Small below the tick, fast in it.
const PROFILE: &str = "firmware";
/// As fast as can be: for what the model costs.
const FASTEST: &str = "release";

/// All images.
const IMAGES: [Image; 7] = [
    image("touchdown-g474", "g474"),
    image("touchdown-firmware", "f405"),
    image("touchdown-qemu", "f405"),
    image("touchdown-crash", "f405"),
    image("touchdown-count-tick", "f405"),
    Image {
        package: "touchdown-count",
        name: "touchdown-count",
        profile: FASTEST,
        features: "image",
    },
    image(NEVER_RUN, "f405"),
];
/// The budget looks at it; without a stack, as it is never run.
const NEVER_RUN: &str = "touchdown-tick";
/// The emulator's plugin that models cycles.
const PLUGIN: &str = "touchdown-cycles";
/// Program flash: below lies the code that the linker left out, above is RAM.
pub const FLASH: Range<u64> = 0x0800_0000..0x0810_0000;
const RAM_START: u64 = 0x2000_0000;

const fn image(name: &'static str, features: &'static str) -> Image {
    Image {
        package: "touchdown-firmware",
        name,
        profile: PROFILE,
        features,
    }
}

/// Builds all images, or one.
pub fn build(only: Option<&str>) -> anyhow::Result<()> {
    println!("Firmware: building for {TARGET}");
    let is_wanted = |image: &&Image| only.is_none_or(|it| it == image.name);
    for image in IMAGES.iter().filter(is_wanted) {
        cargo(image, &[])?;
        if image.profile != PROFILE {
            let from = folder(image.profile).join(image.name);
            fs::copy(from, images().join(image.name)).context("cannot copy an image")?;
        }
    }
    let run = IMAGES.iter().filter(|it| it.name != NEVER_RUN);
    for image in run.filter(is_wanted) {
        let path = images().join(image.name);
        let (flash, ram) = size(&path)?;
        println!(
            "  {}: {flash} bytes of flash, {ram} bytes of RAM and the stack",
            path.display()
        );
    }
    Ok(())
}

/// Folder of images with faults planted, which the checks of the budget must find.
pub const PLANTED: &str = "planted";

/// Builds the images that the budget looks at with a panic, an f64 and a slow path planted.
pub fn build_planted() -> anyhow::Result<()> {
    let planted = images().join(PLANTED);
    fs::create_dir_all(&planted).context("cannot make a folder for images")?;
    for name in [NEVER_RUN, "touchdown-count-tick"] {
        cargo(&image(name, "f405,plants"), &[])?;
        fs::copy(images().join(name), planted.join(name)).context("cannot copy an image")?;
    }
    Ok(())
}

/// Of the compiler: a section that tells each function's stack.
pub const STACK_SIZES: &[&str] = &["-Zemit-stack-sizes"];

/// Builds one image, with these flags of the compiler.
pub fn build_one(name: &str, flags: &[&str]) -> anyhow::Result<()> {
    let known = IMAGES.iter().find(|image| image.name == name);
    cargo(known.with_context(|| format!("{name} is no image"))?, flags)
}

/// Builds the emulator's plugin that models cycles, for the desktop; its file.
pub fn build_plugin() -> anyhow::Result<PathBuf> {
    let mut cargo = default_cargo();
    cargo.args(["build", "--quiet", "--release", "--package", PLUGIN]);
    run(&mut cargo, "the plugin does not build")?;
    let name = format!("{DLL_PREFIX}{}{DLL_SUFFIX}", PLUGIN.replace('-', "_"));
    Ok(target_directory().join("release").join(name))
}

/// Folder of the images.
pub fn images() -> PathBuf {
    folder(PROFILE)
}

fn folder(profile: &str) -> PathBuf {
    target_directory().join(TARGET).join(profile)
}

fn cargo(image: &Image, flags: &[&str]) -> anyhow::Result<()> {
    let mut cargo = Machine::look().toolchain.cargo();
    cargo.args([
        "--quiet",
        "--profile",
        image.profile,
        "--package",
        image.package,
    ]);
    cargo.args(["--bin", image.name, "--features", image.features]);
    if !flags.is_empty() {
        // They are for nightly compilers; this one is stable.
        cargo.env("RUSTC_BOOTSTRAP", "1").arg("--").args(flags);
    }
    run(&mut cargo, &format!("{} does not build", image.name))?;
    image_check::write(&folder(image.profile).join(image.name))
}

fn target_directory() -> PathBuf {
    env::var_os("CARGO_TARGET_DIR").map_or_else(|| workspace().join("target"), PathBuf::from)
}

/// What an image holds from the flash's first address on.
pub fn flash_content(image: &Path) -> anyhow::Result<Vec<u8>> {
    let bytes = files::bytes(image)?;
    let file = object::File::parse(&*bytes)?;
    let mut content = vec![];
    for section in file.sections() {
        let Some(at) = section.address().checked_sub(FLASH.start) else {
            continue;
        };
        if section.address() < RAM_START && section.kind() != object::SectionKind::Metadata {
            let (at, data) = (at as usize, section.data()?);
            content.resize(content.len().max(at + data.len()), 0);
            content[at..at + data.len()].copy_from_slice(data);
        }
    }
    Ok(content)
}

/// Flash and RAM that an image takes, bytes.
pub fn size(image: &Path) -> anyhow::Result<(u64, u64)> {
    let bytes = files::bytes(image)?;
    let file = object::File::parse(&*bytes)?;
    let stack = file.symbols().find(|it| it.name() == Ok("_stack_start"));
    let stack = stack.context("the image has no stack")?.address();
    let (mut flash, mut ram) = (0, 0);
    for section in file.sections().filter(image_check::is_loaded) {
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
