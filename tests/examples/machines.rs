//! What the monitor tells of drops of every machine of the scene list:
//! `cargo run --release -p touchdown-tests --example machines -- --runs 100`.

use clap::Parser;
use touchdown_tests::family::{Campaign, Place};
use touchdown_tests::machine_runs::{self, Machine};

/// Drops each machine of the scene list, varied within what its estimates allow, and counts what the monitor finds and invents
#[derive(Parser)]
struct Arguments {
    #[command(flatten)]
    campaign: Campaign,
    /// Conversions of a sample: 1, 2, 4, 8 or 16
    #[arg(long, default_value_t = 1, conflicts_with = "record")]
    conversions: u16,
}

fn main() {
    let Arguments {
        campaign,
        conversions,
    } = Arguments::parse();
    let asked = &campaign.asked;
    let machines = machine_runs::run(&asked.only, asked.runs, asked.first_seed, conversions);
    let failed = machines.iter().filter(|it| !it.failures.is_empty());
    let failures: Vec<_> = failed
        .map(|it| format!("{}: drops {:?}", it.name, it.failures))
        .collect();
    let place = Place {
        document: "docs/know/detector.md",
        table: "detector-machines",
        example: "machines",
        arguments: "",
    };
    campaign.tell(&machines, &table(&machines), &failures, place);
}

fn table(machines: &[Machine]) -> String {
    let mut table = "| machine | drops | fall confirmed | touches found | drops with invented impacts | rate below, 95 % | false of whirls | whirls of a turn told | false of lift-offs | drops with a sensor fault | drops ended early |\n|---|---:|---:|---:|---:|---:|---:|---:|---:|---:|---:|\n".to_owned();
    for it in machines {
        let [clear, found] = it.touches;
        let [whirls, false_whirls] = it.whirls;
        let [turning, told] = it.turning;
        let [lift_offs, false_lift_offs] = it.lift_offs;
        table += &format!(
            "| {} | {} | {} | {found} of {clear} | {} | {:.2} | {false_whirls} of {whirls} | {told} of {turning} | {false_lift_offs} of {lift_offs} | {} | {} |\n",
            it.name, it.drops, it.confirmed, it.invented, it.rate_below, it.faults, it.cut
        );
    }
    table
}
