//! Samples on their way to the image: a named pipe, which never blocks this side.

use std::fs::{self, File, OpenOptions};
use std::io::{self, Write};
use std::os::unix::fs::OpenOptionsExt;
use std::path::{Path, PathBuf};

use rustix::fs::{CWD, FileType, Mode, OFlags, mknodat};

pub struct Pipe {
    path: PathBuf,
    /// Once the image reads.
    file: Option<File>,
    /// Put in, and not yet gone.
    waiting: Vec<u8>,
}

impl Pipe {
    /// A new pipe, which begins with `head`.
    pub fn make(path: &Path, head: Vec<u8>) -> io::Result<Self> {
        if path.exists() {
            fs::remove_file(path)?;
        }
        mknodat(CWD, path, FileType::Fifo, Mode::RUSR | Mode::WUSR, 0)?;
        Ok(Self {
            path: path.to_owned(),
            file: None,
            waiting: head,
        })
    }

    /// Whether all that was put in has gone.
    pub fn is_free(&self) -> bool {
        self.waiting.is_empty()
    }

    /// Puts bytes in.
    pub fn put(&mut self, bytes: impl Iterator<Item = u8>) {
        self.waiting.extend(bytes);
    }

    /// Pushes on; whether all has gone. A reader that is not there, or gone, is waited for: whoever looks
    /// after it will know.
    pub fn push(&mut self) -> bool {
        if self.file.is_none() {
            let mut options = OpenOptions::new();
            options
                .write(true)
                .custom_flags(OFlags::NONBLOCK.bits() as i32);
            self.file = options.open(&self.path).ok();
        }
        if let Some(file) = &mut self.file {
            let written = file.write(&self.waiting).unwrap_or(0);
            self.waiting.drain(..written);
        }
        self.is_free()
    }
}
