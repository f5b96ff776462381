//! `touchdown compare`.

use std::io;
use std::path::Path;

use super::args::CompareArgs;
use super::{commit, load, one_standard_output, open, paint, say, warn};
use crate::compare::{Tolerance, compare, page, table};
use crate::failure::Failure;

/// Compares two recordings; fails where they differ.
pub(super) fn compare_recordings(args: &CompareArgs) -> Result<(), Failure> {
    let names = [&args.json, &args.report];
    one_standard_output(&names)?;
    let scene = load(&args.scene)?;
    let [json_out, page_out] = names.map(open);
    let (mut json_out, mut page_out) = (json_out?, page_out?);
    let [first, second] = args.readings()?;
    let files = [&args.first, &args.second].map(Path::new);
    let tolerance = Tolerance {
        time_s: args.within_ms * 1e-3,
        speed: args.within_percent * 1e-2,
    };
    let comparison = compare(files, [&first, &second], &scene, tolerance)?;
    warn(&comparison.warnings);
    if let Some(out) = &mut json_out {
        let text = serde_json::to_string_pretty(&comparison).map_err(io::Error::from);
        out.put(&(text.map_err(Failure::output(out.name()))? + "\n"))?;
    }
    if let Some(out) = &mut page_out {
        out.put(&page(&scene, &comparison))?;
    }
    let written = commit([json_out, page_out, None])?;
    say(&names, &(table(&comparison, paint(&names)) + &written));
    match comparison.beyond {
        0 => Ok(()),
        _ => Err(Failure::Check(
            "the recordings differ beyond the tolerance".to_owned(),
        )),
    }
}
