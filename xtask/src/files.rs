//! Finds and reads files; errors name them.

use std::fs;
use std::path::{Path, PathBuf};

use anyhow::Context;
use serde::de::DeserializeOwned;
use walkdir::WalkDir;

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
    let mut files = vec![];
    for entry in WalkDir::new(folder).sort_by_file_name() {
        let path = entry?.into_path();
        if path.extension().is_some_and(|it| it == ending) && path.is_file() {
            files.push(path);
        }
    }
    Ok(files)
}
