//! `touchdown score`.

use std::io;

use super::args::ScoreArgs;
use super::{commit, one_standard_output, open, paint, say};
use crate::failure::Failure;
use crate::score::{Score, json, none_fails, page, run, table};

/// Measures, says and writes the rows; fails where a target is not reached.
pub(super) fn measure(args: &ScoreArgs) -> Result<(), Failure> {
    let names = [&args.json, &args.report];
    one_standard_output(&names)?;
    let plan = args.plan()?;
    let target = args.place.target()?;
    let [json_out, page_out] = names.map(open);
    let (mut json_out, mut page_out) = (json_out?, page_out?);
    let score = run(&plan, &target)?;
    if let Some(out) = &mut json_out {
        let text = json(&score).map_err(io::Error::from);
        out.put(&text.map_err(Failure::output(out.name()))?)?;
    }
    if let Some(out) = &mut page_out {
        out.put(&page(&score))?;
    }
    let files = commit([json_out, page_out, None])?;
    say(&names, &(table(&score, paint(&names)) + &files));
    verdict(&score)
}

fn verdict(score: &Score) -> Result<(), Failure> {
    if none_fails(score.rows()) {
        return Ok(());
    }
    let broken = score.rows().filter(|row| row.fails()).count();
    let all = score.rows().count();
    Err(Failure::Check(if broken > 0 {
        format!("{broken} of {all} targets of the detector do not hold")
    } else {
        format!("too few trials: not one of {all} targets of the detector is decided")
    }))
}
