//! What is there: asked, never changed.

use std::env;
use std::path::PathBuf;
use std::process::Command;

use crate::toolchain::{EMULATOR_PACKAGES, TARGET, Toolchain, output};

/// What set-up has to know of the machine.
#[derive(Clone, Debug)]
pub struct Machine {
    pub toolchain: Toolchain,
    /// The default toolchain has the target's libraries.
    pub target_installed: bool,
    /// Debian packages that are needed and not there.
    pub missing_packages: Vec<&'static str>,
    pub has_apt: bool,
    /// Packages can be installed without sudo.
    pub is_root: bool,
}

impl Machine {
    pub fn look() -> Self {
        let target_installed = has_target();
        let toolchain = Toolchain::choose(target_installed, rustup_may_download());
        let needed = toolchain.packages().iter().chain(EMULATOR_PACKAGES);
        Self {
            toolchain,
            target_installed,
            missing_packages: needed.copied().filter(|name| !has_package(name)).collect(),
            has_apt: finds("apt-get"),
            is_root: answer("id", &["-u"]).is_some_and(|id| id == "0"),
        }
    }
}

/// Whether rustup is there and its own switch against downloads is not set.
fn rustup_may_download() -> bool {
    finds("rustup") && env::var_os("RUSTUP_AUTO_INSTALL").is_none_or(|value| value != "0")
}

fn has_target() -> bool {
    answer("rustc", &["--print", "target-libdir", "--target", TARGET])
        .is_some_and(|folder| PathBuf::from(folder).is_dir())
}

/// Whether a package is there, or what it is needed for came in another way.
fn has_package(name: &str) -> bool {
    match name {
        "qemu-system-arm" => finds("qemu-system-arm"),
        "lld" => finds("ld.lld"),
        _ => answer("dpkg-query", &["-W", "-f=${db:Status-Status}", name])
            .is_some_and(|status| status == "installed"),
    }
}

/// Whether a program is there.
pub fn finds(program: &str) -> bool {
    let path = env::var_os("PATH").unwrap_or_default();
    env::split_paths(&path).any(|folder| folder.join(program).is_file())
}

/// What `program` prints, if it succeeds.
fn answer(program: &str, arguments: &[&str]) -> Option<String> {
    let text = output(Command::new(program).args(arguments)).ok()?;
    Some(text.trim().to_owned())
}
