//! A part without effect is left out, one with effect stays, and a choice holds in drops it was not made on: a slice of the
//! campaign, on seeds of its own.

use touchdown_tests::choice_runs;

const FIRST_SEED: u64 = 900_000;

#[test]
fn choices_hold_and_have_the_parts_that_matter() {
    let mut families = choice_runs::run("planted", 6, FIRST_SEED);
    families.extend(choice_runs::run("answers: plane", 3, FIRST_SEED));
    assert_eq!(families.len(), 4);
    for family in families {
        println!("{family:?}");
        assert_eq!((family.runs, family.failed), (3, 0), "{family:?}");
    }
}
