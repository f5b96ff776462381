//! Reads an episode from any bytes: what is whole is given, what is not is counted.

use super::block::{BLOCK_BYTES, Kind, Page, Sealed};
use super::ending::Ending;
use super::header::Header;
use super::waveform::Waveform;
use crate::event::Notice;
use crate::wire::{self, NOTICE_BYTES, Record};

/// Most blocks of an episode.
pub const MOST_BLOCKS: usize = 256;
/// Header and ending come so many times, so that a wrong bit loses neither.
pub const COPIES: usize = 2;

/// What a block says.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Item<'a> {
    /// What it is a record of; comes twice.
    Header(Header),
    /// Samples.
    Waveform(Waveform<'a>),
    /// Notices.
    Events(Events<'a>),
    /// How severe it was: a version and that version's bytes.
    Severity(u8, &'a [u8]),
    /// What it added up to; comes twice.
    Ending(Ending),
}

/// Notices of a block.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Events<'a>(&'a [[u8; NOTICE_BYTES]]);

impl<'a> Events<'a> {
    /// The notices; `None` for a record that is not known.
    pub fn notices(&self) -> impl Iterator<Item = Option<Notice>> + use<'a> {
        self.0
            .iter()
            .map(|record| match wire::decode_record(record) {
                Some(Record::Notice(notice)) => Some(notice),
                _ => None,
            })
    }
}

/// Whether an episode is all there.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(rename_all = "snake_case"))]
pub enum Verdict {
    /// No block at all.
    Empty,
    /// All that was recorded is there and right.
    Whole,
    /// It has no ending: cut off, or still being written.
    Incomplete,
    /// It has an ending, but not all that was recorded.
    Damaged,
}

/// What reading found. Every page is counted in one of the first five.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Report {
    /// Right blocks of the episode.
    pub blocks: u32,
    /// Erased pages.
    pub blank: u32,
    /// Pages that are torn or damaged.
    pub broken: u32,
    /// Blocks of another episode, or a second time.
    pub stray: u32,
    /// Right blocks whose content is of no known kind or version.
    pub unknown: u32,
    /// Blocks that should be there and are not.
    pub missing: u32,
    /// Those of them that are the copy of a header or ending that is there.
    pub spared: u32,
    /// Bytes after the last page.
    pub rest: u32,
    /// Number of the episode, if it has a block.
    pub sequence: Option<u32>,
    /// Whether it has an ending.
    pub ended: bool,
}

impl Report {
    /// Whether the episode is all there.
    pub fn verdict(&self) -> Verdict {
        let damage = self.missing - self.spared + self.stray + self.unknown + self.rest;
        match (self.sequence, self.ended) {
            (None, _) if damage + self.broken == 0 => Verdict::Empty,
            (Some(_), true) if damage == 0 => Verdict::Whole,
            (Some(_), true) => Verdict::Damaged,
            _ => Verdict::Incomplete,
        }
    }
}

/// Goes through the pages of an episode. Any bytes will do; it takes a time in proportion to them.
#[derive(Clone, Debug)]
pub struct Reader<'a> {
    pages: core::slice::Iter<'a, [u8; BLOCK_BYTES]>,
    seen: [bool; MOST_BLOCKS],
    report: Report,
    last: usize,
    headed: bool,
    expected: Option<usize>,
}

impl<'a> Reader<'a> {
    /// Of the pages of a slot, marks excluded.
    pub fn new(bytes: &'a [u8]) -> Self {
        let (pages, rest) = bytes.as_chunks();
        Self {
            pages: pages.iter(),
            seen: [false; MOST_BLOCKS],
            report: Report {
                rest: rest.len() as u32,
                ..Report::default()
            },
            last: 0,
            headed: false,
            expected: None,
        }
    }

    /// Reads to the end; what all of it was.
    pub fn finish(mut self) -> Report {
        while self.next().is_some() {}
        let should = self.expected.unwrap_or(self.last).min(MOST_BLOCKS);
        for (index, seen) in self.seen.iter().take(should).enumerate() {
            let copied =
                (self.headed && index < COPIES) || (self.report.ended && index + COPIES >= should);
            self.report.missing += u32::from(!seen);
            self.report.spared += u32::from(!seen && copied);
        }
        self.report
    }

    fn take(&mut self, sealed: &Sealed<'a>) -> Option<Item<'a>> {
        let index = usize::from(sealed.index);
        let sequence = *self.report.sequence.get_or_insert(sealed.sequence);
        match self.seen.get_mut(index) {
            Some(seen) if !*seen && sequence == sealed.sequence => *seen = true,
            _ => {
                self.report.stray += 1;
                return None;
            }
        }
        self.last = self.last.max(index + 1);
        let item = read(sealed);
        match item {
            Some(Item::Ending(ending)) => {
                self.report.ended = true;
                self.expected = Some(usize::from(ending.blocks));
            }
            Some(Item::Header(_)) => self.headed = true,
            _ => {}
        }
        match item {
            Some(_) => self.report.blocks += 1,
            None => self.report.unknown += 1,
        }
        item
    }
}

impl<'a> Iterator for Reader<'a> {
    type Item = Item<'a>;

    fn next(&mut self) -> Option<Item<'a>> {
        loop {
            match Page::open(self.pages.next()?) {
                Page::Blank => self.report.blank += 1,
                Page::Broken => self.report.broken += 1,
                Page::Sealed(sealed) => {
                    if let Some(item) = self.take(&sealed) {
                        return Some(item);
                    }
                }
            }
        }
    }
}

fn read<'a>(sealed: &Sealed<'a>) -> Option<Item<'a>> {
    let bytes = sealed.payload;
    match sealed.kind? {
        Kind::Header => Header::decode(bytes).map(Item::Header),
        Kind::Waveform => Waveform::decode(bytes).map(Item::Waveform),
        Kind::Events => match bytes.as_chunks() {
            (records, []) => Some(Item::Events(Events(records))),
            _ => None,
        },
        Kind::Severity => {
            let (version, bytes) = bytes.split_first()?;
            Some(Item::Severity(*version, bytes))
        }
        Kind::Ending => Ending::decode(bytes).map(Item::Ending),
    }
}
