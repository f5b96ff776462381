//! Output files that appear whole or not at all.

use std::fs::{self, File};
use std::io::{self, BufWriter, Write};
use std::path::PathBuf;

use crate::failure::Failure;

/// What an option's FILE means for standard output.
pub const STDOUT: &str = "-";

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

/// A file being written. It takes its name with [`Output::commit`]; dropped before that, nothing
/// is left of it.
pub struct Output {
    name: String,
    writer: Box<dyn Write + Send>,
    /// Written file and final name; `None` for standard output and devices.
    rename: Option<(PathBuf, PathBuf)>,
}

impl Output {
    /// Opens `name`, or standard output for `-`.
    pub fn create(name: &str) -> Result<Self, Failure> {
        if name == STDOUT {
            return Ok(Self::direct(name, Standard(io::stdout())));
        }
        let fail = Failure::output(name);
        // Through a link to what it points at, so that the link stays.
        let target = fs::canonicalize(name).unwrap_or_else(|_| PathBuf::from(name));
        match fs::metadata(&target) {
            Ok(there) if there.is_dir() => {
                return Err(fail(io::Error::other("is a folder, not a file")));
            }
            Ok(there) if !there.is_file() => {
                let device = File::options().write(true).open(&target).map_err(fail)?;
                return Ok(Self::direct(name, device));
            }
            _ => {}
        }
        let file_name = target.file_name().unwrap_or_default().to_string_lossy();
        let part = target.with_file_name(format!(".{file_name}.{}.part", std::process::id()));
        let file = File::create(&part).map_err(fail)?;
        Ok(Self {
            name: name.to_owned(),
            writer: Box::new(BufWriter::new(file)),
            rename: Some((part, target)),
        })
    }

    fn direct(name: &str, writer: impl Write + Send + 'static) -> Self {
        Self {
            name: name.to_owned(),
            writer: Box::new(BufWriter::new(writer)),
            rename: None,
        }
    }

    /// The file's name as it was given.
    pub fn name(&self) -> &str {
        &self.name
    }

    /// Writes all of `text`.
    pub fn put(&mut self, text: &str) -> Result<(), Failure> {
        self.writer
            .write_all(text.as_bytes())
            .and_then(|()| self.writer.flush())
            .map_err(Failure::output(&self.name))
    }

    /// Gives the file its name.
    pub fn commit(mut self) -> Result<(), Failure> {
        let fail = Failure::output(&self.name);
        self.writer.flush().map_err(&fail)?;
        if let Some((part, target)) = &self.rename {
            fs::rename(part, target).map_err(&fail)?;
            self.rename = None;
        }
        Ok(())
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

impl Drop for Output {
    fn drop(&mut self) {
        if let Some((part, _)) = &self.rename {
            // Nothing is left to do if that fails too.
            let _ = fs::remove_file(part);
        }
    }
}
