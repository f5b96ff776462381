//! `touchdown trade`.

use super::args::TradeArgs;
use super::load;
use crate::gate::Gate;
use touchdown_base::failure::Failure;
use touchdown_lab::trade;
use touchdown_page::json::text;

/// Measures, says and writes the table.
pub(super) fn table(args: &TradeArgs) -> Result<(), Failure> {
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
    let table = trade::table(&trade, out.paint());
    out.finish(&table)
}
