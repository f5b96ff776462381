//! `touchdown paper`.

use std::io;

use super::args::PaperArgs;
use super::{commit, one_standard_output, open, paint, say};
use crate::failure::Failure;
use crate::paper;

/// Works out, says and writes the numbers; fails where one of ours is not right.
pub(super) fn check(args: &PaperArgs) -> Result<(), Failure> {
    let names = [&args.json, &Some(args.report.clone())];
    one_standard_output(&names)?;
    let [json_out, page_out] = names.map(open);
    let (mut json_out, mut page_out) = (json_out?, page_out?);
    let paper = paper::run(args.drops)?;
    if let Some(out) = &mut json_out {
        let text = paper::json(&paper).map_err(io::Error::from);
        out.put(&text.map_err(Failure::output(out.name()))?)?;
    }
    if let Some(out) = &mut page_out {
        out.put(&paper::page(&paper))?;
    }
    let files = commit([json_out, page_out, None])?;
    say(&names, &(paper::table(&paper, paint(&names)) + &files));
    if paper.agrees() {
        Ok(())
    } else {
        Err(Failure::Check(
            "numbers of ours are not right: those marked with !".to_owned(),
        ))
    }
}
