//! Finds and reads files; errors name them.

use std::fs;
use std::path::{Path, PathBuf};

use anyhow::Context;
use serde::de::DeserializeOwned;

/// What is in a file.
pub fn bytes(file: &Path) -> anyhow::Result<Vec<u8>> {
    fs::read(file).with_context(|| format!("cannot read {}", file.display()))
}

/// Likewise, of a text.
pub fn text(file: &Path) -> anyhow::Result<String> {
    fs::read_to_string(file).with_context(|| format!("cannot read {}", file.display()))
}

/// Likewise, in TOML.
pub fn toml<T: DeserializeOwned>(file: &Path) -> anyhow::Result<T> {
    toml::from_str(&text(file)?).with_context(|| file.display().to_string())
}

/// All files with this ending in `folder` and below it, in the order of their paths.
pub fn below(folder: &Path, ending: &str) -> anyhow::Result<Vec<PathBuf>> {
    let (mut files, mut folders) = (vec![], vec![folder.to_owned()]);
    while let Some(folder) = folders.pop() {
        let entries = fs::read_dir(&folder);
        for entry in entries.with_context(|| format!("cannot read {}", folder.display()))? {
            let path = entry?.path();
            if path.is_dir() {
                folders.push(path);
            } else if path.extension().is_some_and(|it| it == ending) {
                files.push(path);
            }
        }
    }
    files.sort();
    Ok(files)
}
