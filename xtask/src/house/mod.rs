//! The house: size, structure and names of the crates, held against `house.toml`.

mod cycles;
mod layers;
mod rebuild;
mod source;

use std::collections::BTreeMap;
use std::path::Path;

use anyhow::{Context, ensure};
use serde::Deserialize;

use self::cycles::cycles;
use self::layers::{beyond, members};
use self::source::Source;
use crate::{files, workspace};

/// How many of the longest functions and of the names that occur twice are shown.
const SHOWN: usize = 12;

/// What `house.toml` allows.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Budget {
    /// Lines of all crates together, without those that were added on purpose.
    asked_lines: usize,
    /// Those, by what they are for.
    added_lines: BTreeMap<String, usize>,
    /// Lines of a function that is not in the list of longer ones.
    function_lines: usize,
    /// How many functions may be longer than that.
    longer_functions: usize,
    /// Type names that more than one file defines.
    shared_type_names: usize,
    /// Processor time to build the program again after a line of the detector has changed, s.
    rebuild_seconds: usize,
    /// Crates by their folder.
    crates: BTreeMap<String, Crate>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Crate {
    /// Lines without tests.
    #[serde(default)]
    lines: usize,
    /// Circles of imports between its files.
    #[serde(default)]
    cycles: usize,
    /// Crates that it may use.
    #[serde(default)]
    uses: Vec<String>,
}

/// Prints the figures; an error names each that is above its limit. `rebuild` also builds.
pub fn run(rebuild: bool) -> anyhow::Result<()> {
    let budget: Budget = files::toml(&workspace().join("house.toml"))?;
    let mut broken = Vec::new();
    let mut strays = Vec::new();
    let mut all = Vec::new();
    let mut limit = |what: &str, is: usize, most: usize| {
        let mark = if is > most { "ABOVE" } else { "" };
        println!("{what:<34}{is:>8}{most:>10}  {mark}");
        if is > most {
            broken.push(format!("{what}: {is}, the limit is {most}"));
        }
    };
    println!("{:<34}{:>8}{:>10}", "", "now", "limit");
    for member in members()? {
        let folder = &member.folder;
        let its = budget.crates.get(folder);
        let its = its.with_context(|| format!("{folder} is not in house.toml"))?;
        let beyond = beyond(&member, &its.uses).into_iter();
        strays.extend(beyond.map(|it| format!("{folder} must not use {it}")));
        let folder_of_sources = workspace().join(folder).join("src");
        if !folder_of_sources.is_dir() {
            // The tests: no lines of the product, but the rule of the layers.
            continue;
        }
        let sources = Source::of_crate(&folder_of_sources)?;
        limit(&format!("lines of {folder}"), lines(&sources), its.lines);
        let circles = cycles(&sources);
        let what = format!("import cycles in {folder}");
        limit(&what, circles.len(), its.cycles);
        for circle in circles {
            println!("    {}", circle.join(", "));
        }
        all.extend(sources);
    }
    let most = budget.asked_lines + budget.added_lines.values().sum::<usize>();
    limit("lines of the product", lines(&all), most);
    let functions = longest(&all);
    let longer = functions.partition_point(|it| it.0 > budget.function_lines);
    let what = format!("functions above {} lines", budget.function_lines);
    limit(&what, longer, budget.longer_functions);
    let names = shared_names(&all);
    let what = "type names in several files";
    limit(what, names.len(), budget.shared_type_names);
    if rebuild {
        let seconds = rebuild::time()?.as_secs_f64().ceil() as usize;
        let what = "rebuild, s of processor time";
        limit(what, seconds, budget.rebuild_seconds);
    }
    println!("\nlongest functions");
    for (lines, name, path) in functions.iter().take(SHOWN) {
        let path = path.strip_prefix(workspace()).unwrap_or(path).display();
        println!("{lines:>6}  {name}  {path}");
    }
    println!("\ntype names in most files");
    for (name, files) in names.iter().take(SHOWN) {
        println!("{files:>6}  {name}");
    }
    broken.extend(strays);
    let broken = broken.join("\n");
    ensure!(broken.is_empty(), "against house.toml:\n{broken}");
    Ok(())
}

fn lines(sources: &[Source]) -> usize {
    sources.iter().map(|it| it.lines).sum()
}

/// All functions, the longest first.
fn longest(sources: &[Source]) -> Vec<(usize, &str, &Path)> {
    let mut all = vec![];
    for source in sources {
        let functions = source.functions.iter();
        all.extend(functions.map(|(name, lines)| (*lines, name.as_str(), source.path.as_path())));
    }
    all.sort_by(|a, b| b.cmp(a));
    all
}

/// Type names that more than one file defines, and how many do; most files first.
fn shared_names(sources: &[Source]) -> Vec<(&str, usize)> {
    let mut files = BTreeMap::<&str, usize>::new();
    for name in sources.iter().flat_map(|source| &source.types) {
        *files.entry(name).or_default() += 1;
    }
    let mut shared: Vec<_> = files.into_iter().filter(|(_, it)| *it > 1).collect();
    shared.sort_by_key(|(_, files)| std::cmp::Reverse(*files));
    shared
}
