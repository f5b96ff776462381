//! The model under test against closed forms, f64 and f32.

use touchdown_rotor::real::{Micro32, Poly32};
use touchdown_rotor::{
    Change, ModelEvent, Instant, Kinematics, Precision, Rigid, RigidConfig, RigidState, Start, Touch,
};

/// Dimensionless: gap, radius and gravity (or the scaling speed) are 1.
fn model<R: Precision>(friction: f64, restitution: f64, gravity: bool, step: f64) -> Rigid<R> {
    Rigid::try_new(&RigidConfig {
        mass: R::ONE,
        radius: R::ONE,
        polar_inertia: R::HALF,
        clearance: R::ONE,
        friction: R::lit(friction),
        restitution: R::lit(restitution),
        gravity: if gravity { R::ONE } else { R::ZERO },
        speed: R::ONE,
        step: R::lit(step),
    })
    .expect("valid configuration")
}

fn bottom<R: Precision>(speed: f64) -> Start<R> {
    Start::Wall {
        sin: R::ZERO,
        cos: R::ONE,
        tangential: R::lit(speed),
    }
}

fn steps<R: Precision>(at: Instant<R>) -> f64 {
    at.tick as f64 + at.fraction.to_f64()
}

fn speed<R: Precision>(k: &Kinematics<R>) -> f64 {
    let [u, v] = k.velocity.map(R::to_f64);
    u.hypot(v)
}

/// Runs `count` steps; the happenings.
fn run<R: Precision>(
    model: &Rigid<R>,
    start: &Start<R>,
    spin: f64,
    count: u64,
) -> (RigidState<R>, Vec<ModelEvent<R>>) {
    let mut happenings = Vec::new();
    let mut state = model
        .start(start, R::lit(spin), |h| happenings.push(h))
        .expect("valid start");
    for _ in 0..count {
        model.step(&mut state, |h| happenings.push(h));
    }
    (state, happenings)
}

/// Without gravity whirl grows as v' = mu v^2 until it rolls, at v_f = (v_0 - beta W)/(1 + beta).
fn weightless_whirl<R: Precision>(tolerance: f64) {
    let (friction, start, spin) = (0.1, 1.0, -1000.0);
    let last = (start - 0.5 * spin) / 1.5;
    let until = (1.0 / start - 1.0 / last) / friction;
    for step in [1.8e-4, 1.8e-3, 0.018, 0.18, 5.5] {
        let model = model::<R>(friction, 0.8, false, step);
        let count = (until / step) as u64 + 1;
        let (state, happenings) = run(&model, &bottom(start), spin, count);
        let rolling = happenings
            .iter()
            .find(|h| h.change == Change::RollingStarts)
            .expect("rolls");
        let found = steps(rolling.at) * R::lit(step).to_f64();
        let k = model.kinematics(&state);
        println!("step {step}: {:.1e}", found / until - 1.0);
        assert!((found / until - 1.0).abs() < tolerance, "{step}: {found}");
        assert!((speed(&k) / last - 1.0).abs() < tolerance, "{}", speed(&k));
        assert_eq!(k.touch, Touch::Rolling);
        // Hundreds of turns in one step are beyond the bound on what is followed.
        assert_eq!(state.shortened() > 0, step > 1.0, "{}", state.shortened());
    }
}

#[test]
fn weightless_whirl_grows_until_it_rolls() {
    weightless_whirl::<f64>(1e-12);
    weightless_whirl::<f32>(1e-5);
    weightless_whirl::<Poly32>(1e-5);
    // Its sine and cosine are off by 2e-3, and the mean of a fast whirl with them.
    weightless_whirl::<Micro32>(1e-3);
}

/// Elastic and frictionless: translation and height are kept.
fn energy<R: Precision>(count: u64, tolerance: f64) {
    let model = model::<R>(0.0, 1.0, true, 1.8e-3);
    let start = Start::Free {
        position: [R::lit(1.0 / 3.0), R::lit(1.0 / 15.0)],
        velocity: [R::ZERO; 2],
    };
    let (state, happenings) = run(&model, &start, 0.0, count);
    let k = model.kinematics(&state);
    let energy = 0.5 * speed(&k).powi(2) + k.position[1].to_f64();
    let drift = energy - R::lit(1.0 / 15.0).to_f64();
    println!("{} impacts, drift {drift:.1e}", happenings.len());
    assert!(happenings.len() as u64 > count / 1500);
    assert!(drift.abs() <= tolerance, "{drift:e}");
}

#[test]
fn elastic_bouncing_keeps_its_energy() {
    energy::<f64>(1_000_000, 1e-12);
    energy::<f32>(1_000_000, 1e-4);
}

/// (u - A cos phi - B sin phi) e^(-2 mu_s phi) of sliding, u = phi'^2.
fn sliding_invariant<R: Precision>(k: &Kinematics<R>, friction: f64) -> f64 {
    let [x, y] = k.position.map(R::to_f64);
    let a = 2.0 * (1.0 - 2.0 * friction * friction) / (1.0 + 4.0 * friction * friction);
    let b = 6.0 * friction / (1.0 + 4.0 * friction * friction);
    let angle = x.atan2(-y);
    (speed(k).powi(2) + a * y - b * x) * (-2.0 * friction * angle).exp()
}

fn sliding<R: Precision>(count: u64, tolerance: f64) {
    // So much spin that the slip keeps its sign.
    let model = model::<R>(0.1, 0.8, true, 1.8e-3);
    let mut state = model
        .start(&bottom(0.2), R::lit(-1e6), |_| ())
        .expect("valid start");
    let first = sliding_invariant(&model.kinematics(&state), 0.1);
    let mut worst = 0.0_f64;
    for _ in 0..count {
        model.step(&mut state, |_| ());
        let now = sliding_invariant(&model.kinematics(&state), 0.1);
        worst = worst.max((now - first).abs());
    }
    println!("invariant {worst:.1e} over {count} steps");
    assert!(worst <= tolerance, "{worst:e}");
}

#[test]
fn sliding_keeps_its_invariant() {
    sliding::<f64>(1_000_000, 1e-6);
    sliding::<f32>(1_000_000, 1e-6);
}

/// A parabola that touches the wall from inside at the top left, and goes on.
fn graze<R: Precision>(time_error: f64) {
    let (angle, speed, before) = (2.5_f64, 0.6_f64, 0.4_f64);
    assert!(
        speed * speed + angle.cos() < 0.0,
        "the path bends away there"
    );
    let touch = [angle.sin(), -angle.cos()];
    let there = [speed * angle.cos(), speed * angle.sin()];
    let start = Start::Free {
        position: [
            R::lit(touch[0] - there[0] * before),
            R::lit(touch[1] - there[1] * before - 0.5 * before * before),
        ],
        velocity: [R::lit(there[0]), R::lit(there[1] + before)],
    };
    // After the touch: |p|^2 - 1 = (v^2 + p.g) t^2 + v.g t^3 + t^4/4 = 0.
    let (c2, c3) = (speed * speed + angle.cos(), -there[1]);
    let landing = 2.0 * (-c3 + (c3 * c3 - c2).sqrt());
    for step in [1.8e-4, 1.8e-3, 0.018, 0.18] {
        let model = model::<R>(0.1, 0.8, true, step);
        let (_, happenings) = run(&model, &start, 1000.0, (4.0 / step) as u64);
        let first = &happenings[0];
        assert!(matches!(first.change, Change::Impact { .. }), "{first:?}");
        let found = steps(first.at) * R::lit(step).to_f64() - before;
        println!("step {step}: {:.1e}", found - landing);
        assert!((found - landing).abs() <= time_error, "{found} {landing}");
    }
}

#[test]
fn an_exact_graze_is_no_impact() {
    graze::<f64>(1e-6);
    graze::<f32>(1e-5);
}

/// Straight down from the centre, v t + t^2/2 = 1, however fast.
fn thrown_down<R: Precision>(tolerance: f64) {
    for speed in [1e-9, 1e-3, 1.0, 1e3, 3e5, 1e9] {
        let until = 2.0 / (f64::hypot(speed, 2.0_f64.sqrt()) + speed);
        let start = Start::Free {
            position: [R::ZERO; 2],
            velocity: [R::ZERO, R::lit(-speed)],
        };
        let step = 2.0 * until;
        let (_, happenings) = run(&model::<R>(0.1, 0.0, true, step), &start, 0.0, 1);
        let found = steps(happenings[0].at) * step;
        assert!((found / until - 1.0).abs() <= tolerance, "{speed}: {found}");
    }
}

#[test]
fn a_start_of_any_speed_meets_the_wall() {
    thrown_down::<f64>(1e-14);
    thrown_down::<f32>(1e-6);
}

/// Friction too weak to hold rolling against gravity, in f32: it slips to and fro within a turn, but rolls in
/// the mean. Found by fuzzing: rounding of a slip of 0 sent the spin to -1667 V.
#[test]
fn whirl_that_friction_hardly_holds_does_not_run_away() {
    let model = Rigid::<f32>::try_new(&RigidConfig {
        mass: 1.0,
        radius: 1.0,
        polar_inertia: 5e-4,
        clearance: 1.0,
        friction: 1e-9_f64.powf(1.0 - 48.0 / 65535.0 * 11.0 / 9.0) as f32,
        restitution: 1e-9_f64.powf(255.0 / 65535.0) as f32,
        gravity: 1.0,
        speed: 1.0,
        step: 1000.0,
    })
    .expect("valid configuration");
    let distance = 1e-9_f64.powf(23_007.0 / 65535.0);
    let (sin, cos) = f64::from(-0.012_723_207_f32).sin_cos();
    let start = Start::Free {
        position: [distance * sin, -distance * cos].map(|x| x as f32),
        velocity: [1e6, 0.0],
    };
    for count in 1..8 {
        let (state, _) = run(&model, &start, 0.0, count);
        let k = model.kinematics(&state);
        println!("speed {}, spin {}", speed(&k), k.spin);
        assert!((speed(&k) - 692.1).abs() < 0.1 && (k.spin + 692.1).abs() < 0.1);
    }
}

#[test]
fn without_gravity_and_speed_nothing_happens() {
    let model = model::<f64>(0.1, 0.8, false, 1.8e-3);
    let still = Start::Free {
        position: [0.0; 2],
        velocity: [0.0; 2],
    };
    let (state, happenings) = run(&model, &still, 1000.0, 10_000);
    assert!(happenings.is_empty());
    assert_eq!(model.kinematics(&state).position, [0.0; 2]);
}

#[test]
fn a_start_on_the_wall_that_moves_outward_hits_at_once() {
    let model = model::<f64>(0.0, 0.8, true, 1.8e-3);
    let start = Start::Free {
        position: [0.0, -1.0],
        velocity: [0.0, -0.5],
    };
    let (_, happenings) = run(&model, &start, 0.0, 1);
    let change = Change::Impact { speed: 0.5, impulse: 0.9 };
    assert_eq!(happenings[0].change, change);
    assert_eq!(steps(happenings[0].at), 0.0);
}

#[test]
fn configurations_that_make_no_sense_are_refused() {
    let good = RigidConfig {
        mass: 1.0,
        radius: 1.0,
        polar_inertia: 0.5,
        clearance: 1.0,
        friction: 0.1,
        restitution: 0.8,
        gravity: 1.0,
        speed: 1.0,
        step: 0.01,
    };
    for (bad, parameter) in [
        (RigidConfig { mass: 0.0, ..good }, "mass"),
        (
            RigidConfig {
                radius: -1.0,
                ..good
            },
            "radius",
        ),
        (
            RigidConfig {
                polar_inertia: f64::NAN,
                ..good
            },
            "polar_inertia",
        ),
        (
            RigidConfig {
                clearance: f64::INFINITY,
                ..good
            },
            "clearance",
        ),
        (
            RigidConfig {
                friction: -0.1,
                ..good
            },
            "friction",
        ),
        (
            RigidConfig {
                restitution: 1.1,
                ..good
            },
            "restitution",
        ),
        (
            RigidConfig {
                gravity: -1.0,
                ..good
            },
            "gravity",
        ),
        (RigidConfig { step: 0.0, ..good }, "step"),
        (
            RigidConfig {
                gravity: 0.0,
                speed: 0.0,
                ..good
            },
            "speed",
        ),
    ] {
        let error = Rigid::try_new(&bad).expect_err(parameter);
        assert_eq!(error.parameter(), parameter);
    }
    let model = Rigid::try_new(&good).expect("valid");
    let outside = Start::Free {
        position: [0.8, 0.8],
        velocity: [0.0; 2],
    };
    let error = model.start(&outside, 0.0, |_| ()).expect_err("outside");
    assert_eq!(error.parameter(), "start");
}
