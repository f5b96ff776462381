//! Falls and what is none, over many machines: `cargo run --release -p touchdown-tests --example falls -- --runs 1000`.

use clap::Parser;
use touchdown_tests::fall_runs::{self, Falls, Noise};
use touchdown_tests::family::{Campaign, Family, Place};

/// Runs the whole controller over machines that are disturbed, and counts what it confirms and what it misses
#[derive(Parser)]
struct Arguments {
    #[command(flatten)]
    campaign: Campaign,
    /// With noise of 1 to 4 um in place of 0.3 to 1
    #[arg(long)]
    loud: bool,
}

fn main() {
    let Arguments { campaign, loud } = Arguments::parse();
    let asked = &campaign.asked;
    let (noise, table_name, arguments) = if loud {
        (Noise::Loud, "detector-falls-loud", " --loud")
    } else {
        (Noise::Usual, "detector-falls", "")
    };
    let families = fall_runs::run(&asked.only, asked.runs, asked.first_seed, noise);
    let failures: Vec<_> = families
        .iter()
        .flat_map(|it| it.family.failures.clone())
        .collect();
    let place = Place {
        document: "docs/know/detector.md",
        table: table_name,
        example: "falls",
        arguments,
    };
    campaign.tell(&families, &table(&families), &failures, place);
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
