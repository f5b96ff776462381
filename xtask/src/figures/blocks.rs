//! Finds the tables of a document.

use std::ops::Range;
use std::str::Lines;

use anyhow::{Context, bail, ensure};

use super::stamp;

const OPENS: &str = "<!-- table:";
const CLOSES: &str = "<!-- end -->";

/// A document and its tables.
#[derive(Clone, Debug)]
pub struct Document {
    /// From the workspace on.
    pub file: String,
    pub text: String,
    pub blocks: Vec<Block>,
}

#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Block {
    pub name: String,
    /// Of the opening marker, from 1.
    pub line: usize,
    /// Whether it says where its figures come from.
    pub stamped: bool,
    /// Bytes between the markers' lines.
    pub body: Range<usize>,
}

impl Document {
    /// Errors name file and line.
    pub fn parse(file: String, text: String) -> anyhow::Result<Self> {
        let (mut blocks, mut open, mut at) = (Vec::new(), None::<Block>, 0);
        for (index, line) in text.split_inclusive('\n').enumerate() {
            let place = format!("{file}:{}", index + 1);
            let start = at;
            at += line.len();
            let line = line.trim_end();
            if line.starts_with(OPENS) {
                if let Some(Block { name, line, .. }) = open {
                    bail!("{place}: table {name} of line {line} is open");
                }
                open = Some(opening(line, index + 1, at).context(place)?);
            } else if line == CLOSES {
                let Some(mut block) = open.take() else {
                    bail!("{place}: no table is open here");
                };
                block.body.end = start;
                blocks.push(block);
            }
        }
        if let Some(block) = open {
            bail!("{file}:{}: table {} is not closed", block.line, block.name);
        }
        Ok(Self { file, text, blocks })
    }

    /// File and line.
    pub fn place(&self, block: &Block) -> String {
        format!("{}:{}", self.file, block.line)
    }

    /// Text of a table's cell: the one row that contains `row`, the column of that heading.
    pub fn cell(&self, block: &Block, row: &str, column: &str) -> anyhow::Result<String> {
        let (rows, place) = self.column(block, column)?;
        let rows: Vec<_> = rows.filter(|line| line.contains(row)).collect();
        let (count, name) = (rows.len(), &block.name);
        ensure!(count == 1, "{count} rows of {name} contain \"{row}\"");
        let found = cells(rows[0]).into_iter().nth(place);
        found.with_context(|| format!("that row of {name} is short"))
    }

    /// Name of the row with the largest number in the column of that heading.
    pub fn most(&self, block: &Block, column: &str) -> anyhow::Result<String> {
        let (rows, place) = self.column(block, column)?;
        let numbers = rows.filter_map(|line| {
            let cells = cells(line);
            let number: u64 = cells.get(place)?.parse().ok()?;
            Some((number, cells.into_iter().next()?))
        });
        let most = numbers.max_by_key(|it| it.0);
        let most = most.with_context(|| format!("{} has no number there", block.name))?;
        Ok(most.1)
    }

    /// Lines of a table below its heading, and the place of a column in them.
    fn column(&self, block: &Block, column: &str) -> anyhow::Result<(Lines<'_>, usize)> {
        let mut lines = self.text[block.body.clone()].lines();
        let heading = cells(lines.next().unwrap_or_default());
        let place = heading.iter().position(|it| it == column);
        let place = place.with_context(|| format!("{} has no column {column}", block.name))?;
        Ok((lines, place))
    }
}

/// Of a row.
fn cells(line: &str) -> Vec<String> {
    let inner = line.trim().trim_matches('|').split('|');
    inner.map(|it| it.trim().to_owned()).collect()
}

/// Of the marker: name and stamp; the body begins at byte `from`.
fn opening(marker: &str, line: usize, from: usize) -> anyhow::Result<Block> {
    let inner = marker.trim_start_matches(OPENS).strip_suffix("-->");
    let inner = inner.context("the marker does not end with -->")?.trim();
    let (name, stamp) = inner.split_once(';').unzip();
    let name = name.unwrap_or(inner);
    if let Some(stamp) = stamp {
        stamp::check(stamp.trim())?;
    }
    let plain = |it: char| it.is_ascii_lowercase() || it.is_ascii_digit() || it == '-';
    let is_name = !name.is_empty() && name.chars().all(plain);
    ensure!(is_name, "\"{name}\" is no name of a table");
    Ok(Block {
        name: name.to_owned(),
        line,
        stamped: stamp.is_some(),
        body: from..from,
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn error(text: &str) -> String {
        let parsed = Document::parse("a.md".into(), text.into());
        format!("{:#}", parsed.unwrap_err())
    }

    #[test]
    fn a_table_is_what_stands_between_the_markers() {
        let text = "x\n<!-- table: a-1 -->\n| n | m |\n|---|---|\n| one | 2 |\n<!-- end -->\ny\n";
        let document = Document::parse("a.md".into(), text.into()).unwrap();
        let [block] = &document.blocks[..] else {
            panic!("{:?}", document.blocks);
        };
        assert_eq!((block.name.as_str(), block.line), ("a-1", 2));
        assert!(text[block.body.clone()].starts_with("| n |"));
        assert!(text[block.body.end..].starts_with("<!-- end"));
        assert_eq!(document.cell(block, "one", "m").unwrap(), "2");
        assert!(document.cell(block, "two", "m").is_err());
        assert!(document.cell(block, "one", "k").is_err());
        assert_eq!(document.most(block, "m").unwrap(), "one");
        assert!(document.most(block, "n").is_err());
    }

    #[test]
    fn errors_name_file_and_line() {
        assert_eq!(
            error("<!-- table: a -->\n"),
            "a.md:1: table a is not closed"
        );
        assert_eq!(
            error("<!-- table: a -->\n<!-- table: b -->\n<!-- end -->\n"),
            "a.md:2: table a of line 1 is open"
        );
        assert_eq!(error("\n<!-- end -->\n"), "a.md:2: no table is open here");
        assert!(error("<!-- table: -->\n<!-- end -->\n").starts_with("a.md:1: \"\" is no name"));
        assert!(error("<!-- table: a; measured now -->\n").starts_with("a.md:1: "));
    }
}
