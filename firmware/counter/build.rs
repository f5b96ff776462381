//! Names the compiler, for the target only.

use std::env;
use std::error::Error;
use std::process::Command;

fn main() -> Result<(), Box<dyn Error>> {
    println!("cargo::rerun-if-changed=build.rs");
    if env::var("CARGO_CFG_TARGET_OS")? == "none" {
        let compiler = Command::new(env::var("RUSTC")?).arg("--version").output()?;
        let compiler = String::from_utf8(compiler.stdout)?;
        println!("cargo::rustc-env=COMPILER={}", compiler.trim());
    }
    Ok(())
}
