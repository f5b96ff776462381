//! A copy of the sources, for faults to be planted in: the user's own are never touched.

use std::fs;
use std::io;
use std::path::{Path, PathBuf};

use anyhow::Context;

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

fn mirror(from: &Path, to: &Path) -> io::Result<()> {
    fs::create_dir_all(to)?;
    for entry in fs::read_dir(to)? {
        let entry = entry?;
        if !from.join(entry.file_name()).exists() {
            if entry.file_type()?.is_dir() {
                fs::remove_dir_all(entry.path())?;
            } else {
                fs::remove_file(entry.path())?;
            }
        }
    }
    for entry in fs::read_dir(from)? {
        let entry = entry?;
        let (name, kind) = (entry.file_name(), entry.file_type()?);
        if LEFT_OUT.iter().any(|it| name == *it) {
            continue;
        }
        let (source, copy) = (entry.path(), to.join(&name));
        if kind.is_dir() {
            mirror(&source, &copy)?;
        } else if kind.is_file() {
            let bytes = fs::read(&source)?;
            if fs::read(&copy).ok().as_ref() != Some(&bytes) {
                fs::write(&copy, bytes)?;
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
