//! Falls and what is none, over many machines: `cargo run --release -p touchdown-tests --example falls -- --runs 1000`.

use clap::Parser;
use touchdown_tests::fall_runs::{self, Falls};
use touchdown_tests::family::{Asked, Family};
use touchdown_tests::record::record;

const COMMAND: &str = "cargo run --release -p touchdown-tests --example falls --";

/// Runs the whole controller over machines that are disturbed, and counts what it confirms and what it misses
#[derive(Parser)]
struct Arguments {
    #[command(flatten)]
    asked: Asked,
    /// As JSON
    #[arg(long)]
    json: bool,
    /// Write the table into docs/know/detector.md
    #[arg(long, conflicts_with_all = ["only", "json"])]
    record: bool,
}

fn main() {
    let arguments = Arguments::parse();
    let Asked {
        only,
        runs,
        first_seed,
    } = arguments.asked;
    let families = fall_runs::run(&only, runs, first_seed);
    if arguments.json {
        println!(
            "{}",
            serde_json::to_string_pretty(&families).expect("a value")
        );
    } else {
        let table = table(&families);
        print!("{table}");
        for failure in families.iter().flat_map(|it| &it.family.failures) {
            eprintln!("{failure}");
        }
        if arguments.record {
            let command = format!("{COMMAND} --runs {runs} --first-seed {first_seed}");
            record("docs/know/detector.md", "detector-falls", &command, &table)
                .unwrap_or_else(|why| panic!("{why}"));
        }
    }
    if families.iter().any(|it| it.family.failed > 0) {
        std::process::exit(1);
    }
}

fn table(families: &[Falls]) -> String {
    let mut table =
        "| family | runs | failed | rate below, 95 % | confirmed before contact |\n|---|---:|---:|---:|---:|\n".to_owned();
    for it in families {
        let early = it
            .confirmed_before_contact
            .map_or("-".into(), |it| it.to_string());
        let Family {
            name,
            runs,
            failed,
            rate_below,
            ..
        } = &it.family;
        table += &format!("| {name} | {runs} | {failed} | {rate_below:.2e} | {early} |\n");
    }
    table
}
