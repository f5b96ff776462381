//! A part of a sweep as a file, `part-K-of-N.csv`: it is there as a whole or not at all.
//!
//! Its first line is a comment with version, plan and scene as JSON. The table of its drops follows.

use std::fs::File;
use std::io::{BufRead, BufReader, Read};
use std::ops::Range;
use std::path::{Path, PathBuf};

use csv::{StringRecord, StringRecordsIntoIter};
use serde::{Deserialize, Serialize};

use super::plan::Plan;
use super::record::{Record, columns};
use touchdown_base::failure::Failure;
use touchdown_base::input_error::{InputError, LARGEST_TOML, reason};
use touchdown_files::stream::{Account, Bounded};

/// Drops of a block. Blocks are dealt to the parts in turn, so that each part has its share of slow drops.
const BLOCK: u64 = 256;
/// A run without `--shard` has as many parts as have this many blocks each: what a kill can lose at most.
const BLOCKS_PER_PART: u64 = 4;
/// Most parts of a run without `--shard`.
const MOST_PARTS: u64 = 64;

/// Longest first line: a plan and a scene, of which no letter takes more than six in JSON.
const LONGEST_LINE: u64 = 13 * LARGEST_TOML;

/// One part of a sweep, `part` of `parts`, counted from 1.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Part {
    /// Its number.
    pub part: u64,
    /// How many there are.
    pub parts: u64,
}

/// Whose part a file is.
#[derive(Deserialize, PartialEq, Serialize)]
struct Origin {
    version: String,
    plan: String,
    scene: String,
}

/// Rows of a part, one drop after the other.
pub(super) struct PartReader {
    name: String,
    columns: usize,
    rows: StringRecordsIntoIter<Bounded<BufReader<File>>>,
}

impl Part {
    /// Most parts that can be merged: they are all open at once.
    pub const MOST: u64 = 512;

    /// The parts of a run without `--shard`.
    pub fn all(plan: &Plan) -> Vec<Self> {
        let parts = (blocks(plan) / BLOCKS_PER_PART).clamp(1, MOST_PARTS);
        (1..=parts).map(|part| Self { part, parts }).collect()
    }

    /// Its file.
    pub fn path(self, folder: &Path) -> PathBuf {
        folder.join(format!("part-{}-of-{}.csv", self.part, self.parts))
    }

    /// From the name of its file.
    pub fn of_path(path: &Path) -> Option<Self> {
        let stem = path.file_name()?.to_str()?.strip_suffix(".csv")?;
        let (part, parts) = stem.strip_prefix("part-")?.split_once("-of-")?;
        Some(Self {
            part: part.parse().ok()?,
            parts: parts.parse().ok()?,
        })
    }

    /// Its blocks, each a range of drops.
    pub(super) fn blocks(self, plan: &Plan) -> impl Iterator<Item = Range<u64>> + use<'_> {
        let own = (self.part - 1..blocks(plan)).step_by(self.parts as usize);
        own.map(|block| drops(plan, block))
    }

    /// How many drops it has.
    pub(super) fn size(self, plan: &Plan) -> u64 {
        self.blocks(plan).map(|it| it.end - it.start).sum()
    }

    /// Whether its file is in `folder`. A file that is not this part of `plan`, as a whole, is an error.
    pub(super) fn is_done(self, plan: &Plan, folder: &Path) -> Result<bool, Failure> {
        let path = self.path(folder);
        if !path.exists() {
            return Ok(false);
        }
        let mut reader = PartReader::open(&path, plan)?;
        for index in self.blocks(plan).flatten() {
            reader.row(index)?;
        }
        Ok(true)
    }
}

impl PartReader {
    /// Opens a part of `plan`.
    pub fn open(path: &Path, plan: &Plan) -> Result<Self, Failure> {
        let name = path.display().to_string();
        let (origin, file) = opened(path)?;
        let here = Origin::of(plan);
        if origin != here {
            let rule = if origin.version == here.version {
                "belongs to another plan or scene; remove it, or give another folder with --out"
                    .to_owned()
            } else {
                format!(
                    "was written by version {}, this is {}; remove it, or give another folder with --out",
                    origin.version, here.version
                )
            };
            return Err(InputError::at_line(&name, 1, rule).into());
        }
        Ok(Self {
            columns: columns(plan).len(),
            rows: csv::ReaderBuilder::new()
                .flexible(true)
                .from_reader(Bounded::new(file, &Account::default()))
                .into_records(),
            name,
        })
    }

    /// The row of drop `index`, which must be the next, and what it says.
    pub fn row(&mut self, index: u64) -> Result<(StringRecord, Record), Failure> {
        let row = self.rows.next().and_then(Result::ok).filter(|row| {
            row.len() == self.columns && row.get(0).is_some_and(|it| it == index.to_string())
        });
        let read = row.and_then(|row| Some((Record::of_row(&row)?, row)));
        let (record, row) = read.ok_or_else(|| {
            let rule = format!(
                "the row of drop {index} is missing or damaged; remove the file, and run the part again"
            );
            InputError::of_file(&self.name, rule)
        })?;
        Ok((row, record))
    }
}

impl Origin {
    fn of(plan: &Plan) -> Self {
        Self {
            version: env!("CARGO_PKG_VERSION").to_owned(),
            plan: plan.text.clone(),
            scene: plan.scene_text.clone(),
        }
    }
}

/// The first line of a part of `plan`.
pub(super) fn first_line(plan: &Plan) -> String {
    let origin = serde_json::to_string(&Origin::of(plan));
    // Three texts are always JSON.
    format!("# {}\n", origin.unwrap_or_default())
}

/// The plan that the part at `path` belongs to.
pub(super) fn plan_of(path: &Path) -> Result<Plan, Failure> {
    let (origin, _) = opened(path)?;
    let name = path.display().to_string();
    Ok(Plan::of_texts(&name, &origin.plan, &origin.scene)?)
}

fn opened(path: &Path) -> Result<(Origin, BufReader<File>), Failure> {
    let name = path.display().to_string();
    let unread = |error: std::io::Error| InputError::of_file(&name, reason(&error));
    let (mut file, _) = InputError::open(path)?;
    let mut line = Vec::new();
    (file.by_ref().take(LONGEST_LINE))
        .read_until(b'\n', &mut line)
        .map_err(unread)?;
    let origin = line
        .strip_prefix(b"# ")
        .and_then(|it| serde_json::from_slice(it).ok());
    let origin =
        origin.ok_or_else(|| InputError::at_line(&name, 1, "is not the part of a sweep"))?;
    Ok((origin, file))
}

/// Number of blocks in all.
pub(super) fn blocks(plan: &Plan) -> u64 {
    plan.size().div_ceil(BLOCK)
}

/// The drops of a block.
pub(super) fn drops(plan: &Plan, block: u64) -> Range<u64> {
    let first = block * BLOCK;
    first..(first + BLOCK).min(plan.size())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_part_is_known_by_its_file_name() {
        let part = Part { part: 3, parts: 24 };
        assert_eq!(Part::of_path(&part.path(Path::new("run"))), Some(part));
        for other in ["drops.csv", "part-3-of-24.sweep", "part-x-of-2.csv"] {
            assert_eq!(Part::of_path(Path::new(other)), None, "{other}");
        }
    }
}
