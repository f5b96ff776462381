//! A test program that may find a fault.

use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};
use std::time::{Duration, Instant};

use anyhow::{Context, bail, ensure};
use serde_json::Value;
use wait_timeout::ChildExt;

use crate::test::OTHERS;
use crate::toolchain::default_cargo;

/// Beyond it a test hangs, and that finds a fault as well.
const LONGEST: Duration = Duration::from_secs(120);

/// Package, one target, and names of tests.
#[derive(Debug)]
pub struct Test {
    /// As it stands in the list.
    pub text: String,
    package: String,
    target: Vec<String>,
    names: Vec<String>,
}

impl Test {
    /// As it stands in the list: package, `--lib` or `--test TARGET`, then names.
    pub fn parse(text: &str) -> anyhow::Result<Self> {
        let words: Vec<String> = text.split_whitespace().map(str::to_owned).collect();
        let (package, rest) = words.split_first().context("a test names its package")?;
        let target = match rest.first().map(String::as_str) {
            Some("--lib") => 1,
            Some("--test") if rest.len() >= 2 => 2,
            _ => bail!("\"{text}\": after the package comes --lib, or --test and a target"),
        };
        let (target, names) = rest.split_at(target);
        Ok(Self {
            text: text.to_owned(),
            package: package.clone(),
            target: target.to_vec(),
            names: names.to_vec(),
        })
    }

    /// Builds it from the sources in `tree`: its executable and its package's folder.
    fn build(&self, tree: &Path, target: &Path) -> anyhow::Result<(PathBuf, PathBuf)> {
        // As all tests are built, where the target is one package's: crates from elsewhere are there already.
        let package = ["-p", &self.package];
        let is_library = self.target.len() == 1;
        let mut cargo = default_cargo();
        cargo
            .args(["test", "--no-run"])
            .arg("--message-format=json-render-diagnostics")
            .args(if is_library { &package } else { OTHERS })
            .args(&self.target)
            .arg("--target-dir")
            .arg(target)
            .current_dir(tree)
            // A fault is a small change: all else is as it was.
            .env("CARGO_INCREMENTAL", "1");
        let built = cargo.output().context("cannot start cargo")?;
        let errors = String::from_utf8_lossy(&built.stderr);
        let text = &self.text;
        ensure!(built.status.success(), "{text} does not build:\n{errors}");
        let messages = String::from_utf8_lossy(&built.stdout);
        let mut programs = messages.lines().filter_map(test_program);
        let (Some(program), None) = (programs.next(), programs.next()) else {
            bail!("{text}: cargo must build one test program for it");
        };
        Ok(program)
    }

    /// Builds and runs it: whether it passes, and how long it ran, s.
    pub fn run(&self, tree: &Path, target: &Path) -> anyhow::Result<(bool, f64)> {
        let (executable, folder) = self.build(tree, target)?;
        let begun = Instant::now();
        let mut child = Command::new(&executable)
            .args(&self.names)
            .current_dir(&folder)
            .env("CARGO_MANIFEST_DIR", &folder)
            // Where expect-test looks for its files; it must not write them.
            .env("CARGO_WORKSPACE_DIR", tree)
            .env_remove("UPDATE_EXPECT")
            .stdout(Stdio::null())
            .stderr(Stdio::null())
            .spawn()
            .with_context(|| format!("cannot start {}", executable.display()))?;
        let status = child.wait_timeout(LONGEST)?;
        let seconds = begun.elapsed().as_secs_f64();
        if status.is_none() {
            child.kill()?;
            child.wait()?;
        }
        Ok((status.is_some_and(|it| it.success()), seconds))
    }
}

/// Executable and package folder of a test, if this line of cargo's tells of one; the package's own programs are none.
fn test_program(line: &str) -> Option<(PathBuf, PathBuf)> {
    let message: Value = serde_json::from_str(line).ok()?;
    if message["profile"]["test"] != true {
        return None;
    }
    let executable = PathBuf::from(message["executable"].as_str()?);
    let manifest = Path::new(message["manifest_path"].as_str()?);
    Some((executable, manifest.parent()?.to_owned()))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_test_is_named_by_package_target_and_names() {
        for text in [
            "core --lib",
            "core --test golden",
            "core --test log a_name another",
        ] {
            let test = Test::parse(text).unwrap();
            let words = [&[test.package][..], &test.target, &test.names].concat();
            assert_eq!(words.join(" "), text);
        }
        for text in ["", "core", "core --test", "core name"] {
            assert!(Test::parse(text).is_err(), "{text}");
        }
    }

    #[test]
    fn a_program_of_the_package_is_no_test() {
        let line = |test: bool| {
            format!(
                r#"{{"manifest_path":"/a/Cargo.toml","profile":{{"test":{test}}},"executable":"/b/c"}}"#
            )
        };
        assert_eq!(test_program(&line(false)), None);
        assert_eq!(
            test_program(&line(true)),
            Some(("/b/c".into(), "/a".into()))
        );
        assert_eq!(test_program("Compiling"), None);
    }
}
