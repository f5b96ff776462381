//! Reads an episode from any bytes: what is whole is given, what is not is counted.

use super::block::{BLOCK_BYTES, Kind, Page, Sealed};
use super::ending::Ending;
use super::header::Header;
use super::pulses::Pulses;
use super::waveform::Waveform;
use crate::wire::NOTICE_BYTES;

/// Most blocks of an episode.
pub const MOST_BLOCKS: usize = 256;
/// Header and ending come so many times, so that a wrong bit loses neither.
pub const COPIES: usize = 2;

/// What a block says.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Item<'a> {
    /// What it is a record of; comes twice.
    Header(Header),
    /// A part of what had been learnt.
    Learnt(&'a [u8]),
    /// Samples.
    Waveform(Waveform<'a>),
    /// Pulses.
    Pulses(Pulses<'a>),
    /// Notices, and changes of what the controller shows: [`crate::wire::decode_record`].
    Events(&'a [[u8; NOTICE_BYTES]]),
    /// How severe it was: a version and that version's bytes.
    Severity(u8, &'a [u8]),
    /// What it added up to; comes twice.
    Ending(Ending),
}

/// Whether an episode is all there.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, serde::Serialize, serde::Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Verdict {
    /// No block at all.
    #[default]
    Empty,
    /// All that was recorded is there and right.
    Whole,
    /// It has no ending: cut off, or still being written.
    Incomplete,
    /// Something is broken, missing, foreign or unknown, whether it has an ending or not.
    Damaged,
}

/// What is wrong with a page.
#[derive(Clone, Copy, Debug, PartialEq, Eq, serde::Serialize)]
#[serde(rename_all = "snake_case")]
#[derive(strum::IntoStaticStr, strum::VariantArray)]
#[strum(serialize_all = "snake_case")]
pub enum DamageKind {
    /// Its block is not there.
    Missing,
    /// Neither erased nor a block.
    Broken,
    /// A block of another episode, or a second time.
    Stray,
    /// A right block whose content is of no known kind or version.
    Unknown,
}

/// A page that costs the episode something.
#[derive(Clone, Copy, Debug, PartialEq, Eq, serde::Serialize)]
pub struct Damage {
    /// Place in the episode, from 0.
    pub page: usize,
    /// What is wrong with it.
    pub what: DamageKind,
}

/// What reading found. Every page is counted in one of the first five.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, serde::Serialize, serde::Deserialize)]
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
    /// Pages that cost the episode something: no copy, and not the page that a cut of power has torn.
    #[serde(default)]
    pub damaged: u32,
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
        match (self.sequence, self.ended) {
            _ if self.damaged + self.rest > 0 => Verdict::Damaged,
            (None, _) if self.broken == 0 => Verdict::Empty,
            (Some(_), true) => Verdict::Whole,
            _ => Verdict::Incomplete,
        }
    }
}

/// Goes through the pages of an episode. Any bytes will do; it takes a time in proportion to them.
#[derive(Clone, Debug)]
pub struct Reader<'a> {
    pages: core::iter::Enumerate<core::slice::Iter<'a, [u8; BLOCK_BYTES]>>,
    seen: [bool; MOST_BLOCKS],
    /// By page.
    wrong: [Option<DamageKind>; MOST_BLOCKS],
    /// Behind the last page that is not erased.
    end: usize,
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
            pages: pages.iter().enumerate(),
            seen: [false; MOST_BLOCKS],
            wrong: [None; MOST_BLOCKS],
            end: 0,
            report: Report {
                rest: rest.len() as u32,
                ..Report::default()
            },
            last: 0,
            headed: false,
            expected: None,
        }
    }

    /// Reads to the end; what all of it was. Tells each page that is damaged, in their order.
    pub fn finish(mut self, mut tell: impl FnMut(Damage)) -> Report {
        while self.next().is_some() {}
        let should = self.expected.unwrap_or(self.last).min(MOST_BLOCKS);
        let pages = self.seen.iter().zip(&self.wrong).enumerate();
        for (page, (seen, wrong)) in pages {
            let copied =
                (self.headed && page < COPIES) || (self.report.ended && page + COPIES >= should);
            let missing = page < should && !seen;
            self.report.missing += u32::from(missing);
            self.report.spared += u32::from(missing && copied);
            // The page that was being written when power went: right behind the last block, and nothing behind it.
            let torn = !self.report.ended && page == self.last && page + 1 == self.end;
            let what = match wrong {
                Some(DamageKind::Broken) if torn || (missing && copied) => None,
                None if missing && !copied => Some(DamageKind::Missing),
                what => *what,
            };
            if let Some(what) = what {
                self.report.damaged += 1;
                tell(Damage { page, what });
            }
        }
        self.report
    }

    /// What is wrong with a page; of those that are too many for an episode only how many.
    fn spot(&mut self, page: usize, what: DamageKind) {
        match self.wrong.get_mut(page) {
            Some(wrong) => *wrong = Some(what),
            None => self.report.damaged += 1,
        }
        match what {
            DamageKind::Broken => self.report.broken += 1,
            DamageKind::Stray => self.report.stray += 1,
            DamageKind::Unknown => self.report.unknown += 1,
            DamageKind::Missing => {}
        }
    }

    fn take(&mut self, page: usize, sealed: &Sealed<'a>) -> Option<Item<'a>> {
        let index = usize::from(sealed.index);
        let sequence = *self.report.sequence.get_or_insert(sealed.sequence);
        match self.seen.get_mut(index) {
            Some(seen) if !*seen && sequence == sealed.sequence => *seen = true,
            _ => {
                self.spot(page, DamageKind::Stray);
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
            None => self.spot(page, DamageKind::Unknown),
        }
        item
    }
}

impl<'a> Iterator for Reader<'a> {
    type Item = Item<'a>;

    fn next(&mut self) -> Option<Item<'a>> {
        loop {
            let (page, bytes) = self.pages.next()?;
            let opened = Page::open(bytes);
            if opened != Page::Blank {
                self.end = page + 1;
            }
            match opened {
                Page::Blank => self.report.blank += 1,
                Page::Broken => self.spot(page, DamageKind::Broken),
                Page::Sealed(sealed) => {
                    if let Some(item) = self.take(page, &sealed) {
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
        Kind::Learnt => Some(Item::Learnt(bytes)),
        Kind::Waveform => Waveform::decode(bytes).map(Item::Waveform),
        Kind::Pulses => Pulses::decode(bytes).map(Item::Pulses),
        Kind::Events => match bytes.as_chunks() {
            (records, []) => Some(Item::Events(records)),
            _ => None,
        },
        Kind::Severity => {
            let (version, bytes) = bytes.split_first()?;
            Some(Item::Severity(*version, bytes))
        }
        Kind::Ending => Ending::decode(bytes).map(Item::Ending),
    }
}
