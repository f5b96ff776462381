//! A model that would take too long.

use touchdown_lab::limits::machine;
use touchdown_run::model;
use touchdown_scene::Scene;

#[test]
fn a_model_that_takes_too_long_is_given_up_with_what_it_has() {
    let mut scene = Scene::parse("machine", &machine(37)).expect("valid");
    scene.run.duration = 0.05;
    assert_eq!(model::run(&scene).expect("valid").given_up, None);
    scene.run.duration = 1.0;
    let run = model::run(&scene).expect("valid");
    let at = run.given_up.expect("walls jam");
    let whole = &run.histories.whole;
    println!("given up at {at} s, {} impacts", whole.impacts.len());
    assert!(at > 0.05 && at < 1.0 && whole.end.time == at);
    assert!(whole.impacts.len() > 5);
    let ledger = run.ledger.expect("kept");
    assert!(ledger.imbalance_j().abs() < 1e-9 * ledger.start_j.abs());
}
