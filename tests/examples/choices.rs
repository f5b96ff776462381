//! What `fidelity = "auto"` chooses for random machines, and whether it holds:
//! `cargo run --release -p touchdown-tests --example choices -- --runs 200`.

use touchdown_tests::choice_runs;
use touchdown_tests::family::{Campaign, Place};

fn main() {
    let campaign = Campaign::of_command_line(
        "Has models chosen for random machines, and counts the wrong choices: --runs answers in the plane, half of it of each other family",
    );
    let asked = &campaign.asked;
    let families = choice_runs::run(&asked.only, asked.runs, asked.first_seed);
    let place = Place {
        document: "docs/know/accuracy.md",
        table: "accuracy-choices",
        example: "choices",
        arguments: "",
    };
    campaign.conclude(&families, place);
}
