//! The firmware's image in QEMU: the same monitor and controller, compiled for the microcontroller, over
//! the same samples.

mod files;
mod session;

use std::fs;
use std::io;
use std::path::{Path, PathBuf};
use std::process::ExitStatus;
use std::time::Duration;

use crate::controller_trace::{ControllerTrace, MonitorOutput, Procedure};
use defmt_decoder::{DecodeError, Table};
use touchdown_base::interrupt::TemporaryFolder;
use touchdown_core::monitor::MonitorConfig;
use touchdown_core::sample::Sample;
use touchdown_files::link::LinkError;

pub use self::files::replay_head;
use self::files::{decode_answer, write_replay};
pub use self::session::{RESTART, Session};

const QEMU: &str = "qemu-system-arm";
/// An STM32F405; what of it is emulated is in docs/build/firmware.md.
const MACHINE: &str = "netduinoplus2";
/// 8 ns of emulated time an instruction; a core that waits is not waited for.
const TIME: [&str; 2] = ["-icount", "shift=3,sleep=off"];
const IMAGE: &str = "touchdown-qemu";

/// Longest time for the start of QEMU, and for each sample: far more than they take.
const START_LIMIT: Duration = Duration::from_secs(30);
const SAMPLE_LIMIT_MS: u64 = 1;

/// Why the image gave no answer.
#[derive(Debug, thiserror::Error)]
pub enum EmulatorError {
    /// The image is not there.
    #[error("{}: no firmware image here; `cargo xtask firmware` builds it", .0.display())]
    ImageMissing(PathBuf),
    /// QEMU is not there.
    #[error("{QEMU} is not installed: `cargo xtask setup` installs it")]
    QemuMissing,
    /// A file or a process of the desktop failed.
    #[error("cannot {0}")]
    Io(&'static str, #[source] io::Error),
    /// The image has no log table, or one that cannot be read.
    #[error("{} is not an image of this firmware: {reason}", image.display())]
    NotAnImage {
        /// The file.
        image: PathBuf,
        /// What is wrong with it.
        reason: String,
    },
    /// It was still running after this time.
    #[error("the image did not finish within {} s", .0.as_secs())]
    Timeout(Duration),
    /// It ended with an error.
    #[error("the image failed ({status}): {}{qemu}", log.join("; "))]
    Failed {
        /// As QEMU gave it.
        status: ExitStatus,
        /// What the image logged.
        log: Vec<String>,
        /// What QEMU said.
        qemu: String,
    },
    /// It does not talk.
    #[error("the image: {0}")]
    Link(#[from] LinkError),
}

/// An image and the means to run it.
#[derive(Clone, Debug)]
pub struct Emulator {
    /// The image.
    pub image: PathBuf,
}

impl Emulator {
    /// Looks for the image, by default the one that `cargo xtask firmware` builds, and for QEMU.
    pub fn find(image: Option<&Path>) -> Result<Self, EmulatorError> {
        let image = image.map_or_else(|| built(IMAGE), Path::to_path_buf);
        let Ok(image) = image.canonicalize() else {
            return Err(EmulatorError::ImageMissing(image));
        };
        let path = std::env::var_os("PATH").unwrap_or_default();
        if !std::env::split_paths(&path).any(|folder| folder.join(QEMU).is_file()) {
            return Err(EmulatorError::QemuMissing);
        }
        Ok(Self { image })
    }

    /// Runs the image over `samples` with a new drop log, and talks to it.
    pub fn control(
        &self,
        config: &MonitorConfig,
        procedure: &Procedure,
        samples: impl Iterator<Item = Sample>,
    ) -> Result<(MonitorOutput, ControllerTrace), EmulatorError> {
        let folder = TemporaryFolder::new().map_err(failed("make a folder"))?;
        let count = write_replay(&folder.path().join("replay"), config, procedure, samples)
            .map_err(failed("write the replay file"))?;
        let limit = START_LIMIT + Duration::from_millis(count * SAMPLE_LIMIT_MS);
        let mut session = self.open(folder.path())?;
        let (output, shown) = session.answer(limit)?;
        let mut client = session.client()?;
        let (hello, state) = (client.hello()?, client.state()?);
        let conduct = ControllerTrace {
            flash: read(&folder.path().join("log"))?,
            ..ControllerTrace::new(&output.notices, shown, hello, state)
        };
        let log = session.cut()?;
        Ok((MonitorOutput { log, ..output }, conduct))
    }

    /// What it printed, by the table in its file.
    fn decode_log(&self, bytes: &[u8]) -> Result<Vec<String>, EmulatorError> {
        let reject = |reason: String| EmulatorError::NotAnImage {
            image: self.image.clone(),
            reason,
        };
        let table = Table::parse(&read(&self.image)?)
            .map_err(|e| reject(e.to_string()))?
            .ok_or_else(|| reject("it has no log table".into()))?;
        let mut decoder = table.new_stream_decoder();
        decoder.received(bytes);
        let mut lines = Vec::new();
        loop {
            match decoder.decode() {
                Ok(frame) => lines.push(frame.display_message().to_string()),
                Err(DecodeError::UnexpectedEof) => return Ok(lines),
                Err(DecodeError::Malformed) => lines.push("(damaged line)".into()),
            }
        }
    }
}

fn read(path: &Path) -> Result<Vec<u8>, EmulatorError> {
    fs::read(path).map_err(failed("read"))
}

fn failed(what: &'static str) -> impl Fn(io::Error) -> EmulatorError + Copy {
    move |error| EmulatorError::Io(what, error)
}

/// Where `cargo xtask firmware` puts an image.
pub fn built(name: &str) -> PathBuf {
    let target = std::env::var_os("CARGO_TARGET_DIR").map_or_else(
        || Path::new(env!("CARGO_MANIFEST_DIR")).join("../../target"),
        PathBuf::from,
    );
    target.join("thumbv7em-none-eabihf/firmware").join(name)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn missing_image_names_the_command_that_builds_it() {
        let error = Emulator::find(Some(Path::new("no/such/image"))).unwrap_err();
        assert!(error.to_string().contains("cargo xtask firmware"));
    }
}
