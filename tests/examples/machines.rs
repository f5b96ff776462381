//! What the monitor tells of drops of every machine of the scene list:
//! `cargo run --release -p touchdown-tests --example machines -- --runs 100`.

use clap::Parser;
use touchdown_tests::family::Asked;
use touchdown_tests::machine_runs::{self, Machine};
use touchdown_tests::record::record;

const COMMAND: &str = "cargo run --release -p touchdown-tests --example machines --";

/// Drops each machine of the scene list, varied within what its estimates allow, and counts what the monitor finds and invents
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
    let machines = machine_runs::run(&only, runs, first_seed);
    if arguments.json {
        println!(
            "{}",
            serde_json::to_string_pretty(&machines).expect("a value")
        );
        return;
    }
    let table = table(&machines);
    print!("{table}");
    for it in machines.iter().filter(|it| !it.failures.is_empty()) {
        eprintln!("{}: drops {:?}", it.name, it.failures);
    }
    if arguments.record {
        let command = format!("{COMMAND} --runs {runs} --first-seed {first_seed}");
        record(
            "docs/know/detector.md",
            "detector-machines",
            &command,
            &table,
        )
        .unwrap_or_else(|why| panic!("{why}"));
    }
}

fn table(machines: &[Machine]) -> String {
    let mut table = "| machine | drops | fall confirmed | touches found | drops with invented impacts | rate below, 95 % | false of whirls | drops with a sensor fault |\n|---|---:|---:|---:|---:|---:|---:|---:|\n".to_owned();
    for it in machines {
        let [clear, found] = it.touches;
        let [whirls, false_whirls] = it.whirls;
        table += &format!(
            "| {} | {} | {} | {found} of {clear} | {} | {:.2} | {false_whirls} of {whirls} | {} |\n",
            it.name, it.drops, it.confirmed, it.invented, it.rate_below, it.faults
        );
    }
    table
}
