//! `touchdown compare`.

use std::path::Path;

use super::args::CompareArgs;
use super::{holds, load, warn};
use crate::gate::Gate;
use touchdown_base::failure::Failure;
use touchdown_files::recording::Mapping;
use touchdown_page::compare::page;
use touchdown_page::json;
use touchdown_run::compare::{Tolerance, compare, table};

/// Compares two recordings; fails where they differ.
pub(super) fn compare_recordings(args: &CompareArgs) -> Result<(), Failure> {
    let mut out = Gate::new()
        .reads_recording("A", &args.first)
        .reads_recording("B", &args.second)
        .reads("--scene", [&args.scene])
        .reads("--columns", &args.reading.columns)
        .reads("--columns-b", &args.columns_b)
        .writes("--json", &args.json)
        .writes("--report", &args.report)
        .open()?;
    let scene = load(&args.scene)?;
    let first = args.reading.load()?;
    let mut second = first.clone();
    if let Some(path) = &args.columns_b {
        second.mapping = Some(Mapping::load(path)?);
    }
    let files = [&args.first, &args.second].map(Path::new);
    let tolerance = Tolerance {
        time_s: args.within_ms * 1e-3,
        speed: args.within_percent * 1e-2,
    };
    let comparison = compare(files, [&first, &second], &scene, tolerance)?;
    warn(&comparison.warnings);
    out.json("--json", || json::text(&comparison))?;
    out.put("--report", || page(&scene, &comparison))?;
    out.finish(|paint| table(&comparison, paint))?;
    holds(comparison.beyond == 0, || {
        "the recordings differ beyond the tolerance".to_owned()
    })
}
