//! Rung `moreau`: it converges to the independent reference with first order, stays near the gap and
//! gains no energy, whatever the configuration and the step.

use proptest::prelude::*;
use touchdown_base::history::{History, Recorder, Regime};
use touchdown_models::Moreau;
use touchdown_rotor::{Change, Precision, Start, Stepper, Touch};
use touchdown_run::model::simulate;
use touchdown_scene::{Fidelity, Scene, Scheme};
use touchdown_tests::drops::{Drop, inside};
use touchdown_truth::reference::Reference;

fn scene(name: &str, step: f64) -> Scene {
    let mut scene = Scene::load(name).expect("built-in scene");
    scene.model.rung = Fidelity::Moreau;
    scene.model.scheme = Scheme::Midpoint;
    scene.model.step = step;
    scene
}

fn truth(scene: &Scene) -> History {
    let mut recorder = Recorder::new(-scene.first_sample_time());
    let mut reference = Reference::new(&scene.machine(), &scene.start, scene.rotor.spin);
    let end = reference.advance(scene.run.duration, &mut |h| recorder.take(h));
    recorder.finish(end, reference.still_speed())
}

/// Error of impact `index` in the units of the scene: the larger of time and normal speed.
fn impact_error(scene: &Scene, truth: &History, found: &History, index: usize) -> f64 {
    let (want, have) = (&truth.impacts[index], &found.impacts[index]);
    let speed = (scene.run.gravity * scene.retainer.clearance).sqrt();
    let time = scene.retainer.clearance / speed;
    let late = (have.state.time - want.state.time).abs() / time;
    late.max((have.normal_speed - want.normal_speed).abs() / speed)
}

/// Slope of log error over log step, by least squares.
fn order(points: &[(f64, f64)]) -> f64 {
    let n = points.len() as f64;
    let (mut sx, mut sy, mut sxx, mut sxy) = (0.0, 0.0, 0.0, 0.0);
    for &(step, error) in points {
        let (x, y) = (step.ln(), error.ln());
        (sx, sy) = (sx + x, sy + y);
        (sxx, sxy) = (sxx + x * x, sxy + x * y);
    }
    (n * sxy - sx * sy) / (n * sxx - sx * sx)
}

/// Every impact counts from the middle of a step, up to one step late: the delay adds up by impacts.
#[test]
fn impacts_converge_to_the_reference_with_first_order() {
    const STEPS_US: [f64; 10] = [1.0, 2.0, 5.0, 10.0, 20.0, 50.0, 100.0, 200.0, 500.0, 1000.0];
    for precision in [
        touchdown_scene::Precision::F64,
        touchdown_scene::Precision::F32,
    ] {
        for name in ["rig", "rig-wide-gap", "rolling"] {
            for (index, factor) in [(0, 1.0), (2, 2.5), (9, 7.5)] {
                let mut points = Vec::new();
                for step in STEPS_US {
                    let mut scene = scene(name, step * 1e-6);
                    scene.model.precision = precision;
                    let (truth, found) = (truth(&scene), simulate(&scene).expect("valid scene"));
                    let error = impact_error(&scene, &truth, &found, index);
                    let unit = (scene.retainer.clearance / scene.run.gravity).sqrt();
                    let bound = factor * scene.model.step / unit;
                    let worst = error / bound;
                    assert!(worst <= 1.0, "{name} impact {index}, {step} us: {error:e}");
                    points.push((step, error));
                }
                let order = order(&points);
                println!(
                    "{precision:?} {name}: impact {} order {order:.2}",
                    index + 1
                );
                // The first few errors are those of where in its step an impact falls.
                if index == 9 {
                    assert!((0.85..=1.1).contains(&order), "{name}: {order}");
                }
            }
        }
    }
}

#[test]
fn contact_and_regime_are_those_of_the_reference() {
    for (name, step, regime) in [
        ("rig", 1e-4, Regime::Pendulum),
        ("rig-wide-gap", 1e-4, Regime::Pendulum),
        ("backward-whirl", 1e-3, Regime::BackwardWhirl),
        ("rolling", 1e-4, Regime::Pendulum),
        ("lift-off", 1e-6, Regime::BackwardWhirl),
    ] {
        let scene = scene(name, step);
        let (truth, found) = (truth(&scene), simulate(&scene).expect("valid scene"));
        assert_eq!(found.regime, regime, "{name}");
        assert_eq!(truth.regime, regime, "{name}");
        assert_eq!(found.lift_offs.len(), truth.lift_offs.len(), "{name}");
        let kinds = [
            (&found.contact_starts, &truth.contact_starts),
            (&found.rolling_starts, &truth.rolling_starts),
        ];
        for (found, truth) in kinds {
            if let (Some(found), Some(truth)) = (found.first(), truth.first()) {
                let late = found - truth;
                println!("{name}: {:.3} ms off, step {step:e} s", late * 1e3);
                assert!(late.abs() <= 8.0 * step, "{name}: {late}");
            }
        }
    }
}

fn built<R: Precision>(drop: &Drop) -> Moreau<R> {
    Moreau::try_new(&drop.config()).expect("valid configuration")
}

/// On the wall at the bottom, with this speed.
fn from_bottom(friction: f64, gravity: bool, spin: f64, step: f64, tangential: f64) -> Drop {
    Drop {
        friction,
        restitution: 0.8,
        inertia_ratio: 0.5,
        spin,
        gravity,
        step,
        start: Start::Wall {
            sin: 0.0,
            cos: 1.0,
            tangential,
        },
    }
}

/// Largest change of energy over `time` T.
fn energy_swing(drop: &Drop, time: f64) -> f64 {
    let model = built::<f64>(drop);
    let mut state = model
        .start(&drop.start.rounded(), drop.spin, |_| {})
        .expect("valid start");
    let first = drop.energy(&model.kinematics(&state));
    (0..(time / drop.step) as u64).fold(0.0, |worst, _| {
        model.step(&mut state, |_| {});
        worst.max((drop.energy(&model.kinematics(&state)) - first).abs())
    })
}

/// The curved wall neither takes nor gives energy: with the pendulum and going round.
#[test]
fn contact_keeps_energy_to_the_square_of_the_step() {
    for speed in [0.3, 1.2, 4.0, 20.0] {
        let swing = |step, time| energy_swing(&from_bottom(0.0, true, 0.0, step, speed), time);
        let (fine, coarse) = (swing(0.002, 20.0), swing(0.02, 20.0));
        let long = swing(0.02, 2000.0);
        println!(
            "speed {speed}: {fine:.1e} at 0.002 T, {coarse:.1e} at 0.02 T, {long:.1e} after 2000 T"
        );
        assert!(
            fine <= 1e-5 * coarse + 1e-13 * speed * speed,
            "{speed}: {fine:e}"
        );
        assert!(long <= 0.01 * 0.02 * 0.02, "{speed}: {long:e}");
    }
}

/// v' = mu v^2 without gravity: 1/v falls evenly, at any step, until it rolls.
#[test]
fn whirl_without_gravity_grows_exactly() {
    for step in [1e-3, 0.01, 0.1] {
        let drop = from_bottom(0.1, false, -1000.0, step, 1.0);
        let model = built::<f64>(&drop);
        let mut state = model
            .start(&drop.start.rounded(), drop.spin, |_| {})
            .expect("valid start");
        let mut rolls = None;
        for tick in 1..=(10.0 / step) as u64 {
            model.step(&mut state, |h| {
                if h.change == Change::RollingStarts {
                    rolls = Some((h.at.tick as f64 + h.at.fraction) * step);
                }
            });
            if rolls.is_none() {
                let [u, v] = model.kinematics(&state).velocity;
                let want = 1.0 / (1.0 - 0.1 * tick as f64 * step);
                assert!((u.hypot(v) / want - 1.0).abs() < 1e-9, "{step} {tick}");
            }
        }
        let last = (1.0 + 0.5 * 1000.0) / 1.5;
        let [u, v] = model.kinematics(&state).velocity;
        let until = (1.0 - 1.0 / last) / 0.1;
        let rolls = rolls.expect("rolls");
        println!("step {step}: rolls {:.1e} T off", rolls - until);
        assert!((rolls - until).abs() <= step && (u.hypot(v) / last - 1.0).abs() < 1e-9);
    }
}

/// Energy may rise within a step by the square of its length, and never by more over a run.
fn check<R: Precision>(drop: &Drop, steps: u32, rounding: f64) -> Result<(), TestCaseError> {
    let model = built::<R>(drop);
    let mut state = model
        .start(&drop.start.rounded(), R::lit(drop.spin), |_| {})
        .expect("valid start");
    let first = drop.energy(&model.kinematics(&state));
    let size = first.abs().max(1.0);
    let step = drop.step;
    for _ in 0..steps {
        let mut changes = 0;
        model.step(&mut state, |_| changes += 1);
        let k = model.kinematics(&state);
        let [x, y] = k.position.map(R::to_f64);
        let [u, v] = k.velocity.map(R::to_f64);
        let now = drop.energy(&k);
        prop_assert!(now.is_finite() && k.spin.is_finite());
        let beyond = x.hypot(y) - 1.0;
        let path = step * (u.hypot(v) + step);
        prop_assert!(beyond <= 0.5 * path + rounding, "left the gap by {beyond}");
        prop_assert!(
            now <= first + rounding * size + 0.5 * step * step,
            "energy {first} -> {now}"
        );
        prop_assert!(changes <= 3, "{changes} changes in a step");
        if k.touch == Touch::Rolling {
            let slip = -(u * y) + v * x + k.spin.to_f64();
            let size = size.sqrt().max(1.0);
            prop_assert!(slip.abs() <= rounding * size, "slip {slip}");
        }
    }
    Ok(())
}

prop_compose! {
    fn on_wall()(angle in 0.0..std::f64::consts::TAU, tangential in prop_oneof![-20.0..20.0_f64, -2000.0..2000.0])
                -> Start<f64> {
        Start::Wall { sin: angle.sin(), cos: angle.cos(), tangential }
    }
}

prop_compose! {
    fn drops()(friction in prop_oneof![Just(0.0), 0.0..2.0_f64, 0.0..100.0_f64],
               restitution in prop_oneof![Just(0.0), Just(1.0), Just(0.99), 0.0..1.0_f64],
               inertia_ratio in prop_oneof![0.05..2.0_f64, Just(5e-4), Just(500.0)],
               spin in prop_oneof![Just(0.0), -20.0..20.0_f64, -50_000.0..50_000.0_f64],
               gravity in prop::bool::weighted(0.8),
               step in prop_oneof![Just(1.8e-4), Just(1.8e-3), Just(0.018), Just(0.18), Just(1.0), Just(5.0), Just(30.0)],
               start in prop_oneof![inside(), on_wall()]) -> Drop {
        Drop { friction, restitution, inertia_ratio, spin, gravity, step, start }
    }
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 1000, failure_persistence: None,
                                        rng_seed: prop::test_runner::RngSeed::Fixed(1),
                                        ..ProptestConfig::default() })]

    #[test]
    fn in_f64(drop in drops()) {
        check::<f64>(&drop, 1000, 1e-9)?;
    }

    #[test]
    fn in_f32(drop in drops()) {
        check::<f32>(&drop, 1000, 1e-4)?;
    }
}
