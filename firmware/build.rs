//! Puts the memory map where the linker looks, and names the linker scripts, for the target only.

use std::env;
use std::error::Error;
use std::fs;
use std::path::Path;

/// What starts on the chip; `touchdown-tick` never does.
const IMAGES: [&str; 5] = [
    "touchdown-firmware",
    "touchdown-qemu",
    "touchdown-crash",
    "touchdown-count-tick",
    "touchdown-g474",
];

fn main() -> Result<(), Box<dyn Error>> {
    let is_g474 = env::var_os("CARGO_FEATURE_G474").is_some();
    let map = if is_g474 {
        "src/board/g474/memory.x"
    } else {
        "../memory.x"
    };
    println!("cargo::rerun-if-changed={map}");
    if env::var("CARGO_CFG_TARGET_OS")? != "none" {
        return Ok(());
    }
    // The linker runs in the workspace's root or elsewhere, as cargo likes.
    let out = env::var("OUT_DIR")?;
    fs::copy(map, Path::new(&out).join("memory.x"))?;
    println!("cargo::rustc-link-search={out}");
    for name in IMAGES {
        println!("cargo::rustc-link-arg-bin={name}=-Tlink.x");
        println!("cargo::rustc-link-arg-bin={name}=-Tdefmt.x");
    }
    Ok(())
}
