//! The guard over many machines that are told wrong: `cargo run --release -p touchdown-tests --example guard -- --runs 10000`.

use clap::Parser;
use touchdown_tests::guard_runs;

/// Runs the whole controller over machines that are told wrong, and counts where its guard fails
#[derive(Parser)]
struct Arguments {
    /// Families whose name contains this
    #[arg(long, default_value = "")]
    only: String,
    /// Power-on cycles; a tenth of it in each other family
    #[arg(long, default_value_t = 1_000)]
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
    let families = guard_runs::run(&arguments.only, arguments.runs, arguments.first_seed);
    if arguments.json {
        println!(
            "{}",
            serde_json::to_string_pretty(&families).expect("a value")
        );
    } else {
        println!("| family | runs | failed | rate below, 95 % |\n|---|---:|---:|---:|");
        for it in &families {
            println!(
                "| {} | {} | {} | {:.2e} |",
                it.name, it.runs, it.failed, it.rate_below
            );
            if it.undecided > 0 {
                println!("| undecided: {} | {} | | |", it.undecided_why, it.undecided);
            }
        }
        for failure in families.iter().flat_map(|it| &it.failures) {
            eprintln!("{failure}");
        }
    }
    if families.iter().any(|it| it.failed > 0) {
        std::process::exit(1);
    }
}
