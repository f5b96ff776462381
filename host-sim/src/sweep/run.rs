//! Runs what a part of a sweep has not done yet.

use std::collections::HashSet;
use std::path::Path;
use std::sync::Mutex;

use rayon::prelude::*;

use super::draw::Scenes;
pub use super::journal::Part;
use super::journal::{BLOCK, Journal};
use super::plan::Plan;
use super::record::Record;
use crate::failure::Failure;
use crate::input_error::InputError;
use crate::model_run::simulate;
use crate::progress;

/// Runs the blocks of `part` that its journal in `folder` does not have; how many drops it had.
pub fn run(plan: &Plan, part: Part, folder: &Path) -> Result<u64, Failure> {
    let journal = Journal::open(folder, part, plan)?;
    let done: HashSet<u64> = journal.blocks.iter().map(|(block, _)| *block).collect();
    let blocks = (0..plan.size().div_ceil(BLOCK)).filter(|block| part.has(*block));
    let missing: Vec<u64> = blocks.filter(|block| !done.contains(block)).collect();
    let had = done
        .iter()
        .map(|block| drops(plan, *block).count() as u64)
        .sum();
    let left: u64 = missing
        .iter()
        .map(|block| drops(plan, *block).count() as u64)
        .sum();
    let bar = progress::bar("sweep", had + left);
    bar.set_position(had);
    bar.reset_eta();
    let journal = Mutex::new(journal);
    let outcome = missing.par_iter().try_for_each(|block| {
        let records = simulated(plan, *block)?;
        bar.inc(records.len() as u64);
        let mut journal = journal.lock().map_err(|_| lost())?;
        journal.append(*block, &records)
    });
    bar.finish_and_clear();
    outcome.map(|()| had)
}

fn lost() -> Failure {
    Failure::Check("a thread of the sweep failed".to_owned())
}

/// The drops of a block.
fn drops(plan: &Plan, block: u64) -> std::ops::Range<u64> {
    let first = block * BLOCK;
    first..(first + BLOCK).min(plan.size())
}

fn simulated(plan: &Plan, block: u64) -> Result<Vec<Record>, Failure> {
    let mut scenes = Scenes::new(plan);
    let record = |index| {
        let scene = scenes.of(&plan.draw(index))?;
        let history = simulate(&scene)
            .map_err(|error| InputError::of_file(&plan.name, format!("drop {index}: {error}")))?;
        Ok(Record::of(index, &scene, &history))
    };
    drops(plan, block).map(record).collect()
}
