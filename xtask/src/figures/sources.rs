//! What a template may ask for.

use std::fs;
use std::path::Path;

use anyhow::{Context, bail, ensure};
use serde_json::Value;

use super::blocks::Document;
use super::counted::{self, Counts};
use super::peers;
use super::program::Program;
use super::template::Figure;
use crate::budget;
use crate::workspace;

/// All that was measured.
pub struct Sources<'a> {
    steps: Counts,
    functions: Counts,
    measured: Value,
    program: Program,
    peers: String,
    documents: &'a [Document],
}

impl<'a> Sources<'a> {
    /// Reads what is kept, and runs the program.
    pub fn read(program: &Path, documents: &'a [Document]) -> anyhow::Result<Self> {
        let read = |file: &str| {
            let text = fs::read_to_string(workspace().join(file));
            text.with_context(|| format!("cannot read {file}"))
        };
        Ok(Self {
            steps: Counts::read("instructions.csv")?,
            functions: Counts::read("functions.csv")?,
            measured: serde_json::from_str(&read(budget::MEASURED)?)?,
            peers: read("benches/peers/RESULTS.md")?,
            program: Program::run(program)?,
            documents,
        })
    }

    /// The figure that these words ask for: a source, and what of it.
    pub fn figure(&self, words: &[&str]) -> anyhow::Result<Figure> {
        let (source, words) = words.split_first().context("no source is named")?;
        match *source {
            "step" => self.steps.step(words),
            "function" => self.functions.function(words),
            "budget" => counted::budget(&self.measured, words),
            "modules" => counted::modules(&self.measured),
            "faults" => counted::planted(),
            "limits" => self.program.limits(words),
            "paper" => self.program.paper(words),
            "trade" => self.program.trade(words),
            "drop" => Ok(self.program.drop()),
            "peers" => peers::figure(&self.peers, words),
            "cell" => self.cell(words),
            _ => bail!("{source} is no source"),
        }
    }

    /// `TABLE ROW COLUMN`: text of a stamped table's cell.
    fn cell(&self, words: &[&str]) -> anyhow::Result<Figure> {
        let [table, row, column] = *words else {
            bail!("it takes a table, a text of the row and a column");
        };
        let blocks = |document: &'a Document| document.blocks.iter().map(move |it| (document, it));
        let mut blocks = self.documents.iter().flat_map(blocks);
        let (document, block) = blocks
            .find(|(_, block)| block.name == table)
            .with_context(|| format!("no table is called {table}"))?;
        ensure!(
            block.stamped,
            "{table} is generated: take the figure from its source"
        );
        Ok(Figure::Text(document.cell(block, row, column)?))
    }
}
