//! The whole controller on machines that are told wrong: a slice of the campaign, on seeds of its own.

use touchdown_tests::guard_runs;

const CYCLES: u64 = 100;
const FIRST_SEED: u64 = 900_000;

#[test]
fn the_guard_holds_on_machines_that_are_told_wrong() {
    let families = guard_runs::run("", CYCLES, FIRST_SEED);
    assert_eq!(families.len(), 8);
    for family in families {
        println!("{family:?}");
        assert!(family.runs > 0, "{}: nothing to judge", family.name);
        assert_eq!(family.failures.first(), None, "{}", family.name);
    }
}
