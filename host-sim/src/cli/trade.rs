//! `touchdown trade`.

use std::io;

use super::args::TradeArgs;
use super::{commit, load, one_standard_output, open, paint, say};
use crate::failure::Failure;
use crate::trade;

/// Measures, says and writes the table.
pub(super) fn table(args: &TradeArgs) -> Result<(), Failure> {
    let names = [
        &args.json,
        &Some(args.report.clone()),
        &Some(args.svg.clone()),
    ];
    one_standard_output(&names)?;
    let scene = load(&args.scene)?;
    let [json_out, page_out, svg_out] = names.map(open);
    let (mut json_out, mut page_out, mut svg_out) = (json_out?, page_out?, svg_out?);
    let trade = trade::run(&scene);
    if let Some(out) = &mut json_out {
        let text = trade::json(&trade.rows).map_err(io::Error::from);
        out.put(&text.map_err(Failure::output(out.name()))?)?;
    }
    if let Some(out) = &mut page_out {
        out.put(&trade::page(&trade))?;
    }
    if let Some(out) = &mut svg_out {
        out.put(&trade::svg(&trade))?;
    }
    let files = commit([json_out, page_out, svg_out])?;
    say(&names, &(trade::table(&trade, paint(&names)) + &files));
    Ok(())
}
