//! `touchdown paper`.

use super::args::PaperArgs;
use crate::gate::Gate;
use touchdown_base::failure::Failure;
use touchdown_lab::paper;
use touchdown_page::json::text;

/// Works out, says and writes the numbers; fails where one of ours is not right.
pub(super) fn check(args: &PaperArgs) -> Result<(), Failure> {
    let mut out = Gate::new()
        .writes("--json", &args.json)
        .writes("--report", [&args.report])
        .open()?;
    let paper = paper::run(args.drops)?;
    out.json("--json", || text(&paper))?;
    out.put("--report", || paper::page(&paper))?;
    let table = paper::table(&paper, out.paint());
    out.finish(&table)?;
    if paper.agrees() {
        Ok(())
    } else {
        Err(Failure::Check(
            "numbers of ours are not right: those marked with !".to_owned(),
        ))
    }
}
