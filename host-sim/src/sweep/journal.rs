//! What a sweep has done so far, on disk: it survives a kill at any moment.
//!
//! A header with plan and scene, then blocks of drops as they were finished. Each ends with a checksum;
//! what follows the last whole block is cut off when the sweep goes on.

use std::fs::{File, OpenOptions, TryLockError};
use std::io::{self, BufReader, Read, Seek, SeekFrom, Write};
use std::path::{Path, PathBuf};

use crc::{CRC_32_ISO_HDLC, Crc};

use super::plan::Plan;
use super::record::{BYTES, Record};
use crate::failure::Failure;
use crate::input_error::{InputError, reason};

/// Drops of a block.
pub(super) const BLOCK: u64 = 256;

const MAGIC: &[u8; 8] = b"tdsweep1";
/// Longest plan or scene that a header is believed to have, bytes.
const LONGEST_TEXT: u32 = 1 << 24;
const CRC: Crc<u32> = Crc::<u32>::new(&CRC_32_ISO_HDLC);

/// One part of a sweep, `part` of `parts`, counted from 1.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Part {
    /// Its number.
    pub part: u64,
    /// How many there are.
    pub parts: u64,
}

impl Part {
    /// The sweep in one piece.
    pub const WHOLE: Self = Self { part: 1, parts: 1 };

    /// Name of its journal.
    pub(super) fn file_name(self) -> String {
        format!("part-{}-of-{}.sweep", self.part, self.parts)
    }

    /// Whether a block is this part's.
    pub(super) fn has(self, block: u64) -> bool {
        block % self.parts == self.part - 1
    }
}

/// A journal that is read, or written on.
pub(super) struct Journal {
    pub path: PathBuf,
    file: File,
    /// Block and where it begins in the file.
    pub blocks: Vec<(u64, u64)>,
    /// Bytes up to the end of the last whole block.
    whole: u64,
}

impl Journal {
    /// Opens the journal of `part` in `folder`, to go on where it ended.
    pub fn open(folder: &Path, part: Part, plan: &Plan) -> Result<Self, Failure> {
        let path = folder.join(part.file_name());
        let name = path.display().to_string();
        let fail = Failure::output(&name);
        let mut options = OpenOptions::new();
        let file = (options.read(true).write(true).create(true).truncate(false))
            .open(&path)
            .map_err(&fail)?;
        file.try_lock().map_err(|error| match error {
            TryLockError::WouldBlock => {
                Failure::Usage(format!("{name}: another sweep writes to this journal"))
            }
            TryLockError::Error(error) => fail(error),
        })?;
        let head = header(plan);
        let length = file.metadata().map_err(&fail)?.len();
        if length < head.len() as u64 {
            return Self::begin(path, file, &head, length);
        }
        let mut journal = Self::read(path, file, plan)?;
        journal.file.set_len(journal.whole).map_err(&fail)?;
        journal.file.seek(SeekFrom::End(0)).map_err(&fail)?;
        Ok(journal)
    }

    /// A new one; what a kill left of a header is no loss, anything else is not ours to overwrite.
    fn begin(path: PathBuf, mut file: File, head: &[u8], length: u64) -> Result<Self, Failure> {
        let name = path.display().to_string();
        let fail = Failure::output(&name);
        let mut there = vec![0; length as usize];
        file.read_exact(&mut there).map_err(&fail)?;
        if !head.starts_with(&there) {
            return Err(other_plan(&name));
        }
        file.rewind().map_err(&fail)?;
        file.write_all(head).map_err(&fail)?;
        Ok(Self {
            path,
            file,
            blocks: Vec::new(),
            whole: head.len() as u64,
        })
    }

    /// Opens a journal to merge it.
    pub fn look(path: &Path, plan: &Plan) -> Result<Self, Failure> {
        let name = path.display().to_string();
        let unread = |error: io::Error| InputError::of_file(&name, reason(&error));
        let file = File::open(path).map_err(unread)?;
        Self::read(path.to_owned(), file, plan)
    }

    fn read(path: PathBuf, file: File, plan: &Plan) -> Result<Self, Failure> {
        let name = path.display().to_string();
        let unread = |error: io::Error| InputError::of_file(&name, reason(&error));
        let mut reader = BufReader::new(&file);
        let head = header(plan);
        let mut there = vec![0; head.len()];
        if !filled(&mut reader, &mut there).map_err(unread)? || there != head {
            return Err(other_plan(&name));
        }
        let (mut blocks, mut whole) = (Vec::new(), head.len() as u64);
        while let Some((block, records)) = next_block(&mut reader, plan).map_err(unread)? {
            blocks.push((block, whole));
            whole += (12 + records.len() * BYTES) as u64;
        }
        drop(reader);
        Ok(Self {
            path,
            file,
            blocks,
            whole,
        })
    }

    /// Adds a block.
    pub fn append(&mut self, block: u64, records: &[Record]) -> Result<(), Failure> {
        let mut bytes = block.to_le_bytes().to_vec();
        bytes.extend(records.iter().flat_map(Record::bytes));
        bytes.extend(CRC.checksum(&bytes).to_le_bytes());
        let name = self.path.display().to_string();
        self.file.write_all(&bytes).map_err(Failure::output(&name))
    }

    /// The drops of the block that begins at `at`.
    pub fn block(&mut self, at: u64, plan: &Plan) -> Result<Vec<Record>, Failure> {
        let name = self.path.display().to_string();
        let unread = |error: io::Error| InputError::of_file(&name, reason(&error));
        self.file.seek(SeekFrom::Start(at)).map_err(unread)?;
        let found = next_block(&mut BufReader::new(&self.file), plan).map_err(unread)?;
        let Some((_, records)) = found else {
            return Err(InputError::of_file(&name, "was changed while it was read").into());
        };
        Ok(records)
    }
}

/// The plan and the scene in the header of a journal.
pub(super) fn texts(path: &Path) -> Result<[String; 2], Failure> {
    let name = path.display().to_string();
    let no_journal =
        || InputError::of_file(&name, "is no journal of a sweep, or its header is damaged");
    let unread = |error: io::Error| InputError::of_file(&name, reason(&error));
    let mut file = BufReader::new(File::open(path).map_err(unread)?);
    let mut bytes = [0; 8];
    if !filled(&mut file, &mut bytes).map_err(unread)? || bytes != *MAGIC {
        return Err(no_journal().into());
    }
    let mut text = || -> Result<String, Failure> {
        let mut length = [0; 4];
        let whole = filled(&mut file, &mut length).map_err(unread)?;
        let length = u32::from_le_bytes(length);
        if !whole || length > LONGEST_TEXT {
            return Err(no_journal().into());
        }
        let mut text = vec![0; length as usize];
        if !filled(&mut file, &mut text).map_err(unread)? {
            return Err(no_journal().into());
        }
        String::from_utf8(text).map_err(|_| no_journal().into())
    };
    Ok([text()?, text()?])
}

fn header(plan: &Plan) -> Vec<u8> {
    let mut bytes = MAGIC.to_vec();
    for text in plan.texts() {
        bytes.extend((text.len() as u32).to_le_bytes());
        bytes.extend(text.as_bytes());
    }
    bytes.extend(CRC.checksum(&bytes).to_le_bytes());
    bytes
}

fn other_plan(name: &str) -> Failure {
    InputError::of_file(
        name,
        "belongs to another plan or scene; remove it, or give another folder with --out",
    )
    .into()
}

/// The next block; `None` at the end, or where it is torn or damaged.
fn next_block(file: &mut impl Read, plan: &Plan) -> io::Result<Option<(u64, Vec<Record>)>> {
    let mut number = [0; 8];
    if !filled(file, &mut number)? {
        return Ok(None);
    }
    let block = u64::from_le_bytes(number);
    let Some(first) = block.checked_mul(BLOCK).filter(|it| *it < plan.size()) else {
        return Ok(None);
    };
    let count = BLOCK.min(plan.size() - first) as usize;
    let (mut body, mut sum) = (vec![0; count * BYTES], [0; 4]);
    if !filled(file, &mut body)? || !filled(file, &mut sum)? {
        return Ok(None);
    }
    let mut digest = CRC.digest();
    digest.update(&number);
    digest.update(&body);
    if digest.finalize() != u32::from_le_bytes(sum) {
        return Ok(None);
    }
    let (records, _) = body.as_chunks::<BYTES>();
    let records: Option<Vec<_>> = records.iter().map(Record::from_bytes).collect();
    Ok(records.map(|records| (block, records)))
}

/// Whether there was enough to fill `bytes`.
fn filled(file: &mut impl Read, bytes: &mut [u8]) -> io::Result<bool> {
    match file.read_exact(bytes) {
        Ok(()) => Ok(true),
        Err(error) if error.kind() == io::ErrorKind::UnexpectedEof => Ok(false),
        Err(error) => Err(error),
    }
}
