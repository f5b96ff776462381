//! The guard over many machines that are told wrong: `cargo run --release -p touchdown-tests --example guard -- --runs 10000`.

use clap::Parser;
use touchdown_tests::family::Family;
use touchdown_tests::guard_runs;
use touchdown_tests::record::record;

const COMMAND: &str = "cargo run --release -p touchdown-tests --example guard --";

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
    /// Write the table into docs/know/guard.md
    #[arg(long, conflicts_with_all = ["only", "json"])]
    record: bool,
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
        let table = table(&families);
        print!("{table}");
        for failure in families.iter().flat_map(|it| &it.failures) {
            eprintln!("{failure}");
        }
        if arguments.record {
            let Arguments {
                runs, first_seed, ..
            } = arguments;
            let command = format!("{COMMAND} --runs {runs} --first-seed {first_seed}");
            record("docs/know/guard.md", "guard-runs", &command, &table)
                .unwrap_or_else(|why| panic!("{why}"));
        }
    }
    if families.iter().any(|it| it.failed > 0) {
        std::process::exit(1);
    }
}

fn table(families: &[Family]) -> String {
    let mut table =
        "| family | runs | failed | rate below, 95 % |\n|---|---:|---:|---:|\n".to_owned();
    for it in families {
        let Family {
            name,
            runs,
            failed,
            rate_below,
            ..
        } = it;
        table += &format!("| {name} | {runs} | {failed} | {rate_below:.2e} |\n");
        if it.undecided > 0 {
            table += &format!(
                "| undecided: {} | {} | | |\n",
                it.undecided_why, it.undecided
            );
        }
    }
    table
}
