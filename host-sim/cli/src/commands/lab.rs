//! What the laboratory measures: `touchdown trade`, `paper`, `limits` and `score`.

use super::args::{LimitsArgs, PaperArgs, ScoreArgs, TradeArgs};
use super::{holds, load};
use crate::gate::Gate;
use touchdown_base::failure::Failure;
use touchdown_lab::{limits, paper, score, trade};
use touchdown_page::json::text;

/// Measures, says and writes accuracy against cost.
pub(super) fn measure_trade(args: &TradeArgs) -> Result<(), Failure> {
    let mut out = Gate::new()
        .reads("SCENE", [&args.scene])
        .writes("--json", &args.json)
        .writes("--report", [&args.report])
        .writes("--svg", [&args.svg])
        .open()?;
    let scene = load(&args.scene)?;
    let trade = trade::run(&scene, args.drops.map(|it| it as usize));
    out.json("--json", || text(&trade))?;
    out.put("--report", || trade::page(&trade))?;
    out.put("--svg", || trade::svg(&trade))?;
    out.finish(|paint| trade::table(&trade, paint))
}

/// Works out, says and writes the numbers of the source paper; fails where one of ours is not right.
pub(super) fn check_paper(args: &PaperArgs) -> Result<(), Failure> {
    let mut out = Gate::new()
        .writes("--json", &args.json)
        .writes("--report", [&args.report])
        .open()?;
    let paper = paper::run(args.drops)?;
    out.json("--json", || text(&paper))?;
    out.put("--report", || paper::page(&paper))?;
    out.finish(|paint| paper::table(&paper, paint))?;
    holds(paper.agrees(), || {
        "numbers of ours are not right: those marked with !".to_owned()
    })
}

/// Runs the extremes, says and writes what came of them; fails where a limit does not hold.
pub(super) fn check_limits(args: &LimitsArgs) -> Result<(), Failure> {
    let mut out = Gate::new().writes("--json", &args.json).open()?;
    if let Some(number) = args.machine {
        let machine = limits::machine(number);
        return out.finish(|_| machine.trim_end().to_owned());
    }
    let rows = match args.drops {
        Some(machines) => limits::drops(machines)?,
        None => limits::run(args.machines)?,
    };
    out.json("--json", || limits::json(&rows))?;
    out.finish(|paint| limits::table(&rows, paint))?;
    all_hold(&rows)
}

fn all_hold(rows: &[limits::Row]) -> Result<(), Failure> {
    let broken = rows.iter().filter(|row| !row.holds).count();
    holds(limits::all_hold(rows), || {
        format!("{broken} of {} limits do not hold", rows.len())
    })
}

/// Measures, says and writes how good the detector is; fails where a target is not reached.
pub(super) fn measure_score(args: &ScoreArgs) -> Result<(), Failure> {
    let plan = args.plan()?;
    let target = args.place.target()?;
    let mut out = Gate::new()
        .reads("--image", target.image())
        .writes("--json", &args.json)
        .writes("--report", &args.report)
        .open()?;
    let score = score::run(&plan, &target)?;
    out.json("--json", || score::json(&score))?;
    out.put("--report", || score::page(&score))?;
    out.finish(|paint| score::table(&score, paint))?;
    verdict(&score, args.quick)
}

/// A quick look leaves open what so few trials cannot decide; a full run has to reach every target.
fn verdict(score: &score::Score, is_quick: bool) -> Result<(), Failure> {
    let missed = score.rows().filter(|row| !row.holds).count();
    let all = score.rows().count();
    if !is_quick && missed > 0 {
        let rule = format!("{missed} of {all} targets of the detector are not reached");
        return Err(Failure::Check(rule));
    }
    if score::none_fails(score.rows()) {
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
    use touchdown_lab::score::{Findings, GROUPS, Plan, Row, Score};
    use touchdown_scene::Precision;

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

    #[test]
    fn a_broken_limit_is_a_failed_check() {
        let row = |measured| limits::Row::of("made up", Precision::F64).at_most(measured, 1.0, "s");
        assert!(all_hold(&[row(1.0)]).is_ok());
        let failure = all_hold(&[row(1.0), row(1.5)]).expect_err("1.5 is above 1");
        assert_eq!(failure.status(), 1);
    }
}
