//! The model against the reference on random starts on the wall: lift-offs, and the impacts after them.

use proptest::prelude::*;
use proptest::strategy::ValueTree;
use proptest::test_runner::TestRunner;
use touchdown_base::machine::Start;
use touchdown_run::model::simulate;
use touchdown_scene::{Precision, Scene};
use touchdown_tests::growth::{apart, growth, unit_speed};

/// Scenes, where the environment's `PROPTEST_CASES` says nothing else.
const SCENES: usize = 300;
const STEPS: [f64; 4] = [1e-6, 1e-5, 1e-4, 1e-3];

fn scenes() -> impl Strategy<Value = Scene> {
    (
        prop_oneof![Just(0.0), 0.0..0.5, 0.0..1.5],
        0.0..0.9,
        prop_oneof![Just(0.0), -4000.0..4000.0, -50.0..50.0],
        20e-6..1e-3,
        -3.1..3.1,
        -2.5..2.5,
    )
        .prop_map(|(friction, restitution, spin, clearance, angle, speed)| {
            let mut scene = Scene::load("rig").expect("built-in scene");
            scene.rotor.spin = spin;
            scene.retainer.friction = friction;
            scene.retainer.restitution = restitution;
            scene.retainer.clearance = clearance;
            let unit = unit_speed(&scene);
            scene.start = Start::Wall {
                angle,
                tangential: speed * unit,
            };
            scene.run.duration = 12.0 * clearance / unit;
            scene
        })
}

#[test]
fn random_lift_offs_meet_the_target_at_any_step() {
    let cases = std::env::var("PROPTEST_CASES").ok();
    let wanted = cases.map_or(SCENES, |it| it.parse().expect("a number of scenes"));
    let mut runner = TestRunner::deterministic();
    let strategy = scenes();
    let (mut most, mut compared) = ([0.0, 0.0], 0);
    for _ in 0..wanted {
        let mut scene = strategy.new_tree(&mut runner).expect("a scene").current();
        let truth = touchdown_truth::simulate(&scene);
        let (Some(&lift_off), Some(first)) = (truth.lift_offs.first(), truth.impacts.first())
        else {
            continue;
        };
        let growth = growth(&scene, &truth, 1);
        let Some(&growth) = growth.first() else {
            continue;
        };
        compared += 1;
        let unit = scene.retainer.clearance / unit_speed(&scene);
        for (slot, (precision, target)) in [(Precision::F64, 1e-6), (Precision::F32, 4e-5)]
            .into_iter()
            .enumerate()
        {
            for step in STEPS {
                scene.model.precision = precision;
                scene.model.step = step;
                let history = simulate(&scene).expect("valid scene");
                let found = history.impacts.first();
                let lifted = history.lift_offs.first();
                let error = match (found, lifted) {
                    (Some(impact), Some(time)) => {
                        apart(impact, first, &scene).max((time - lift_off).abs() / unit)
                    }
                    _ => f64::INFINITY,
                };
                let ratio = error / (target * f64::max(1.0, growth / 10.0));
                most[slot] = f64::max(most[slot], ratio);
            }
        }
    }
    println!(
        "{compared} lift-offs; worst over target: {:.1e} f64, {:.1e} f32",
        most[0], most[1]
    );
    assert!(5 * compared > wanted, "{compared}");
    assert!(most[0] <= 1.0 && most[1] <= 1.0, "{most:?}");
}
