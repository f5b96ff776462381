//! `touchdown score`.

use super::args::ScoreArgs;
use crate::gate::Gate;
use touchdown_base::failure::Failure;
use touchdown_lab::score::{Score, json, none_fails, page, run, table};

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
    verdict(&score, args.quick)
}

/// A quick look leaves open what so few trials cannot decide; a full run has to reach every target.
fn verdict(score: &Score, is_quick: bool) -> Result<(), Failure> {
    let missed = score.rows().filter(|row| !row.holds).count();
    let all = score.rows().count();
    if !is_quick && missed > 0 {
        let rule = format!("{missed} of {all} targets of the detector are not reached");
        return Err(Failure::Check(rule));
    }
    if none_fails(score.rows()) {
        return Ok(());
    }
    let broken = score.rows().filter(|row| row.fails()).count();
    Err(Failure::Check(if broken > 0 {
        format!("{broken} of {all} targets of the detector do not hold")
    } else {
        format!("too few trials: not one of {all} targets of the detector is decided")
    }))
}

#[cfg(test)]
mod tests {
    use touchdown_core::detect::Tuning;

    use super::*;
    use touchdown_lab::score::{Findings, GROUPS, Plan, Row};

    fn score(rows: Vec<Row>) -> Score {
        let found = Findings {
            rows,
            figures: Vec::new(),
        };
        Score {
            plan: Plan {
                groups: vec![GROUPS[0].name],
                seeds: 100,
                first_seed: 1,
                seconds: 1.0,
                tuning: Tuning::default(),
            },
            compared: false,
            groups: vec![(&GROUPS[0], found)],
        }
    }

    #[test]
    fn only_a_quick_look_leaves_a_missed_target_open() {
        let holds = || Row::at_most("a", "ratio", 1.0, 1.0);
        // 98 of 100 where 99 are asked for: within chance.
        let open = || Row::at_least("b", "share", 0.98, 0.99).of(100);
        let broken = || Row::at_most("c", "invented", 1.0, 0.0);
        for (rows, full, quick) in [
            (vec![holds()], true, true),
            (vec![holds(), open()], false, true),
            (vec![open()], false, false),
            (vec![holds(), broken()], false, false),
        ] {
            let score = score(rows);
            assert_eq!(verdict(&score, false).is_ok(), full);
            assert_eq!(verdict(&score, true).is_ok(), quick);
        }
    }
}
