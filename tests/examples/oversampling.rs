//! What it costs that a sample is the sum of some conversions:
//! `cargo run --release -p touchdown-tests --example oversampling -- --runs 300`.

use touchdown_tests::family::{Campaign, Place};
use touchdown_tests::oversampling_runs::{self, Row};

fn main() {
    let campaign = Campaign::of_command_line(
        "Drops the rig, and shows the monitor sums of 1, 2 and 4 conversions of the same sensors",
    );
    let asked = &campaign.asked;
    let rows = oversampling_runs::run(&asked.only, asked.runs, asked.first_seed);
    let place = Place {
        document: "docs/build/timing.md",
        table: "timing-oversampling",
        example: "oversampling",
        arguments: "",
    };
    campaign.tell(&rows, &table(&rows), &[], place);
}

fn table(rows: &[Row]) -> String {
    let mut table = "| conversions of a sample | drops | fall declared, median, ms | confirmed before the first impact | impacts of 20 mm/s found | declared after, median, 90 %, us | onset off, median, 90 %, us | contact declared, median, ms | contradicted events |\n|---:|---:|---:|---:|---:|---:|---:|---:|---:|\n".to_owned();
    for it in rows {
        let ([all, found], [latency, late], [onset, off]) =
            (it.impacts, it.latency_us, it.onset_us);
        table += &format!(
            "| {} | {} | {:.2} | {} | {found} of {all} | {latency:.0}, {late:.0} | {onset:.0}, {off:.0} | {:.2} | {} |\n",
            it.conversions, it.drops, it.fall_ms, it.confirmed, it.contact_ms, it.contradicted
        );
    }
    table
}
