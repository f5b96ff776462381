//! Runs the parts of a sweep that are not there yet.

use std::ops::Range;
use std::path::Path;

use indicatif::ProgressBar;
use rayon::prelude::*;

use super::draw::{Drawn, Scenes};
use super::part::{Part, first_line};
use super::plan::{Plan, Until};
use super::record::{Record, cells, columns, put_rows};
use touchdown_base::failure::Failure;
use touchdown_base::input_error::InputError;
use touchdown_base::output::Output;
use touchdown_base::progress;
use touchdown_run::model::{simulate, simulate_to_verdict};

/// Blocks that are simulated together, in parallel, and held in memory.
const TOGETHER: usize = 64;

/// Runs those of `parts` that `folder` does not have; how many drops it had.
pub fn run(plan: &Plan, parts: &[Part], folder: &Path) -> Result<u64, Failure> {
    let mut missing = Vec::new();
    let (mut had, mut all) = (0, 0);
    for part in parts {
        let size = part.size(plan);
        all += size;
        if part.is_done(plan, folder)? {
            had += size;
        } else {
            missing.push(*part);
        }
    }
    let bar = progress::bar("sweep", all);
    bar.set_position(had);
    bar.reset_eta();
    for part in missing {
        write(plan, part, folder, &bar)?;
    }
    bar.finish_and_clear();
    Ok(had)
}

fn write(plan: &Plan, part: Part, folder: &Path, bar: &ProgressBar) -> Result<(), Failure> {
    let mut out = Output::create(&part.path(folder).display().to_string())?;
    out.put(&first_line(plan))?;
    put_rows(&mut out, [columns(plan)])?;
    let blocks: Vec<_> = part.blocks(plan).collect();
    for blocks in blocks.chunks(TOGETHER) {
        let simulated: Vec<_> = (blocks.par_iter())
            .map(|drops| simulated(plan, drops.clone(), bar))
            .collect::<Result<_, _>>()?;
        let records = simulated.iter().flatten();
        let rows = records.map(|it| cells(plan, &plan.draw(it.index), it));
        put_rows(&mut out, rows)?;
    }
    out.commit()
}

fn simulated(plan: &Plan, drops: Range<u64>, bar: &ProgressBar) -> Result<Vec<Record>, Failure> {
    let mut scenes = Scenes::new(plan);
    let record = |index| {
        let record = scenes.record(&plan.draw(index), index)?;
        bar.inc(1);
        Ok(record)
    };
    drops.map(record).collect()
}

impl Scenes<'_> {
    /// What drop `index` of the plan comes to.
    pub(super) fn record(&mut self, drawn: &Drawn, index: u64) -> Result<Record, Failure> {
        let (scene, plan) = (self.of(drawn)?, self.plan);
        let history = match plan.until {
            Until::End => simulate(&scene),
            Until::Verdict => simulate_to_verdict(&scene),
        };
        let history = history
            .map_err(|error| InputError::of_file(&plan.name, format!("drop {index}: {error}")))?;
        let mut record = Record::of(index, &scene, &history);
        if plan.until == Until::Verdict {
            // What only the end of the run shows.
            (record.end_load, record.whirl_frequency) = (None, None);
        }
        Ok(record)
    }
}
