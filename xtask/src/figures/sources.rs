//! What a template may ask for: `xtask/figures/README.md`.

use std::collections::BTreeMap;
use std::path::Path;

use anyhow::{Context, ensure};
use minijinja::{Environment, Error, ErrorKind, UndefinedBehavior, context};
use serde_json::{Value, json};

use super::blocks::{Block, Document};
use super::{number, program};
use crate::{budget, faults, files, workspace};

type Map<V> = BTreeMap<String, V>;

/// Reads what is kept, and runs the program; what is returned fills in a template with these figures.
pub fn filler(
    program: &Path,
    documents: &[Document],
) -> anyhow::Result<impl Fn(&str) -> anyhow::Result<String>> {
    let arguments = ["limits --json -", "paper --json -", "trade", ""];
    let [limits, paper, trade, drop] = program::printed(program, arguments)?;
    let limits: Value = serde_json::from_str(&limits).context("touchdown limits --json -")?;
    let paper: Value = serde_json::from_str(&paper).context("touchdown paper --json -")?;
    let measured: Value = serde_json::from_str(&read(budget::MEASURED)?)?;
    let results = read("benches/peers/RESULTS.md")?;
    let figures = context! {
        steps => counts(&read("host-sim/data/instructions.csv")?),
        functions => counts(&read("host-sim/data/functions.csv")?),
        parts => by("part", &measured["parts"]),
        budget => measured,
        faults => planted()?,
        limits => limits["rows"],
        paper => by("item", &paper["rows"]),
        random_drops => paper["drops"],
        trade => program::trade(&trade),
        drop,
        peers => peers(&results)?,
    };
    let mut environment = templates();
    environment.add_function(
        "worst",
        move |of: &str, measure: &str, precision: &str, what: &str| {
            program::worst(&limits, [of, measure, precision, what]).map_err(refused)
        },
    );
    environment.add_function("claim", move |text: &str| {
        claim(&results, text).map_err(refused)
    });
    let (of_cells, of_rows) = (documents.to_vec(), documents.to_vec());
    environment.add_function("cell", move |table: &str, row: &str, column: &str| {
        let cell = stamped(&of_cells, table).and_then(|(it, block)| it.cell(block, row, column));
        cell.map_err(refused)
    });
    environment.add_function("most", move |table: &str, column: &str| {
        let most = stamped(&of_rows, table).and_then(|(it, block)| it.most(block, column));
        most.map_err(refused)
    });
    Ok(move |template: &str| Ok(environment.render_str(template, &figures)?))
}

/// Lines of a template are lines of the document, those of statements alone left out.
fn templates() -> Environment<'static> {
    let mut environment = Environment::new();
    environment.set_undefined_behavior(UndefinedBehavior::Strict);
    environment.set_keep_trailing_newline(true);
    environment.set_trim_blocks(true);
    environment.set_lstrip_blocks(true);
    environment.add_filter("count", number::count);
    environment.add_filter("digits", number::digits);
    environment.add_filter("fixed", number::fixed);
    environment
}

fn refused(error: anyhow::Error) -> Error {
    Error::new(ErrorKind::InvalidOperation, format!("{error:#}"))
}

fn read(file: &str) -> anyhow::Result<String> {
    files::text(&workspace().join(file))
}

/// Rows of a list by what they have as `name`.
fn by<'a>(name: &str, rows: &'a Value) -> Map<&'a Value> {
    let rows = rows.as_array().into_iter().flatten();
    rows.filter_map(|it| Some((it[name].as_str()?.to_owned(), it)))
        .collect()
}

/// Mean and worst of a table of counts, by what stands before them.
fn counts(text: &str) -> Map<Map<f64>> {
    let row = |line: &str| {
        let (rest, worst) = line.rsplit_once(',')?;
        let (key, mean) = rest.rsplit_once(',')?;
        let (mean, worst) = (mean.parse::<f64>().ok()?, worst.parse::<f64>().ok()?);
        let counts = [("mean", mean), ("worst", worst)].map(|(name, it)| (name.to_owned(), it));
        Some((key.replace(',', " "), counts.into()))
    };
    text.lines().filter_map(row).collect()
}

/// The planted faults: list, whether a test of its own is named, and whether it changes nothing.
fn planted() -> anyhow::Result<Vec<Value>> {
    let faults = faults::faults()?.into_iter();
    let fault = |it: faults::Fault| {
        let equivalent = it.equivalent.is_some();
        json!({ "area": it.area, "other": it.test.is_some() && !equivalent, "equivalent": equivalent })
    };
    Ok(faults.map(fault).collect())
}

/// Rows of the peers' tables by setting, each with its cells by heading.
fn peers(results: &str) -> anyhow::Result<Map<Map<&str>>> {
    let (mut rows, mut heading) = (Map::new(), Vec::new());
    for line in results.lines().filter(|it| it.starts_with("| ")) {
        let cells: Vec<_> = line.trim_matches('|').split('|').map(str::trim).collect();
        if cells[0] == "what" {
            heading = cells;
        } else if let Some(setting) = cells.get(1).copied() {
            let named = heading.iter().map(|it| (*it).to_owned());
            let twice = rows.insert(setting.to_owned(), named.zip(cells).collect());
            ensure!(twice.is_none(), "two rows of peers are called {setting}");
        }
    }
    Ok(rows)
}

/// The factor of the peers' claim that begins so, met or not.
fn claim(results: &str, text: &str) -> anyhow::Result<f64> {
    let start = format!("- {text}: ");
    let claim = results.lines().find_map(|line| line.strip_prefix(&start));
    let claim = claim.context("no claim begins so")?;
    let claim = claim.split_once(", ").map_or(claim, |it| it.1);
    let (factor, _) = claim
        .split_once(" times")
        .context("the claim has no factor")?;
    Ok(factor.parse()?)
}

/// A stamped table, and where it stands.
fn stamped<'a>(
    documents: &'a [Document],
    table: &str,
) -> anyhow::Result<(&'a Document, &'a Block)> {
    let block_of = |it: &'a Document| Some((it, it.blocks.iter().find(|it| it.name == table)?));
    let found = documents.iter().find_map(block_of);
    let (document, block) = found.with_context(|| format!("no table is called {table}"))?;
    let rule = "is generated: take the figure from its source";
    ensure!(block.stamped, "{table} {rule}");
    Ok((document, block))
}

#[cfg(test)]
mod tests {
    use super::*;

    const RESULTS: &str = "\
        | what | setting | time, us |\n|---|---|---|\n\
        | Touchdown | f64 | 0 / 1e-11 |\n\
        \n- With f64: met, 99.8 times (ours).\n\
        - With f16: **not met**, 4.5 times (ours).\n";

    #[test]
    fn results_of_peers_are_found_by_setting_heading_and_claim() {
        assert_eq!(peers(RESULTS).unwrap()["f64"]["time, us"], "0 / 1e-11");
        assert_eq!(claim(RESULTS, "With f64").unwrap(), 99.8);
        assert_eq!(claim(RESULTS, "With f16").unwrap(), 4.5);
        assert!(claim(RESULTS, "With f32").is_err());
    }

    #[test]
    fn figures_take_their_place_and_what_is_not_there_is_an_error() {
        let figures =
            context! { steps => counts("precision,mean,worst\nf32,flight,7272.4,8000\n") };
        let fill = |text: &str| templates().render_str(text, &figures);
        let text = fill("| {{ steps[\"f32 flight\"].mean|count }} |\n").unwrap();
        assert_eq!(text, "| 7 272 |\n");
        assert!(fill("{{ steps[\"f64 flight\"].mean|count }}").is_err());
        assert!(fill("{{ step }}").is_err());
        assert!(fill("{{ steps|count }}").is_err());
    }
}
