//! `touchdown sweep`.

use std::fs;
use std::path::{Path, PathBuf};

use super::args::{MergeArgs, SweepArgs, SweepCommand};
use super::{commit, open, paint, remark, say};
use crate::failure::Failure;
use crate::output::Output;
use crate::sweep::{Part, Plan, found, run, table, write};

/// Runs a plan, or a part of it, or puts parts together.
pub(super) fn sweep(args: &SweepArgs) -> Result<(), Failure> {
    if let Some(SweepCommand::Merge(args)) = &args.command {
        return merge(args);
    }
    let Some(name) = &args.plan else {
        return Err(Failure::Usage(
            "sweep needs a plan: touchdown sweep PLAN.toml".to_owned(),
        ));
    };
    let plan = Plan::load(name)?;
    let folder = args.out.clone().unwrap_or_else(|| {
        let stem = Path::new(name)
            .file_stem()
            .unwrap_or_default()
            .to_string_lossy();
        format!("{stem}-sweep")
    });
    if args.shard.is_some() && args.json.is_some() {
        let rule = "a part has no result of its own: give --json to sweep merge";
        return Err(Failure::Usage(rule.to_owned()));
    }
    fs::create_dir_all(&folder).map_err(Failure::output(&folder))?;
    let json_out = open(&args.json)?;
    let parts = args.shard.map_or_else(|| Part::all(&plan), |it| vec![it]);
    let had = run(&plan, &parts, Path::new(&folder))?;
    if had > 0 {
        remark(&format!("{folder} had {had} drops already\n"));
    }
    if let Some(Part { part, parts }) = args.shard {
        let text = format!(
            "part {part} of {parts} is done; when all are: touchdown sweep merge {folder}\n"
        );
        say(&[], &text);
        return Ok(());
    }
    let paths: Vec<_> = parts.iter().map(|it| it.path(Path::new(&folder))).collect();
    finish(&plan, &paths, &folder, &args.json, json_out)
}

fn merge(args: &MergeArgs) -> Result<(), Failure> {
    let json_out = open(&args.json)?;
    let (plan, parts) = found(&args.folders)?;
    let folder = args.folders.first().cloned().unwrap_or_default();
    finish(&plan, &parts, &folder, &args.json, json_out)
}

fn finish(
    plan: &Plan,
    parts: &[PathBuf],
    folder: &str,
    json_name: &Option<String>,
    mut json_out: Option<Output>,
) -> Result<(), Failure> {
    let written = write(plan, parts, Path::new(folder))?;
    if let Some(out) = &mut json_out {
        out.put(&written.json)?;
    }
    let mut text = table(plan, &written.points, paint(&[json_name]));
    for name in &written.names {
        text += &format!("wrote {name}\n");
    }
    let files = commit([json_out, None, None])?;
    say(&[json_name], &(text + &files));
    Ok(())
}
