//! A model that is followed from sample to sample runs as it does alone.

use touchdown_run::model;
use touchdown_scene::{BUILT_IN, Scene};
use touchdown_truth::Truth;

/// The same bits, whatever moments are asked for on the way.
#[test]
fn asking_on_the_way_changes_nothing() {
    for built_in in BUILT_IN {
        let mut scene = Scene::load(built_in.name).expect("built in");
        scene.run.duration = scene.run.duration.min(0.1);
        let alone = model::run(&scene).expect("runs");
        for parts in [1.0, 0.37, 2.9] {
            let mut followed = model::follow(&scene).expect("runs");
            let every = parts * scene.model.step;
            let moments = (scene.run.duration / every) as u64;
            for k in 0..=moments {
                followed.advance(k as f64 * every);
            }
            assert_eq!(followed.finish(), alone, "{} {parts}", built_in.name);
        }
    }
}

/// Between the steps of the rigid rung too, and where the sensors of a tilted rotor sit.
#[test]
fn what_the_sensors_see_is_the_references() {
    for (name, step, until, tolerance) in [
        ("rig", 1e-3, 0.06, 1e-12),
        ("rolling", 3.7e-5, 0.06, 1e-12),
        ("two-plane", 1e-6, 0.02, 1e-6),
        ("york-ymc2", 2e-6, 0.0059, 1e-5),
        ("ball-bearing", 1e-6, 0.02, 1e-5),
    ] {
        let mut scene = Scene::load(name).expect("built in");
        scene.model.step = step;
        let mut followed = model::follow(&scene).expect("runs");
        let mut truth = Truth::new(&scene);
        let gap = scene.retainer.clearance;
        for k in -3..(until * 20_000.0) as i32 {
            let time = f64::from(k) / 20_000.0;
            let ours = followed.advance(time).expect("is not given up");
            let theirs = truth.advance(time);
            for (a, b) in ours.sensed.iter().flatten().zip(theirs.sensed.iter().flatten()) {
                let off = (a - b).abs() / gap;
                assert!(off <= tolerance, "{name} at {time} s: {off:e}");
            }
        }
    }
}
