//! Names the linker's scripts and the compiler, for the target only.

use std::env;
use std::error::Error;
use std::process::Command;

fn main() -> Result<(), Box<dyn Error>> {
    println!("cargo::rerun-if-changed=build.rs");
    if env::var("CARGO_CFG_TARGET_OS")? != "none" {
        return Ok(());
    }
    let compiler = Command::new(env::var("RUSTC")?).arg("--version").output()?;
    println!(
        "cargo::rustc-env=COMPILER={}",
        String::from_utf8(compiler.stdout)?.trim()
    );
    // Of the memory map, which is the workspace's.
    println!(
        "cargo::rustc-link-search={}/../..",
        env::var("CARGO_MANIFEST_DIR")?
    );
    println!("cargo::rustc-link-arg-bins=-Tlink.x");
    println!("cargo::rustc-link-arg-bins=-Tdefmt.x");
    Ok(())
}
