//! `touchdown sweep`.

use std::path::Path;

use super::args::{SweepArgs, SweepCommand};
use crate::gate::{Gate, Outputs, note};
use touchdown_base::failure::Failure;
use touchdown_sweep::{Part, Plan, RESULTS, Results, find, found, run, table, write};

/// Runs a plan, or a part of it, or puts parts together.
pub(super) fn sweep(args: &SweepArgs) -> Result<(), Failure> {
    if let Some(SweepCommand::Merge { folders, json }) = &args.command {
        return merge(folders, json);
    }
    let usage = |rule: &str| Err(Failure::Usage(rule.to_owned()));
    let Some(name) = &args.plan else {
        return usage("sweep needs a plan: touchdown sweep PLAN.toml");
    };
    if args.shard.is_some() && args.json.is_some() {
        return usage("a part has no result of its own: give --json to sweep merge");
    }
    let plan = Plan::load(name)?;
    let stem = Path::new(name).file_stem().unwrap_or_default();
    let folder = format!("{}-sweep", stem.to_string_lossy());
    let folder = args.out.clone().unwrap_or(folder);
    let gate = gate(&folder, &args.json)
        .reads("PLAN", [name])
        .reads("the plan's scene", &plan.scene_file);
    if let Some(rule) = plan.find {
        if args.shard.is_some() {
            return usage("a search is not divided: run it without --shard");
        }
        let out = gate.open()?;
        let (tried, results) = find(&plan, rule, Path::new(&folder))?;
        return finish(&tried, results, out);
    }
    let parts = args.shard.map_or_else(|| Part::all(&plan), |it| vec![it]);
    let paths: Vec<_> = parts.iter().map(|it| it.path(Path::new(&folder))).collect();
    let out = gate.claims("--out", &paths).open()?;
    let had = run(&plan, &parts, Path::new(&folder))?;
    if had > 0 {
        note(&format!("{folder} had {had} drops already\n"));
    }
    if let Some(Part { part, parts }) = args.shard {
        let next = format!("when all are: touchdown sweep merge {folder}");
        return out.finish(|_| format!("part {part} of {parts} is done; {next}\n"));
    }
    finish(&plan, write(&plan, &paths, Path::new(&folder))?, out)
}

fn merge(folders: &[String], json: &Option<String>) -> Result<(), Failure> {
    let (plan, parts) = found(folders)?;
    let folder = folders.first().cloned().unwrap_or_default();
    let out = gate(&folder, json).reads("FOLDER", &parts).open()?;
    finish(&plan, write(&plan, &parts, Path::new(&folder))?, out)
}

/// Of what every sweep writes.
fn gate(folder: &str, json: &Option<String>) -> Gate {
    Gate::new()
        .makes_folder(folder)
        .claims("--out", RESULTS.map(|it| Path::new(folder).join(it)))
        .writes("--json", json)
}

fn finish(plan: &Plan, results: Results, mut out: Outputs) -> Result<(), Failure> {
    out.put("--json", || results.json)?;
    out.add("--out", results.outputs);
    let found = results.found.map(|it| it.told() + "\n");
    out.finish(|paint| table(plan, &results.points, paint) + &found.unwrap_or_default())
}
