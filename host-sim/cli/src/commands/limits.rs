//! `touchdown limits`.

use super::args::LimitsArgs;
use crate::gate::Gate;
use touchdown_base::failure::Failure;
use touchdown_lab::limits::{Row, all_hold, drops, json, machine, run, table};

/// Runs the extremes, says and writes what came of them; fails where a limit does not hold.
pub(super) fn check(args: &LimitsArgs) -> Result<(), Failure> {
    let mut out = Gate::new().writes("--json", &args.json).open()?;
    if let Some(number) = args.machine {
        return out.finish(machine(number).trim_end());
    }
    let rows = match args.drops {
        Some(machines) => drops(machines)?,
        None => run(args.machines)?,
    };
    out.json("--json", || json(&rows))?;
    let text = table(&rows, out.paint());
    out.finish(&text)?;
    verdict(&rows)
}

fn verdict(rows: &[Row]) -> Result<(), Failure> {
    if all_hold(rows) {
        return Ok(());
    }
    let broken = rows.iter().filter(|row| !row.holds).count();
    Err(Failure::Check(format!(
        "{broken} of {} limits do not hold",
        rows.len()
    )))
}

#[cfg(test)]
mod tests {
    use super::*;
    use touchdown_scene::Precision;

    #[test]
    fn a_broken_limit_is_a_failed_check() {
        let row = |measured| Row::of("made up", Precision::F64).at_most(measured, 1.0, "s");
        assert!(verdict(&[row(1.0)]).is_ok());
        let failure = verdict(&[row(1.0), row(1.5)]).expect_err("1.5 is above 1");
        assert_eq!(failure.status(), 1);
    }
}
