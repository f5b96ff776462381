//! A copy of the sources, for faults to be planted in: the user's own are never touched.

use std::fs;
use std::path::{Path, PathBuf};

use anyhow::Context;
use walkdir::{DirEntry, WalkDir};

use super::list::Fault;
use crate::files;

/// Of the sources' folders, what is none of them.
const LEFT_OUT: [&str; 2] = ["target", ".git"];

/// Makes `folder` a copy of the sources of `workspace` as they are. What is the same already is left, so that it is not
/// built again.
pub fn copy(workspace: &Path, folder: &Path) -> anyhow::Result<()> {
    mirror(workspace, folder)
        .with_context(|| format!("cannot copy the sources to {}", folder.display()))
}

/// Plants `fault` in the copy in `folder`, until what is returned is dropped.
pub fn plant(fault: &Fault, folder: &Path) -> anyhow::Result<Planted> {
    let file = folder.join(&fault.file);
    let clean = files::text(&file)?;
    fs::write(&file, fault.planted(&clean)?)?;
    Ok(Planted { file, clean })
}

/// A file with a fault in it.
pub struct Planted {
    file: PathBuf,
    clean: String,
}

impl Drop for Planted {
    fn drop(&mut self) {
        // If this fails, the next copy mends it.
        let _ = fs::write(&self.file, &self.clean);
    }
}

fn mirror(from: &Path, to: &Path) -> anyhow::Result<()> {
    fs::create_dir_all(to)?;
    for entry in WalkDir::new(to).min_depth(1).contents_first(true) {
        let entry = entry?;
        let copy = entry.path();
        if from.join(copy.strip_prefix(to)?).exists() {
            continue;
        }
        if entry.file_type().is_dir() {
            fs::remove_dir(copy)?;
        } else {
            fs::remove_file(copy)?;
        }
    }
    let is_source = |it: &DirEntry| LEFT_OUT.iter().all(|out| it.file_name() != *out);
    for entry in WalkDir::new(from).into_iter().filter_entry(is_source) {
        let entry = entry?;
        let (source, copy) = (entry.path(), to.join(entry.path().strip_prefix(from)?));
        if entry.file_type().is_dir() {
            fs::create_dir_all(copy)?;
        } else if entry.file_type().is_file() {
            let bytes = fs::read(source)?;
            if fs::read(&copy).ok().as_ref() != Some(&bytes) {
                fs::write(copy, bytes)?;
            }
        }
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::faults::list::tests::fault;

    #[test]
    fn a_copy_is_mended_and_loses_what_is_gone() {
        let folder = std::env::temp_dir().join(format!("touchdown-tree-{}", std::process::id()));
        let (from, to) = (folder.join("from"), folder.join("to"));
        fs::create_dir_all(from.join("src")).unwrap();
        fs::create_dir_all(from.join("target")).unwrap();
        fs::write(from.join("src/a.rs"), "a + b").unwrap();
        fs::write(from.join("src/b.rs"), "").unwrap();
        copy(&from, &to).unwrap();
        let fault = Fault {
            file: "src/a.rs".into(),
            new: "-".into(),
            ..fault("sign", "+")
        };
        let read = || fs::read_to_string(to.join("src/a.rs")).unwrap();
        let planted = plant(&fault, &to).unwrap();
        assert_eq!(read(), "a - b");
        drop(planted);
        assert_eq!(read(), "a + b");
        fs::write(to.join("src/a.rs"), "a - b").unwrap();
        fs::remove_file(from.join("src/b.rs")).unwrap();
        copy(&from, &to).unwrap();
        assert_eq!(read(), "a + b");
        assert!(!to.join("src/b.rs").exists() && !to.join("target").exists());
        fs::remove_dir_all(folder).unwrap();
    }
}
