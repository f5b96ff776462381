//! A ring on its way to its stop.

use touchdown_lab::limits::machine;
use touchdown_run::model;
use touchdown_scene::Scene;

/// It takes the rotor with it to rest. Let go, the rotor would strike it at once.
#[test]
fn a_ring_that_holds_the_rotor_does_not_let_it_go_at_its_stop() {
    let mut left = Vec::new();
    for seed in [21, 325, 357, 391] {
        let scene = Scene::parse("machine", &machine(seed)).expect("valid");
        let ours = model::run(&scene).expect("valid").histories.whole;
        let struck = |time: &f64| {
            let mut all = ours.impacts.iter();
            all.any(|it| (it.state.time - time).abs() < 1e-9)
        };
        if ours.lift_offs.iter().any(struck) {
            left.push(seed);
        }
    }
    assert!(left.is_empty(), "{left:?}");
}
