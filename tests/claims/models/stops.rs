//! A ring on its way to its stop, and on it: what the model makes of it is the reference's, in any number format.

use touchdown_base::history::History;
use touchdown_lab::limits::machine;
use touchdown_run::model;
use touchdown_scene::{BUILT_IN, Fidelity, Precision, Scene};
use touchdown_truth::Truth;

fn drop(mass: f64, precision: Precision) -> Scene {
    let mount = format!(
        "[support]\nmass_kg = {mass:?}\nstiffness_n_m = 1e6\ndamping_n_s_m = 100.0\ntravel_mm = 0.01\n"
    );
    let text = BUILT_IN[0].text.to_owned() + &mount;
    let mut scene = Scene::parse("rig", &text).expect("valid");
    scene.model.rung = Fidelity::Support;
    scene.model.step = 1e-5;
    scene.model.precision = precision;
    scene.run.duration = 0.03;
    scene
}

/// Else the rotor strikes ring and stop in turn, as often as the numbers can tell.
#[test]
fn the_number_of_impacts_at_a_stop_is_the_same_in_any_number_format() {
    for mass in [0.01, 0.03, 0.1] {
        let ours = |precision| {
            let run = model::run(&drop(mass, precision)).expect("valid");
            run.histories.whole.impacts.len()
        };
        let scene = drop(mass, Precision::F64);
        let mut truth = Truth::new(&scene);
        truth.advance(0.03);
        let truth = truth.finish().whole.impacts.len();
        let all = [ours(Precision::F64), ours(Precision::F32), truth];
        println!("{mass} kg: {all:?} impacts");
        assert!(all[0] == all[1] && all[0] == all[2], "{mass}: {all:?}");
    }
}

/// Let go in the last moment before another wall is met, it would be struck at once.
#[test]
fn a_ring_that_holds_the_rotor_does_not_let_it_go_as_another_wall_is_met() {
    let mut left = Vec::new();
    // A ring at its stop, and the other end at its ring.
    for seed in [21, 127, 241, 357, 84, 116, 193, 345] {
        let scene = Scene::parse("machine", &machine(seed)).expect("valid");
        let run = model::run(&scene).expect("valid");
        let struck_as_left = |ring: &History| {
            let times = ring.impacts.iter().map(|it| it.state.time);
            let mut pairs = times.flat_map(|at| ring.lift_offs.iter().map(move |left| at - left));
            pairs.any(|apart| apart.abs() < 1e-9)
        };
        if run.histories.rings.iter().any(struck_as_left) {
            left.push(seed);
        }
    }
    assert!(left.is_empty(), "{left:?}");
}
