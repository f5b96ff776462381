//! `touchdown score`.

use super::args::ScoreArgs;
use crate::failure::Failure;
use crate::gate::Gate;
use crate::score::{Score, json, none_fails, page, run, table};

/// Measures, says and writes the rows; fails where a target is not reached.
pub(super) fn measure(args: &ScoreArgs) -> Result<(), Failure> {
    let plan = args.plan()?;
    let target = args.place.target()?;
    let mut out = Gate::new()
        .reads("--image", target.image())
        .writes("--json", &args.json)
        .writes("--report", &args.report)
        .open()?;
    let score = run(&plan, &target)?;
    out.json("--json", || json(&score))?;
    out.put("--report", || page(&score))?;
    let text = table(&score, out.paint());
    out.finish(&text)?;
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
