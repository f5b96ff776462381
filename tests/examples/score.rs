//! The rows of `touchdown score`, by what they judge: `cargo run --release -p touchdown-tests --example score -- --runs 100`.

use std::collections::BTreeMap;

use serde_json::Value;
use touchdown_core::detect::Tuning;
use touchdown_lab::score::{self, GROUPS, Plan, Row, Score};
use touchdown_run::target::Target;
use touchdown_tests::family::{Campaign, Place};

/// Levitation of each case for each run that is asked for, s.
const SECONDS: f64 = 60.0;

fn main() {
    let campaign = Campaign::of_command_line(
        "Measures the detector as `touchdown score` does; a run is a drop of each case and a minute of levitation",
    );
    let asked = &campaign.asked;
    let names = GROUPS.iter().map(|it| it.name);
    let plan = Plan {
        groups: names.filter(|it| it.contains(&asked.only)).collect(),
        seeds: asked.runs,
        first_seed: asked.first_seed,
        seconds: SECONDS * asked.runs as f64,
        tuning: Tuning::default(),
    };
    let score = score::run(&plan, &Target::Host).unwrap_or_else(|why| panic!("{why:?}"));
    let json: Value = score::json(&score)
        .and_then(|it| serde_json::from_str(&it))
        .expect("a value");
    let failures: Vec<_> = (score.rows().filter(|it| it.fails()))
        .map(|it| format!("{}, {}: {}", it.case, it.quantity, against_target(it)))
        .collect();
    let place = Place {
        document: "docs/know/validation.md",
        table: "validation-score",
        example: "score",
        arguments: "",
    };
    campaign.tell(&json, &table(&score), &failures, place);
    if !failures.is_empty() {
        std::process::exit(1);
    }
}

fn table(score: &Score) -> String {
    let mut table = "| group | judged | rows | hold | undecided | fail | furthest from its target |\n|---|---|---:|---:|---:|---:|---|\n".to_owned();
    for (group, found) in &score.groups {
        let mut by_quantity = BTreeMap::<_, Vec<&Row>>::new();
        for row in &found.rows {
            by_quantity.entry(row.quantity).or_default().push(row);
        }
        for (quantity, rows) in by_quantity {
            let count = |is: fn(&Row) -> bool| rows.iter().filter(|it| is(it)).count();
            let worst = rows.iter().max_by(|a, b| beyond(a).total_cmp(&beyond(b)));
            let worst = worst.map_or(String::new(), |it| {
                format!("{}: {}", it.case, against_target(it))
            });
            table += &format!(
                "| {} | {quantity} | {} | {} | {} | {} | {worst} |\n",
                group.name,
                rows.len(),
                count(|it| it.holds),
                count(|it| it.undecided),
                count(Row::fails)
            );
        }
    }
    table
}

/// By how much a row misses its target; what could not be measured misses most.
fn beyond(row: &Row) -> f64 {
    let missed = row.measured().map_or(f64::INFINITY, |it| it - row.target);
    if row.at_least { -missed } else { missed }
}

fn against_target(row: &Row) -> String {
    let measured = row
        .measured()
        .map_or("nothing".into(), |it| format!("{it:.4}"));
    format!("{measured} {} {}", row.sense(), row.target)
}
