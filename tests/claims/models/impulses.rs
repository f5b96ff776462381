//! Impulses of impacts, and the force between them, where several contacts act at once.

use touchdown_base::history::Impact;
use touchdown_run::model;
use touchdown_scene::Scene;
use touchdown_tests::minimal_scene::SCENE;

const TWO_ENDS: &str = "[two_plane]\nrotor_length_mm = 326.0\n";
const SUPPORT: &str =
    "[support]\nmass_kg = 0.4\nstiffness_n_m = 2e6\ndamping_n_s_m = 300.0\n";

fn scene(duration: f64, tables: &str) -> Scene {
    let text = SCENE.replace("duration_s = 0.01", &format!("duration_s = {duration:?}"));
    Scene::parse("impulses.toml", &(text + tables)).expect("a valid scene")
}

/// Those of the model and those of the reference, while both tell the same speed to 1 %.
fn alike(scene: &Scene) -> Vec<(Impact, Impact)> {
    let model = model::run(scene).expect("a valid scene").histories.whole;
    let truth = touchdown_truth::simulate(scene);
    let pairs = model.impacts.into_iter().zip(truth.impacts);
    let same = |(a, b): &(Impact, Impact)| (a.normal_speed / b.normal_speed - 1.0).abs() < 0.01;
    pairs.take_while(same).collect()
}

#[test]
fn impulses_of_impacts_are_the_references() {
    let level = "[[ring]]\nz_mm = -120.0\n[[ring]]\nz_mm = 120.0\n";
    let askew = level.to_owned() + "[start]\nx_mm = 0.05\n";
    let far = "[[ring]]\nz_mm = -40.0\n[[ring]]\nz_mm = 280.0\n";
    let stop = SUPPORT.to_owned() + "travel_mm = 0.01\n";
    for (name, tables) in [
        ("both ends at once", TWO_ENDS.to_owned() + level),
        ("beside the centre", TWO_ENDS.to_owned() + &askew),
        ("a far ring", TWO_ENDS.to_owned() + far),
        ("a soft support", SUPPORT.to_owned()),
        ("a stop", stop),
    ] {
        let pairs = alike(&scene(0.06, &tables));
        let off = |(a, b): &(Impact, Impact)| (a.normal_impulse / b.normal_impulse - 1.0).abs();
        let worst = pairs.iter().map(off).fold(0.0, f64::max);
        println!("{name}: {} impacts, off by {worst:.1e} at most", pairs.len());
        assert!(pairs.len() >= 2, "{name}");
        assert!(worst < 0.02, "{name}: {worst}");
    }
}

/// A ring that strikes its stop while it holds the rotor gives impulses; none of them is a force.
#[test]
fn the_force_between_impacts_does_not_grow_with_shorter_steps() {
    let support = "[support]\nmass_kg = 0.3\nstiffness_n_m = 6.5e5\ndamping_n_s_m = 230.0\n";
    let [coarse, fine] = [10.0, 1.0].map(|step| {
        let model = format!("travel_mm = 0.01\n[model]\nstep_us = {step:?}\n");
        let ring = model::run(&scene(0.1, &(support.to_owned() + &model)));
        ring.expect("a valid scene").ring.expect("a ring that moves").held_peak_force_n
    });
    println!("{coarse} N in steps of 10 us, {fine} N in steps of 1 us");
    assert!((fine / coarse - 1.0).abs() < 0.05, "{coarse} {fine}");
}
