//! The commissioning check over many machines: `cargo run --release -p touchdown-tests --example calibrate -- --runs 1000`.

use clap::Parser;
use touchdown_base::wilson;
use touchdown_tests::led_rounds::{self, Row, Summary};
use touchdown_tests::record::record;

const COMMAND: &str = "cargo run --release -p touchdown-tests --example calibrate --";

/// Finds zero, gain and skew in simulated recordings, and counts how often they are right
#[derive(Parser)]
struct Arguments {
    /// Recordings
    #[arg(long, default_value_t = 1_000)]
    runs: u64,
    /// First seed
    #[arg(long, default_value_t = 1)]
    first_seed: u64,
    /// As JSON
    #[arg(long)]
    json: bool,
    /// Write the table into docs/use/calibrate.md
    #[arg(long, conflicts_with = "json")]
    record: bool,
}

fn main() {
    let arguments = Arguments::parse();
    let summary = led_rounds::run(arguments.runs, arguments.first_seed);
    if arguments.json {
        let text = serde_json::to_string_pretty(&summary).expect("a value");
        println!("{text}");
    } else {
        let table = table(&summary);
        print!("{table}");
        for it in summary.refused.iter().take(10) {
            eprintln!("refused: {it}");
        }
        if arguments.record {
            let Arguments {
                runs, first_seed, ..
            } = arguments;
            let command = format!("{COMMAND} --runs {runs} --first-seed {first_seed}");
            record(
                "docs/use/calibrate.md",
                "calibrate-recordings",
                &command,
                &table,
            )
            .unwrap_or_else(|why| panic!("{why}"));
        }
    }
    let holds = |it: &Row| it.within == 1.0 && (0.93..=0.97).contains(&it.covered);
    if !summary.refused.is_empty() || !summary.rows.iter().all(holds) {
        std::process::exit(1);
    }
}

fn table(summary: &Summary) -> String {
    let mut table =
        "| quantity | found | within | within it, % | largest | in the 95 % error, % |\n"
            .to_owned();
    table += "|---|---:|---:|---:|---:|---:|\n";
    for it in &summary.rows {
        let Row {
            name,
            count,
            tolerance,
            within,
            largest,
            covered,
        } = it;
        let rate = |share: &f64| {
            let (low, high) = wilson::of_share(*share, *count as f64);
            let [share, low, high] = [*share, low, high].map(|it| 100.0 * it);
            format!("{share:.1} ({low:.1} to {high:.1})")
        };
        let (within, covered) = (rate(within), rate(covered));
        table += &format!(
            "| {name} | {count} | {tolerance:.0e} | {within} | {largest:.1e} | {covered} |\n"
        );
    }
    table + &format!("| refused | {} | | | | |\n", summary.refused.len())
}
