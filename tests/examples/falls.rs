//! Falls and what is none, over many machines: `cargo run --release -p touchdown-tests --example falls -- --runs 1000`.

use clap::Parser;
use touchdown_tests::fall_runs::{self, Falls};

/// Runs the whole controller over machines that are disturbed, and counts what it confirms and what it misses
#[derive(Parser)]
struct Arguments {
    /// Families whose name contains this
    #[arg(long, default_value = "")]
    only: String,
    /// Runs of each family
    #[arg(long, default_value_t = 100)]
    runs: u64,
    /// First seed
    #[arg(long, default_value_t = 1)]
    first_seed: u64,
    /// As JSON
    #[arg(long)]
    json: bool,
}

fn main() {
    let arguments = Arguments::parse();
    let families = fall_runs::run(&arguments.only, arguments.runs, arguments.first_seed);
    if arguments.json {
        println!(
            "{}",
            serde_json::to_string_pretty(&families).expect("a value")
        );
    } else {
        println!(
            "| family | runs | failed | rate below, 95 % | confirmed before contact |\n|---|---:|---:|---:|---:|"
        );
        for Falls {
            family: it,
            confirmed_before_contact,
        } in &families
        {
            let early = confirmed_before_contact.map_or("-".into(), |it| it.to_string());
            println!(
                "| {} | {} | {} | {:.2e} | {early} |",
                it.name, it.runs, it.failed, it.rate_below
            );
        }
        for failure in families.iter().flat_map(|it| &it.family.failures) {
            eprintln!("{failure}");
        }
    }
    if families.iter().any(|it| it.family.failed > 0) {
        std::process::exit(1);
    }
}
