//! Whirl is foretold: hit rate, false rate, Brier score and lead over random drops, judged by the reference.

use touchdown_sim::forecast_score::{Plan, campaign, score};

#[test]
#[ignore = "thousands of drops: the figures of docs/forecast.md"]
fn figures() {
    let drops = std::env::var("DROPS").map_or(2000, |it| it.parse().expect("a number"));
    for misled in [0.0, 0.3] {
        let plan = Plan {
            drops,
            seed: 1_000_000,
            misled,
        };
        println!("misled by {misled}: {:#?}", score(&campaign(&plan).expect("valid scenes")));
    }
}
