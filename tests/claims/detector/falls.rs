//! What disturbs a floating rotor is confirmed as no fall, and a fall out of it is told in time: a slice of the campaign, on
//! seeds of its own.

use touchdown_tests::fall_runs::{self, Noise};

const RUNS: u64 = 12;
/// One lift in some 25 was told to fall by a detector that learnt from the rotor at rest.
const LIFTS: u64 = 100;
const FIRST_SEED: u64 = 900_000;

#[test]
fn disturbances_are_no_falls_and_falls_out_of_them_are_found() {
    let of = |noise| fall_runs::run("", RUNS, FIRST_SEED, noise);
    let families = [of(Noise::Usual), of(Noise::Loud)].concat();
    assert_eq!(families.len(), 42);
    for falls in families {
        println!("{falls:?}");
        let family = falls.family;
        assert!(family.runs >= 8, "{}: {}", family.name, family.runs);
        assert_eq!(family.failed, 0, "{}: {:?}", family.name, family.failures);
    }
}

#[test]
fn a_lift_from_a_wall_told_wrong_is_no_fall() {
    let families = fall_runs::run("lifts", LIFTS, FIRST_SEED, Noise::Loud);
    let [falls] = families.as_slice() else {
        panic!("{families:?}");
    };
    assert_eq!(falls.family.runs as u64, LIFTS);
    assert_eq!(falls.family.failed, 0, "{:?}", falls.family.failures);
}
