//! The program itself, built once for all tests of a target.

use std::path::{Path, PathBuf};
use std::process::Command;
use std::sync::OnceLock;

/// Where it is.
pub fn program() -> &'static Path {
    static PROGRAM: OnceLock<PathBuf> = OnceLock::new();
    PROGRAM.get_or_init(build)
}

/// The program, in a folder of its own.
pub fn touchdown(folder: &Path) -> assert_cmd::Command {
    let mut command = assert_cmd::Command::new(program());
    command.current_dir(folder).env("NO_COLOR", "1");
    command
}

/// What `trade` writes of this scene, without an ensemble.
///
/// # Panics
/// If it refuses the scene.
pub fn trade(scene: &str) -> serde_json::Value {
    let folder = tempfile::tempdir().expect("a folder");
    std::fs::write(folder.path().join("s.toml"), scene).expect("is written");
    let mut command = touchdown(folder.path());
    command.args(["trade", "s.toml", "--drops", "0", "--json", "a.json"]);
    command.assert().success();
    let json = std::fs::read_to_string(folder.path().join("a.json")).expect("is written");
    serde_json::from_str(&json).expect("JSON")
}

/// Cargo gives a test only the programs of its own package, so the test builds the other one, beside
/// itself: `target/<profile>/deps/<test>`. The packages are those of `cargo xtask test`, which has built it then: with
/// others, crates from elsewhere have other features, and all is built again.
fn build() -> PathBuf {
    let test = std::env::current_exe().expect("the test has a path");
    let profile = test
        .ancestors()
        .nth(2)
        .expect("deps is in a profile's folder");
    let target = profile.parent().expect("the profile's folder is in target");
    let mut cargo = Command::new(std::env::var_os("CARGO").unwrap_or_else(|| "cargo".into()));
    cargo.args([
        "test",
        "--quiet",
        "--no-run",
        "--workspace",
        "--exclude=xtask",
        "--test",
        "program",
    ]);
    match profile.file_name().and_then(|name| name.to_str()) {
        Some("debug") | None => {}
        Some(other) => drop(cargo.args(["--profile", other])),
    }
    let built = cargo
        .arg("--target-dir")
        .arg(target)
        .current_dir(env!("CARGO_MANIFEST_DIR"))
        .status()
        .expect("cargo runs");
    assert!(built.success(), "the program does not build");
    profile
        .join("touchdown")
        .with_extension(std::env::consts::EXE_EXTENSION)
}
