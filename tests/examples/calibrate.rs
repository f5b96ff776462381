//! The commissioning check over many machines: `cargo run --release -p touchdown-tests --example calibrate -- --runs 1000`.

use clap::Parser;
use touchdown_tests::led_rounds;

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
}

fn main() {
    let arguments = Arguments::parse();
    let summary = led_rounds::run(arguments.runs, arguments.first_seed);
    if arguments.json {
        let text = serde_json::to_string_pretty(&summary).expect("a value");
        println!("{text}");
    } else {
        println!("| quantity | found | within | of them, % | largest | in the 95 % error, % |");
        println!("|---|---:|---:|---:|---:|---:|");
        for it in &summary.rows {
            let within = 100.0 * it.within;
            let covered = 100.0 * it.covered;
            println!(
                "| {} | {} | {:.0e} | {within:.1} | {:.1e} | {covered:.1} |",
                it.name, it.count, it.tolerance, it.largest
            );
        }
        println!("refused: {}", summary.refused.len());
        for it in summary.refused.iter().take(10) {
            eprintln!("{it}");
        }
    }
    let holds = |it: &led_rounds::Row| it.within == 1.0 && (0.93..=0.97).contains(&it.covered);
    if !summary.refused.is_empty() || !summary.rows.iter().all(holds) {
        std::process::exit(1);
    }
}
