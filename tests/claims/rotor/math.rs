//! The functions of each kind of number against those of libm in f64: largest errors on dense grids, and what they
//! make of the built-in scenes. The open cases: `model_cases.rs`.

use std::f64::consts::{LN_10, PI, TAU};

use touchdown_base::history::{History, Recorder};
use touchdown_rotor::real::{Micro32, Poly32, Real};
use touchdown_run::model::simulate;
use touchdown_scene::{BUILT_IN, Math, Precision, Fidelity, Scene};
use touchdown_truth::reference::Reference;

const GRID: u32 = 200_000;

/// What the errors are of. Absolute, but the square root's relative, and the logarithm's where it is
/// above 1.
const NAMES: [&str; 5] = [
    "sqrt, 1e-30 to 1e30",
    "sin_cos, to 1 turn",
    "sin_cos, to 10 000 rad",
    "atan2, all directions",
    "ln, 1e-30 to 1e30",
];

fn largest<R: Real>(grid: impl Iterator<Item = f64>, error: impl Fn(R, f64) -> f64) -> f64 {
    // Truth is taken where the number really is after its rounding.
    let errors = grid.map(|x| R::lit(x)).map(|x| error(x, x.to_f64()));
    errors.fold(0.0, |worst, error| {
        assert!(error.is_finite());
        worst.max(error)
    })
}

fn linear(from: f64, to: f64) -> impl Iterator<Item = f64> {
    (0..=GRID).map(move |k| from + (to - from) * f64::from(k) / f64::from(GRID))
}

fn powers_of_ten(from: f64, to: f64) -> impl Iterator<Item = f64> {
    linear(from, to).map(|power| 10.0_f64.powf(power))
}

/// Largest errors in the order of [`NAMES`].
fn errors<R: Real>() -> [f64; 5] {
    let circle = |x: R, truth: f64| {
        let (sin, cos) = x.sin_cos();
        let (true_sin, true_cos) = libm::sincos(truth);
        f64::max(
            (sin.to_f64() - true_sin).abs(),
            (cos.to_f64() - true_cos).abs(),
        )
    };
    let atan2 = |x: R, _: f64| {
        let (sin, cos) = libm::sincos(x.to_f64());
        let sizes = [1e-12, 1.0, 1e12].map(|size| (R::lit(sin * size), R::lit(cos * size)));
        let errors = sizes.map(|(y, x)| {
            let error = y.atan2(x).to_f64() - libm::atan2(y.to_f64(), x.to_f64());
            // -pi and pi are one angle.
            error.abs().min((error.abs() - TAU).abs())
        });
        errors.into_iter().fold(0.0, f64::max)
    };
    [
        largest(powers_of_ten(-30.0, 30.0), |x: R, truth| {
            (x.sqrt().to_f64() / truth.sqrt() - 1.0).abs()
        }),
        largest(linear(-TAU, TAU), circle),
        largest(linear(-1e4, 1e4), circle),
        largest(linear(-PI, PI), atan2),
        largest(
            powers_of_ten(-30.0, 30.0).chain(linear(0.4, 2.6)),
            |x: R, truth| {
                let ln = libm::log(truth);
                (x.ln().to_f64() - ln).abs() / ln.abs().max(1.0)
            },
        ),
    ]
}

fn assert_within<R: Real>(limits: [f64; 5]) {
    let number = std::any::type_name::<R>().rsplit(':').next();
    let number = number.expect("a name");
    for ((name, found), limit) in NAMES.iter().zip(errors::<R>()).zip(limits) {
        println!("{number} {name}: {found:.1e} of {limit:.1e}");
        assert!(found <= limit, "{number} {name}: {found:e}");
    }
}

#[test]
fn functions_are_as_accurate_as_documented() {
    assert_within::<f32>([6e-8, 6e-8, 6e-8, 3e-7, 9e-8]);
    assert_within::<Poly32>([6e-8, 1e-7, 1e-7, 3e-7, 9e-8]);
    assert_within::<Micro32>([6e-8, 1.2e-3, 2.5e-3, 2.9e-3, 0.13]);
    assert_within::<f64>([1.2e-16, 0.0, 0.0, 0.0, 0.0]);
}

fn history(scene: &Scene, precision: Precision, math: Math) -> History {
    let mut scene = scene.clone();
    scene.model.precision = precision;
    scene.model.math = math;
    simulate(&scene).expect("valid scene")
}

/// What the reference makes of a scene.
fn reference(scene: &Scene) -> History {
    let mut reference = Reference::new(&scene.machine(), &scene.start, scene.rotor.spin);
    let mut recorder = Recorder::new(-scene.first_sample_time());
    let end = reference.advance(scene.run.duration, &mut |h| recorder.take(h));
    recorder.finish(end, reference.still_speed())
}

#[test]
fn regimes_of_the_built_in_scenes_are_those_of_the_reference() {
    for scene in BUILT_IN {
        let name = scene.name;
        let scene = Scene::load(name).expect("built-in scene");
        if scene.model.rung != Fidelity::Rigid {
            continue;
        }
        let truth = reference(&scene);
        for precision in Precision::ALL {
            for &math in scene.model.rung.maths(precision) {
                let found = history(&scene, precision, math);
                assert_eq!(found.regime, truth.regime, "{name} {precision:?} {math:?}");
                // Case 20: after 211 impacts the place is chance in f32.
                if name == "lift-off" {
                    continue;
                }
                let [[x, y], [u, v]] = [found.end.position, truth.end.position];
                let error = f64::hypot(x - u, y - v) / scene.retainer.clearance;
                println!("{name} {precision:?} {math:?}: {error:.1e} of the clearance");
                let limit = match precision {
                    Precision::F32 => 2e-5,
                    Precision::F64 => 1e-12,
                };
                assert!(error <= limit, "{name} {precision:?} {math:?}: {error:e}");
            }
        }
    }
}

fn edges<R: Real>() {
    let nan = R::lit(f64::NAN);
    assert_eq!(R::ZERO.ln(), -R::INFINITY);
    assert_eq!(R::INFINITY.ln(), R::INFINITY);
    assert_eq!(R::ONE.ln(), R::ZERO);
    for none in [
        (-R::ONE).ln(),
        nan.ln(),
        nan.sin_cos().0,
        R::INFINITY.sin_cos().1,
    ] {
        assert!(none.to_f64().is_nan(), "{none:?}");
    }
    assert_eq!(R::ZERO.atan2(R::ZERO), R::ZERO);
    // Angles that have no digits left of a turn are somewhere on the circle.
    for power in 4..38 {
        let (sin, cos) = R::lit(10.0_f64.powi(power)).sin_cos();
        let radius = f64::hypot(sin.to_f64(), cos.to_f64());
        assert!((radius - 1.0).abs() < 2e-7, "1e{power}: {radius}");
    }
}

#[test]
fn polynomials_are_sane_at_the_edges() {
    edges::<Poly32>();
    // The smallest numbers.
    for (small, ln) in [(1e-40, -40.0), (1e-45, -45.0)].map(|(x, power)| (x, power * LN_10)) {
        assert!((Poly32::lit(small).ln().to_f64() - ln).abs() < 0.4);
    }
}
