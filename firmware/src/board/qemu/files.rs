//! The replay file and the answer file.

use core::ffi::CStr;

use semihosting::experimental::env;
use semihosting::fs::File;
use semihosting::io::{Read, Write};
use touchdown_core::monitor::MonitorConfig;
use touchdown_core::sample::Sample;
use touchdown_core::wire::{self, Record};

use super::Failure;
use super::nor::NorFile;

const COMMAND_LINE_BYTES: usize = 512;
const CONFIG_BYTES: usize = 1024;
/// Samples read at once; a semihosting call costs far more than a sample.
const BLOCK: usize = 256;

/// Opens the replay and the answer file, and that of the log if there is one, in the order of the command line.
pub fn open() -> Result<(Replay, Answer, Option<NorFile>), Failure> {
    let arguments = env::args::<COMMAND_LINE_BYTES>().map_err(|_| Failure::CommandLine)?;
    let mut names = &arguments;
    let mut next = || names.next()?.ok();
    let (Some(replay), Some(answer), log, None) = (next(), next(), next(), next()) else {
        return Err(Failure::CommandLine);
    };
    let log = log.map(|name| NorFile::open(terminated(name, &mut [0; COMMAND_LINE_BYTES])?));
    Ok((
        Replay::open(replay)?,
        Answer::create(answer)?,
        log.transpose()?,
    ))
}

fn terminated<'a>(
    name: &str,
    buffer: &'a mut [u8; COMMAND_LINE_BYTES],
) -> Result<&'a CStr, Failure> {
    buffer
        .get_mut(..name.len())
        .ok_or(Failure::CommandLine)?
        .copy_from_slice(name.as_bytes());
    CStr::from_bytes_until_nul(buffer).map_err(|_| Failure::CommandLine)
}

/// A replay file.
pub struct Replay {
    file: File,
    block: [[u8; wire::SAMPLE_BYTES]; BLOCK],
}

impl Replay {
    fn open(name: &str) -> Result<Self, Failure> {
        let mut buffer = [0; COMMAND_LINE_BYTES];
        let file = File::open(terminated(name, &mut buffer)?).map_err(|_| Failure::Replay)?;
        Ok(Self {
            file,
            block: [[0; wire::SAMPLE_BYTES]; BLOCK],
        })
    }

    /// The configuration at the start of the file; to be called once, first.
    pub fn config(&mut self) -> Result<MonitorConfig, Failure> {
        let mut head = [0; 8];
        let mut config = [0; CONFIG_BYTES];
        self.file
            .read_exact(&mut head)
            .map_err(|_| Failure::Replay)?;
        let [a, b, c, d, length @ ..] = head;
        if [a, b, c, d] != wire::REPLAY_MAGIC {
            return Err(Failure::Replay);
        }
        let config = config
            .get_mut(..u32::from_le_bytes(length) as usize)
            .ok_or(Failure::Replay)?;
        self.file.read_exact(config).map_err(|_| Failure::Replay)?;
        postcard::from_bytes(config).map_err(|_| Failure::Replay)
    }

    /// The next samples; `None` at the end of the file.
    pub fn samples(&mut self) -> Result<Option<impl Iterator<Item = Sample>>, Failure> {
        let bytes = self.block.as_flattened_mut();
        let mut filled = 0;
        while let Some(space) = bytes.get_mut(filled..).filter(|space| !space.is_empty()) {
            match self.file.read(space).map_err(|_| Failure::Replay)? {
                0 => break,
                read => filled += read,
            }
        }
        if filled % wire::SAMPLE_BYTES != 0 {
            return Err(Failure::Replay);
        }
        let records = &self.block[..filled / wire::SAMPLE_BYTES];
        Ok((!records.is_empty()).then(|| records.iter().map(wire::decode_sample)))
    }
}

/// An answer file.
pub struct Answer(File);

impl Answer {
    fn create(name: &str) -> Result<Self, Failure> {
        let mut buffer = [0; COMMAND_LINE_BYTES];
        let mut file = File::create(terminated(name, &mut buffer)?).map_err(|_| Failure::Answer)?;
        file.write_all(&wire::ANSWER_MAGIC)
            .map_err(|_| Failure::Answer)?;
        Ok(Self(file))
    }

    /// Appends a record.
    pub fn write(&mut self, record: &Record) -> Result<(), Failure> {
        self.0
            .write_all(&wire::encode_record(record))
            .map_err(|_| Failure::Answer)
    }
}
