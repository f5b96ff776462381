//! Which compiler builds for the target: docs/decisions/0002-target-toolchain.md.
//!
//! All that depends on a version or a vendor of compiler and emulator is here, a function each.

use std::env;
use std::process::Command;

use anyhow::{Context, ensure};

use crate::workspace;

/// The microcontroller: Cortex-M4 with a single-precision floating-point unit.
pub const TARGET: &str = "thumbv7em-none-eabihf";
/// Debian packages of the emulator.
pub const EMULATOR_PACKAGES: &[&str] = &["qemu-system-arm"];

/// A compiler for the target.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Toolchain {
    /// The one that builds the desktop's crates, with the target added to it.
    Default,
    /// Debian's, which has no libraries for the target but their source.
    Debian,
}

impl Toolchain {
    /// The default one, unless it lacks the target and may not download it.
    pub fn choose(target_installed: bool, rustup_may_download: bool) -> Self {
        if target_installed || rustup_may_download {
            Self::Default
        } else {
            Self::Debian
        }
    }

    /// Debian packages that it needs.
    pub fn packages(self) -> &'static [&'static str] {
        match self {
            Self::Default => &[],
            Self::Debian => &["rustc-web", "cargo-web", "rust-web-src", "lld"],
        }
    }

    /// `cargo rustc` for the target, still without a package.
    pub fn cargo(self) -> Command {
        let mut cargo = match self {
            Self::Default => default_cargo(),
            Self::Debian => debian_cargo(),
        };
        cargo.args(["rustc", "--target", TARGET]);
        cargo
    }
}

/// Cargo for the desktop's crates: the one that runs this program.
pub fn default_cargo() -> Command {
    Command::new(env::var_os("CARGO").unwrap_or_else(|| "cargo".into()))
}

/// Runs cargo on the workspace; where it fails, so does this, and says `failure`.
pub fn run(cargo: &mut Command, failure: &str) -> anyhow::Result<()> {
    let status = cargo.current_dir(workspace()).status();
    let status = status
        .context("cannot start cargo: `cargo xtask setup` installs what the firmware needs")?;
    ensure!(status.success(), "{failure} ({status})");
    Ok(())
}

/// What a command prints; where it fails, so does this, and says what it told.
pub fn output(command: &mut Command) -> anyhow::Result<String> {
    let output = command.output();
    let output = output.with_context(|| format!("cannot start {command:?}"))?;
    let error = String::from_utf8_lossy(&output.stderr);
    let status = output.status;
    ensure!(status.success(), "{command:?} failed ({status})\n{error}");
    String::from_utf8(output.stdout).with_context(|| format!("{command:?}"))
}

fn debian_cargo() -> Command {
    let mut cargo = Command::new("/usr/bin/cargo");
    // rustup's cargo left these for its own compiler.
    for name in ["CARGO", "RUSTUP_TOOLCHAIN", "LD_LIBRARY_PATH"] {
        cargo.env_remove(name);
    }
    cargo
        .env("RUSTC", "/usr/bin/rustc")
        // -Zbuild-std is for nightly compilers; this one is stable.
        .env("RUSTC_BOOTSTRAP", "1")
        .env("CARGO_TARGET_THUMBV7EM_NONE_EABIHF_LINKER", "ld.lld")
        .arg("-Zbuild-std=core,compiler_builtins");
    cargo
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn installed_target_is_used_whatever_rustup_may_do() {
        assert_eq!(Toolchain::choose(true, false), Toolchain::Default);
        assert_eq!(Toolchain::choose(true, true), Toolchain::Default);
    }

    #[test]
    fn debian_builds_only_where_rustup_must_not_download() {
        assert_eq!(Toolchain::choose(false, true), Toolchain::Default);
        assert_eq!(Toolchain::choose(false, false), Toolchain::Debian);
    }
}
