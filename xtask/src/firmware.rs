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

/// An image: its package, name and profile.
struct Image {
    package: &'static str,
    name: &'static str,
    profile: &'static str,
    /// Of cargo besides.
    arguments: &'static [&'static str],
}

const FIRMWARE: &str = "touchdown-firmware";
/// Small below the tick, fast in it.
const PROFILE: &str = "firmware";
/// As fast as can be: for what the model costs.
const FASTEST: &str = "release";

/// All images that run.
const IMAGES: [Image; 6] = [
    Image {
        arguments: &["--features", "g474"],
        ..image(FIRMWARE, "touchdown-g474", PROFILE)
    },
    image(FIRMWARE, "touchdown-firmware", PROFILE),
    image(FIRMWARE, "touchdown-qemu", PROFILE),
    image(FIRMWARE, "touchdown-crash", PROFILE),
    image(FIRMWARE, "touchdown-count-tick", PROFILE),
    Image {
        arguments: &["--features", "image"],
        ..image("touchdown-count", "touchdown-count", FASTEST)
    },
];
/// The budget looks at it; without a stack, as it is never run.
const NEVER_RUN: Image = image(FIRMWARE, "touchdown-tick", PROFILE);
/// The emulator's plugin that models cycles.
const PLUGIN: &str = "touchdown-cycles";
/// Program flash: below lies the code that the linker left out, above is RAM.
pub const FLASH: Range<u64> = 0x0800_0000..0x0810_0000;
const RAM_START: u64 = 0x2000_0000;

const fn image(package: &'static str, name: &'static str, profile: &'static str) -> Image {
    Image {
        package,
        name,
        profile,
        arguments: &["--features", "f405"],
    }
}

/// Builds all images, or one.
pub fn build(only: Option<&str>) -> anyhow::Result<()> {
    println!("Firmware: building for {TARGET}");
    let is_wanted = |image: &&Image| only.is_none_or(|it| it == image.name);
    for image in IMAGES.iter().chain([&NEVER_RUN]).filter(is_wanted) {
        cargo(image, &[])?;
        if image.profile != PROFILE {
            let from = folder(image.profile).join(image.name);
            fs::copy(from, images().join(image.name)).context("cannot copy an image")?;
        }
    }
    for image in IMAGES.iter().filter(is_wanted) {
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
    for name in [NEVER_RUN.name, "touchdown-count-tick"] {
        cargo(&image(FIRMWARE, name, PROFILE), &["--features", "plants"])?;
        let built = images().join(name);
        fs::copy(built, planted.join(name)).context("cannot copy an image")?;
    }
    Ok(())
}

/// What an image is built with besides.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Extra {
    None,
    /// A section that tells each function's stack.
    StackSizes,
}

/// Builds one image, for chip or emulator.
pub fn build_one(name: &str, extra: Extra) -> anyhow::Result<()> {
    let mut all = IMAGES.iter().chain([&NEVER_RUN]);
    let known = all.find(|image| image.name == name);
    let image = known.with_context(|| format!("{name} is no image"))?;
    let mut cargo = Machine::look().toolchain.cargo("rustc");
    cargo.args(["--quiet", "--profile", PROFILE, "--package", image.package]);
    cargo.args(["--bin", name]).args(image.arguments);
    if extra == Extra::StackSizes {
        // The flag is for nightly compilers; this one is stable.
        cargo.env("RUSTC_BOOTSTRAP", "1");
        cargo.args(["--", "-Zemit-stack-sizes"]);
    }
    run(&mut cargo, &format!("{name} does not build"))
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

fn cargo(image: &Image, arguments: &[&str]) -> anyhow::Result<()> {
    let mut cargo = Machine::look().toolchain.cargo("build");
    cargo.args(["--quiet", "--profile", image.profile]);
    cargo.args(["--package", image.package, "--bin", image.name]);
    cargo.args(image.arguments);
    run(cargo.args(arguments), "the firmware does not build")?;
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
