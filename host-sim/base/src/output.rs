//! Output files that appear whole or not at all, and all together or none.

use std::collections::BTreeSet;
use std::fs::{self, File};
use std::io::{self, BufWriter, Write};
use std::path::{Path, PathBuf};

use tempfile::TempPath;

use crate::failure::{Failure, STDOUT};
use crate::interrupt::{self, Registered};

/// Standard output. A reader that has gone away, as of `| head`, is no failure: what it does not want is
/// lost, and all else that was asked for is done.
struct Standard<W>(W);

impl<W: Write> Write for Standard<W> {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        match self.0.write(bytes) {
            Err(error) if error.kind() == io::ErrorKind::BrokenPipe => Ok(bytes.len()),
            written => written,
        }
    }

    fn flush(&mut self) -> io::Result<()> {
        match self.0.flush() {
            Err(error) if error.kind() == io::ErrorKind::BrokenPipe => Ok(()),
            flushed => flushed,
        }
    }
}

/// A file being written. It takes its name with [`commit`]; dropped before that, nothing is left of it.
pub struct Output {
    name: String,
    writer: BufWriter<Box<dyn Write + Send>>,
    /// `None` for standard output and devices.
    part: Option<Part>,
}

/// What has not got its name yet.
struct Part {
    file: File,
    path: TempPath,
    target: PathBuf,
    _registered: Registered,
}

impl Output {
    /// Opens `name`, or standard output for `-`.
    pub fn create(name: &str) -> Result<Self, Failure> {
        if name == STDOUT {
            return Ok(Self::new(name, Box::new(Standard(io::stdout())), None));
        }
        let fail = Failure::output(name);
        let target = target(Path::new(name));
        match fs::metadata(&target) {
            Ok(there) if there.is_dir() => Err(fail(a_folder())),
            Err(error) if target.file_name().is_none() => Err(fail(error)),
            Ok(there) if !there.is_file() => {
                let device = File::options().write(true).open(&target).map_err(fail)?;
                Ok(Self::new(name, Box::new(device), None))
            }
            _ => {
                let part = Part::new(target).map_err(&fail)?;
                let file = part.file.try_clone().map_err(&fail)?;
                Ok(Self::new(name, Box::new(file), Some(part)))
            }
        }
    }

    fn new(name: &str, writer: Box<dyn Write + Send>, part: Option<Part>) -> Self {
        Self {
            name: name.to_owned(),
            writer: BufWriter::new(writer),
            part,
        }
    }

    /// The file's name as it was given.
    pub fn name(&self) -> &str {
        &self.name
    }

    /// Writes all of `text`.
    pub fn put(&mut self, text: &str) -> Result<(), Failure> {
        (self.write_all(text.as_bytes()))
            .and_then(|()| self.flush())
            .map_err(Failure::output(&self.name))
    }

    /// Gives the file its name.
    pub fn commit(self) -> Result<(), Failure> {
        commit(vec![self])
    }
}

impl Write for Output {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        self.writer.write(bytes)
    }

    fn flush(&mut self) -> io::Result<()> {
        self.writer.flush()
    }
}

impl Part {
    fn new(target: PathBuf) -> io::Result<Self> {
        let ((file, path), registered) = interrupt::make(|| {
            let made = hidden(".part").tempfile_in(folder(&target))?.into_parts();
            let left = made.1.to_path_buf();
            Ok((made, move || _ = fs::remove_file(left)))
        })?;
        Ok(Self {
            file,
            path,
            target,
            _registered: registered,
        })
    }

    /// Gives it its name.
    fn rename(self) -> io::Result<Named> {
        let old = aside(&self.target)?;
        self.path.persist(&self.target)?;
        Ok(Named {
            target: self.target,
            old,
        })
    }
}

/// What has got its name.
struct Named {
    target: PathBuf,
    /// What had the name before.
    old: Option<TempPath>,
}

impl Named {
    /// Puts back what was there.
    fn undo(self) {
        match self.old.map(|old| old.persist(&self.target)) {
            None => drop(fs::remove_file(&self.target)),
            Some(Ok(())) => {}
            // Under its hidden name rather than lost.
            Some(Err(there)) => drop(there.path.keep()),
        }
    }
}

/// Gives all files their names, or none.
pub fn commit(outputs: Vec<Output>) -> Result<(), Failure> {
    let mut parts = Vec::new();
    for mut out in outputs {
        let synced = (out.writer.flush())
            .and_then(|()| (out.part.iter()).try_for_each(|part| part.file.sync_all()));
        synced.map_err(Failure::output(&out.name))?;
        parts.extend(out.part.map(|part| (out.name, part)));
    }
    if parts.is_empty() {
        return Ok(());
    }
    let _whole = interrupt::hold().map_err(Failure::output("the files"))?;
    let mut named = Vec::new();
    let done = parts.into_iter().try_for_each(|(name, part)| {
        named.push(part.rename().map_err(Failure::output(&name))?);
        Ok(())
    });
    let done = done.and_then(|()| sync_folders(&named));
    if done.is_err() {
        named.into_iter().rev().for_each(Named::undo);
    }
    done
}

/// What has the name `target` now, under another one as well.
fn aside(target: &Path) -> io::Result<Option<TempPath>> {
    match fs::symlink_metadata(target) {
        Err(error) if error.kind() == io::ErrorKind::NotFound => Ok(None),
        Err(error) => Err(error),
        Ok(there) if there.is_dir() => Err(a_folder()),
        Ok(_) => {
            // Not every file system has links.
            let other = |path: &Path| {
                fs::hard_link(target, path).or_else(|_| fs::copy(target, path).map(drop))
            };
            let made = hidden(".old").make_in(folder(target), other)?;
            Ok(Some(made.into_temp_path()))
        }
    }
}

/// That the names are on the disk as well.
fn sync_folders(named: &[Named]) -> Result<(), Failure> {
    let folders: BTreeSet<_> = named.iter().map(|it| folder(&it.target)).collect();
    for folder in folders {
        use io::ErrorKind::{InvalidInput, PermissionDenied, Unsupported};
        let synced = File::open(folder).and_then(|it| it.sync_all());
        // Not every system can, and a folder may be closed to readers.
        let excused = [InvalidInput, PermissionDenied, Unsupported];
        if let Err(error) = synced
            && !excused.contains(&error.kind())
        {
            return Err(Failure::output(&folder.display().to_string())(error));
        }
    }
    Ok(())
}

/// Through links to what they point at, so that they stay; also where that is not there yet.
pub fn target(path: &Path) -> PathBuf {
    let mut path = path.to_owned();
    // As many links as Linux follows. One that leads to a pipe leads to no name.
    for _ in 0..40 {
        match fs::read_link(&path) {
            Ok(to) if !path.exists() => path = folder(&path).join(to),
            _ => break,
        }
    }
    real(&path)
}

/// Without links, as far as it is there.
fn real(path: &Path) -> PathBuf {
    match (fs::canonicalize(path), path.file_name()) {
        (Ok(there), _) => there,
        (Err(_), Some(name)) if !path.exists() => real(folder(path)).join(name),
        (Err(_), _) => path.to_owned(),
    }
}

fn folder(path: &Path) -> &Path {
    match path.parent() {
        Some(parent) if parent != Path::new("") => parent,
        _ => Path::new("."),
    }
}

fn a_folder() -> io::Error {
    io::Error::other("is a folder, not a file")
}

/// Names beside a file, with the rights that a new file gets.
fn hidden(ending: &'static str) -> tempfile::Builder<'static, 'static> {
    let mut names = tempfile::Builder::new();
    names.prefix(".touchdown-").suffix(ending);
    #[cfg(unix)]
    {
        use std::os::unix::fs::PermissionsExt;
        names.permissions(fs::Permissions::from_mode(0o666));
    }
    names
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_file_that_cannot_take_its_name_leaves_the_others_as_they_were() {
        for old in [None, Some("old")] {
            let folder = tempfile::tempdir().unwrap();
            let [first, second] = ["first", "second"].map(|it| folder.path().join(it));
            if let Some(old) = old {
                fs::write(&first, old).unwrap();
            }
            let open = |it: &PathBuf| {
                let mut out = Output::create(&it.display().to_string()).unwrap();
                out.put("new").unwrap();
                out
            };
            let outputs = vec![open(&first), open(&second)];
            fs::create_dir(&second).unwrap();
            let failure = commit(outputs).unwrap_err();
            assert!(failure.to_string().contains("second"), "{failure}");
            assert_eq!(fs::read_to_string(&first).ok().as_deref(), old);
            fs::remove_dir(&second).unwrap();
            let left = fs::read_dir(folder.path()).unwrap().count();
            assert_eq!(left, usize::from(old.is_some()));

            commit(vec![open(&first), open(&second)]).unwrap();
            assert_eq!(fs::read_to_string(&first).unwrap(), "new");
            assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 2);
        }
    }

    #[cfg(unix)]
    #[test]
    fn a_link_stays_also_where_it_leads_nowhere_yet() {
        let folder = tempfile::tempdir().unwrap();
        let at = folder.path();
        std::os::unix::fs::symlink("there", at.join("link")).unwrap();
        let mut out = Output::create(&at.join("link").display().to_string()).unwrap();
        out.put("new").unwrap();
        out.commit().unwrap();
        assert!(at.join("link").is_symlink());
        assert_eq!(fs::read_to_string(at.join("there")).unwrap(), "new");
    }
}
