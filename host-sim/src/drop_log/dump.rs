//! A dump of the flash, or a file of one episode.

use std::path::Path;

use serde::Serialize;
use touchdown_core::log::block::BLOCK_BYTES;
use touchdown_core::log::counters::{COUNTERS_BYTES, Counters};
use touchdown_core::log::marks::{MARKS_BYTES, Marks};
use touchdown_core::log::reader::Verdict;

use super::episode::Episode;
use crate::input_error::InputError;

/// Bytes of the counters at the beginning of a dump.
const COUNTERS: usize = 8192;
/// Bytes of a slot, and of its pages without the marks.
const SLOT: usize = 49_152;
const PAGES: usize = SLOT - BLOCK_BYTES;
/// Larger than any flash that the log is kept on, bytes.
const LARGEST: u64 = 256 << 20;

/// All that a log holds.
#[derive(Clone, Debug, Serialize)]
pub struct Dump {
    /// Lifetime counters; none in a file of one episode, or where none are whole.
    pub counters: Option<Counters>,
    /// In the order of their numbers.
    pub episodes: Vec<Episode>,
}

/// Reads the log at `path`.
pub fn read(path: &str) -> Result<Dump, InputError> {
    let dump = Dump::of(&InputError::read_bytes(Path::new(path), LARGEST)?);
    if dump.counters.is_none() && dump.episodes.is_empty() {
        let rule = "has neither counters nor a block of an episode: it is no drop log";
        return Err(InputError::of_file(path, rule));
    }
    Ok(dump)
}

impl Dump {
    /// From the bytes of a file.
    pub fn of(bytes: &[u8]) -> Self {
        let (head, slots) = bytes.split_at(bytes.len().min(COUNTERS));
        let counters = newest(head);
        let is_dump =
            counters.is_some() || (!slots.is_empty() && head.iter().all(|it| *it == 0xff));
        let mut episodes: Vec<Episode> = if is_dump {
            slots.chunks(SLOT).enumerate().map(slot).collect()
        } else {
            vec![Episode::of(bytes)]
        };
        episodes.retain(|it| it.verdict != Verdict::Empty && it.report.sequence.is_some());
        episodes.sort_by_key(|it| it.sequence);
        Self { counters, episodes }
    }
}

fn newest(head: &[u8]) -> Option<Counters> {
    let (cells, _) = head.as_chunks::<COUNTERS_BYTES>();
    let whole = cells.iter().filter_map(Counters::decode);
    whole.max_by_key(|it| it.generation)
}

fn slot((number, bytes): (usize, &[u8])) -> Episode {
    let (pages, marks) = bytes.split_at(bytes.len().min(PAGES));
    let marks = marks.first_chunk::<MARKS_BYTES>().map(Marks::decode);
    Episode {
        slot: Some(number),
        locked: marks.is_some_and(|it| it.locked),
        ..Episode::of(pages)
    }
}
