//! How often a run's estimated errors cover its true ones: `cargo run --release -p touchdown-tests --example accuracy`.

use clap::Parser;
use touchdown_tests::accuracy_runs::{self, Kind};
use touchdown_tests::record::record;

const COMMAND: &str = "cargo run --release -p touchdown-tests --example accuracy --";

/// Drops random machines and holds the errors that each run tells of itself against the reference
#[derive(Parser)]
struct Arguments {
    /// Drops of each kind
    #[arg(long, default_value_t = 1000)]
    drops: u64,
    /// First seed
    #[arg(long, default_value_t = 1)]
    first_seed: u64,
    /// As JSON
    #[arg(long)]
    json: bool,
    /// Write the table into docs/know/accuracy.md
    #[arg(long, conflicts_with = "json")]
    record: bool,
}

fn main() {
    let Arguments {
        drops,
        first_seed,
        json,
        record: write,
    } = Arguments::parse();
    let kinds = accuracy_runs::run(drops, first_seed);
    if json {
        println!("{}", serde_json::to_string_pretty(&kinds).expect("a value"));
        return;
    }
    let table = table(&kinds);
    print!("{table}");
    for failure in kinds.iter().flat_map(|it| &it.failures) {
        eprintln!("{failure}");
    }
    if write {
        let command = format!("{COMMAND} --drops {drops} --first-seed {first_seed}");
        record("docs/know/accuracy.md", "accuracy-runs", &command, &table)
            .unwrap_or_else(|why| panic!("{why}"));
    }
}

fn table(kinds: &[Kind]) -> String {
    let mut table =
        "| drops | | impacts determined | errors told | true error greater | rate below, 95 % | told over true, median | 90 % |\n|---|---:|---:|---:|---:|---:|---:|---:|\n".to_owned();
    for it in kinds {
        table += &format!(
            "| {} | {} | {} | {:.1} % | {} | {:.2e} | {:.1} | {:.0} |\n",
            it.name,
            it.drops,
            it.impacts,
            100.0 * it.told as f64 / it.impacts.max(1) as f64,
            it.beyond,
            it.rate_below,
            it.over[0],
            it.over[1],
        );
    }
    table
}
