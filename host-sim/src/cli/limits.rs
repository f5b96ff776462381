//! `touchdown limits`.

use std::io;

use super::args::LimitsArgs;
use super::{Verdict, open, say};
use crate::failure::Failure;
use crate::limits::{Row, all_hold, json, run, table};
use crate::output::STDOUT;
use crate::paint::Paint;

/// Runs the extremes, says and writes what came of them.
pub(super) fn check(args: &LimitsArgs) -> Result<Verdict, Failure> {
    let out = open(&args.json)?;
    let rows = run()?;
    let mut text = table(&rows, Paint::for_stdout());
    if let Some(mut out) = out {
        let json = json(&rows).map_err(io::Error::from);
        out.put(&json.map_err(Failure::output(out.name()))?)?;
        if out.name() != STDOUT {
            text += &format!("wrote {}\n", out.name());
        }
        out.commit()?;
    }
    say(&[&args.json], &text);
    Ok(verdict(&rows))
}

fn verdict(rows: &[Row]) -> Verdict {
    if all_hold(rows) {
        Verdict::Done
    } else {
        Verdict::DoesNotHold
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::Precision;

    #[test]
    fn a_broken_limit_ends_with_another_verdict() {
        let row = |measured| Row::new("made up", Precision::F64, measured, 1.0, "s");
        assert_eq!(verdict(&[row(1.0)]), Verdict::Done);
        assert_eq!(verdict(&[row(1.0), row(1.5)]), Verdict::DoesNotHold);
    }
}
