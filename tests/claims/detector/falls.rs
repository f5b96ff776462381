//! What disturbs a floating rotor is confirmed as no fall, and a fall out of it is told in time: a slice of the campaign, on
//! seeds of its own.

use touchdown_tests::fall_runs;

const RUNS: u64 = 20;
const FIRST_SEED: u64 = 900_000;

#[test]
fn disturbances_are_no_falls_and_falls_out_of_them_are_found() {
    let families = fall_runs::run("", RUNS, FIRST_SEED);
    assert_eq!(families.len(), 21);
    for falls in families {
        println!("{falls:?}");
        let family = falls.family;
        assert!(family.runs >= 10, "{}: {}", family.name, family.runs);
        assert_eq!(family.failed, 0, "{}: {:?}", family.name, family.failures);
    }
}
