//! The files of the desktop that the command line names, and those of replay and answer.

use semihosting::experimental::env;
use semihosting::fs::File;
use semihosting::io::{self, Read as _, Write as _};
use touchdown_protocol::wire::{self, Incoming, ReplayHead};

use super::nor::NorFile;
use super::settings::{SettingsFile, fill};
use super::{Failure, FileLog, Name};

const COMMAND_LINE_BYTES: usize = 512;
const HEAD_BYTES: usize = 1024;
/// Samples that are read at once.
const BLOCK_SAMPLES: usize = 18;

/// What the command line names.
pub struct Files {
    /// First.
    pub replay: Replay,
    /// Second; it begins as an answer does.
    pub answer: File,
    /// Third, of the log.
    pub log: Option<FileLog>,
    /// Fourth, of the stored configuration.
    pub settings: Option<SettingsFile>,
}

impl Files {
    pub fn open() -> Result<Self, Failure> {
        let arguments = env::args::<COMMAND_LINE_BYTES>().map_err(|_| Failure::CommandLine)?;
        let mut names = &arguments;
        let mut next = || Name::from_bytes_truncating_at_nul(names.next()?.ok()?.as_bytes()).ok();
        let (Some(replay), Some(answer), log, settings, None) =
            (next(), next(), next(), next(), next())
        else {
            return Err(Failure::CommandLine);
        };
        let mount = |name: Name| FileLog::mount(NorFile::open(&name)?).ok();
        let log = log.map(|name| mount(name).ok_or(Failure::Log));
        Ok(Self {
            replay: Replay::open(&replay)?,
            answer: create_answer(&answer).map_err(|_| Failure::Answer)?,
            log: log.transpose()?,
            settings: settings.map(SettingsFile),
        })
    }
}

/// A replay file.
pub struct Replay {
    file: File,
    block: [[u8; wire::SAMPLE_BYTES]; BLOCK_SAMPLES],
    /// Records of the block, and the next of them.
    records: usize,
    at: usize,
}

impl Replay {
    fn open(name: &Name) -> Result<Self, Failure> {
        Ok(Self {
            file: File::open(name).map_err(|_| Failure::Replay)?,
            block: [[0; wire::SAMPLE_BYTES]; BLOCK_SAMPLES],
            records: 0,
            at: 0,
        })
    }

    /// The start of the file; to be called once, first.
    #[inline(never)]
    pub fn head(&mut self) -> Option<ReplayHead> {
        let mut first = [0; 8];
        let mut head = [0; HEAD_BYTES];
        self.file.read_exact(&mut first).ok()?;
        let (magic, length) = first.split_first_chunk()?;
        let length = u32::from_le_bytes(length.try_into().ok()?);
        let head = head.get_mut(..length as usize)?;
        self.file.read_exact(head).ok()?;
        let head = postcard::from_bytes(head).ok();
        head.filter(|_| *magic == wire::REPLAY_MAGIC)
    }

    /// The next sample and what comes with it; `None` at the end of the file.
    pub fn next(&mut self) -> Result<Option<(Incoming, Option<u8>)>, Failure> {
        if self.at == self.records {
            let filled = fill(&mut self.file, self.block.as_flattened_mut());
            let filled = filled.map_err(|_| Failure::Replay)?;
            if filled % wire::SAMPLE_BYTES != 0 {
                return Err(Failure::Replay);
            }
            (self.records, self.at) = (filled / wire::SAMPLE_BYTES, 0);
        }
        let Some([record, ..]) = self.block.get(self.at..self.records) else {
            return Ok(None);
        };
        self.at += 1;
        let incoming = wire::decode_sample(record).map(Some);
        incoming.ok_or(Failure::Replay)
    }
}

fn create_answer(name: &Name) -> io::Result<File> {
    let mut file = File::create(name)?;
    file.write_all(&wire::ANSWER_MAGIC)?;
    Ok(file)
}
