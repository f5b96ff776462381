//! The guard over many machines that are told wrong: `cargo run --release -p touchdown-tests --example guard -- --runs 10000`.

use touchdown_tests::family::{Campaign, Place};
use touchdown_tests::guard_runs;

fn main() {
    let campaign = Campaign::of_command_line(
        "Runs the whole controller over machines that are told wrong, and counts where its guard fails: --runs power-on cycles, a tenth of it of each other family",
    );
    let asked = &campaign.asked;
    let families = guard_runs::run(&asked.only, asked.runs, asked.first_seed);
    let place = Place {
        document: "docs/know/guard.md",
        table: "guard-runs",
        example: "guard",
        arguments: "",
    };
    campaign.conclude(&families, place);
}
