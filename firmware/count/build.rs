//! Names the linker's scripts, for the target only.

use std::env;
use std::error::Error;

fn main() -> Result<(), Box<dyn Error>> {
    println!("cargo::rerun-if-changed=build.rs");
    if env::var("CARGO_CFG_TARGET_OS")? == "none" {
        // Of the memory map, which is the workspace's.
        let here = env::var("CARGO_MANIFEST_DIR")?;
        println!("cargo::rustc-link-search={here}/../..");
        println!("cargo::rustc-link-arg-bins=-Tlink.x");
        println!("cargo::rustc-link-arg-bins=-Tdefmt.x");
    }
    Ok(())
}
