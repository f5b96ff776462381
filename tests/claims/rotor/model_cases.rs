//! The model under test against the 40-digit values of `data/cases`, at every step and precision, with
//! every kind of functions.

use touchdown_base::history::{History, Impact};
use touchdown_base::machine::Start;
use touchdown_rotor::error::ConfigError;
use touchdown_rotor::{Change, ModelEvent, Kinematics, Precision as Digits, Stepper};
use touchdown_run::model::{Subject, Use, simulate, with_model};
use touchdown_scene::{Fidelity, Math, Precision, Scene};
use touchdown_tests::cases::{Case, open_cases};

const STEPS: [f64; 4] = [1e-6, 1e-5, 1e-4, 1e-3];
const PRECISIONS: [Precision; 2] = [Precision::F64, Precision::F32];

fn scene(case: &Case, precision: Precision, math: Math, step: f64) -> Scene {
    let mut scene = case.scene();
    scene.model.precision = precision;
    scene.model.math = math;
    scene.model.step = step;
    scene
}

fn run(case: &Case, precision: Precision, math: Math, step: f64) -> History {
    simulate(&scene(case, precision, math, step)).expect("valid case")
}

fn open_case(name: &str) -> Case {
    let mut cases = open_cases().into_iter();
    cases
        .find(|case| case.name.starts_with(name))
        .expect("known case")
}

fn runs(case: &Case) -> Vec<(String, Precision, History)> {
    let mut all = Vec::new();
    for precision in PRECISIONS {
        for &math in Fidelity::Rigid.maths(precision) {
            for step in STEPS {
                let name = format!("{} {precision:?} {math:?} {step:e} s", case.name);
                all.push((name, precision, run(case, precision, math, step)));
            }
        }
    }
    all
}

fn distance(a: [f64; 2], b: [f64; 2]) -> f64 {
    f64::hypot(a[0] - b[0], a[1] - b[1])
}

/// Largest of the errors of time, position and velocity, in the units of the case.
fn impact_error(case: &Case, k: usize, impact: &Impact) -> f64 {
    let (want, unit) = (&case.result.impacts[k], &case.nondimensional);
    let time = (impact.state.time - want.t).abs() / unit.T_s;
    let position = distance(impact.state.position, [want.x, want.y]) / case.parameters.rho0_m;
    let velocity = distance(impact.state.velocity, [want.vx, want.vy]) / unit.V_m_s;
    let normal = (impact.normal_speed - want.vn_minus).abs() / unit.V_m_s;
    time.max(position).max(velocity).max(normal)
}

/// Growth of a start error up to an impact.
fn growth(case: &Case, k: usize) -> f64 {
    let known = case.conditioning.amplification_at_impact.get(k);
    known.copied().flatten().expect("known growth")
}

/// The target of the first series: what rounding of the start alone makes.
fn impact_target(case: &Case, precision: Precision, k: usize) -> f64 {
    match precision {
        Precision::F64 => 1e-14 + 20.0 * growth(case, k) * 2.2e-16,
        Precision::F32 => 5e-6 + 50.0 * growth(case, k) * 6e-8,
    }
}

/// Impacts before the growth has eaten all digits; all 40 but without losses.
fn comparable(case: &Case, precision: Precision) -> usize {
    match precision {
        Precision::F32 if case.name.starts_with("07") => 13,
        _ => case.result.impacts.len(),
    }
}

#[test]
fn impacts_meet_the_target_at_any_step() {
    let mut compared = 0;
    for case in open_cases() {
        for (name, precision, history) in runs(&case) {
            let count = comparable(&case, precision);
            assert!(history.impacts.len() >= count, "{name}: impacts missing");
            let mut worst = 0.0_f64;
            for (k, impact) in history.impacts.iter().take(count).enumerate() {
                let ratio = impact_error(&case, k, impact) / impact_target(&case, precision, k);
                worst = worst.max(ratio);
                assert!(
                    ratio <= 1.0,
                    "{name}: impact {k} at {ratio:.2} of the target"
                );
                compared += 1;
            }
            println!("{name}: {count} impacts, worst at {worst:.3} of the target");
        }
    }
    assert!(compared > 500, "{compared}");
}

#[test]
fn every_impact_and_change_of_contact_is_counted() {
    for case in open_cases() {
        for (name, precision, history) in runs(&case) {
            let result = &case.result;
            // In f32 the series ends at a higher speed; without losses (07) the count is chance.
            if precision == Precision::F64 && !case.name.starts_with("07") {
                assert_eq!(history.impacts.len(), result.n_impacts_total, "{name}");
            }
            let found = [
                history.contact_starts.len(),
                history.lift_offs.len(),
                history.rolling_starts.len(),
            ];
            let want = [
                result.t_permanent_contacts.len(),
                result.t_lift_offs.len(),
                result.t_rolling_starts.len(),
            ];
            assert_eq!(found, want, "{name}");
        }
    }
}

#[test]
fn the_first_impact_after_a_lift_off_meets_the_target_at_any_step() {
    let mut compared = 0;
    for case in open_cases() {
        for (name, precision, history) in runs(&case) {
            for &lift_off in &case.result.t_lift_offs {
                let after = |t: f64| t > lift_off * (1.0 + 1e-6);
                let Some(k) = case
                    .result
                    .impacts
                    .iter()
                    .position(|impact| after(impact.t))
                else {
                    continue;
                };
                let target = match precision {
                    Precision::F64 => 1e-6,
                    Precision::F32 => 4e-5,
                } * (growth(&case, k) / 10.0).max(1.0);
                let error = impact_error(&case, k, &history.impacts[k]);
                println!("{name}: {error:.1e} of {target:.0e}");
                assert!(error <= target, "{name}: {error:e}");
                compared += 1;
            }
        }
    }
    assert!(compared >= 8, "{compared}");
}

#[test]
fn permanent_contact_meets_the_target_at_any_step() {
    let mut compared = 0;
    for case in open_cases() {
        for (name, precision, history) in runs(&case) {
            let (Some(&found), Some(&want)) = (
                history.contact_starts.first(),
                case.result.t_permanent_contacts.first(),
            ) else {
                assert!(case.result.t_permanent_contacts.is_empty(), "{name}");
                continue;
            };
            let error = (found - want).abs() / case.nondimensional.T_s;
            let target = match precision {
                Precision::F64 => 1e-11,
                Precision::F32 => 1e-5,
            };
            println!("{name}: {error:.1e}");
            assert!(error <= target, "{name}: {error:e}");
            compared += 1;
        }
    }
    assert!(compared >= 40, "{compared}");
}

#[test]
fn the_result_does_not_depend_on_the_step() {
    for case in open_cases() {
        for (precision, target) in [(Precision::F64, 1e-13), (Precision::F32, 1e-6)] {
            for &math in Fidelity::Rigid.maths(precision) {
                let fine = run(&case, precision, math, STEPS[0]);
                let coarse = STEPS[1..].iter();
                let spread = coarse
                    .map(|&step| spread(&case, &fine, &run(&case, precision, math, step)))
                    .fold(0.0, f64::max);
                let name = format!("{} {precision:?} {math:?}", case.name);
                println!("{name}: {spread:.1e} of {target:.0e}");
                assert!(spread <= target, "{name}: {spread:e}");
            }
        }
    }
}

/// Largest difference of two runs over the known impacts, in the units of the case.
fn spread(case: &Case, fine: &History, coarse: &History) -> f64 {
    assert_eq!(fine.impacts.len(), coarse.impacts.len(), "{}", case.name);
    let count = case.result.impacts.len();
    let impacts = fine.impacts.iter().zip(&coarse.impacts).take(count);
    impacts.fold(0.0, |worst, (a, b)| {
        let (a, b) = (&a.state, &b.state);
        let position = distance(a.position, b.position) / case.parameters.rho0_m;
        let velocity = distance(a.velocity, b.velocity) / case.nondimensional.V_m_s;
        let time = (a.time - b.time).abs() / case.nondimensional.T_s;
        worst.max(position).max(velocity).max(time)
    })
}

#[test]
fn regimes_are_those_of_the_cases() {
    for case in open_cases() {
        let want = case.regime();
        for (name, _, history) in runs(&case) {
            assert_eq!(history.regime, want, "{name}");
        }
    }
}

#[test]
fn sliding_and_spin_after_0_3_s() {
    let case = open_case("15");
    for (name, precision, history) in runs(&case) {
        let want = &case.result.final_state;
        let position = distance(history.end.position, [want.x, want.y]) / case.parameters.rho0_m;
        let spin = (history.end.spin / want.omega - 1.0).abs();
        println!("{name}: position {position:.1e}, spin {spin:.1e}");
        let (position_target, spin_target) = match precision {
            Precision::F64 => (6e-9, 1e-9),
            Precision::F32 => (1e-6, 1e-7),
        };
        assert!(position <= position_target && spin <= spin_target, "{name}");
    }
}

#[test]
fn slide_to_rolling() {
    let case = open_case("19");
    for (name, precision, history) in runs(&case) {
        let want = &case.result.final_state;
        let position = distance(history.end.position, [want.x, want.y]) / case.parameters.rho0_m;
        println!("{name}: {position:.1e}");
        let target = match precision {
            Precision::F64 => 1.7e-6,
            Precision::F32 => 2e-4,
        };
        assert!(position <= target, "{name}: {position:e}");
        assert_eq!(history.rolling_starts.len(), 1, "{name}");
    }
}

/// Runs the same drop by steps and at once: the same bits, or, where whole periods were passed over (it
/// has solved fewer stretches then), the same within `tolerance`. Changes of motion, and whether any was.
struct BothWays {
    steps: f64,
    tolerance: f64,
}

impl Use for BothWays {
    type Output = (usize, bool);

    fn with<R: Digits, M: Stepper<R>>(
        self,
        Subject {
            model, start, spin, ..
        }: &Subject<R, M>,
    ) -> Result<(usize, bool), ConfigError> {
        let (whole, part) = (self.steps.floor() as u64, R::lit(self.steps.fract()));
        let mut seen = Vec::new();
        let mut stepped = model.start(start, *spin, |h| seen.push(h))?;
        for _ in 0..whole {
            model.step(&mut stepped, |h| seen.push(h));
        }
        model.part_step(&mut stepped, part, |h| seen.push(h));
        let mut told = Vec::new();
        let mut run = model.start(start, *spin, |h| told.push(h))?;
        model.run(&mut run, whole, part, |h| told.push(h));
        let last = [&run, &stepped].map(|state| model.kinematics(state));
        if model.solved(&run) == model.solved(&stepped) {
            assert_eq!(told, seen);
            assert_eq!(last[0], last[1]);
            return Ok((told.len(), false));
        }
        assert_eq!(told.len(), seen.len());
        let contact = |h: &ModelEvent<R>| h.change == Change::ContactStarts;
        let same = seen.iter().position(contact).map_or(0, |index| index + 1);
        assert_eq!(told[..same], seen[..same]);
        let apart = far_apart(&last[0], &last[1]);
        println!("{apart:.1e} of {:.0e}", self.tolerance);
        assert!(apart <= self.tolerance, "{apart:e}");
        Ok((told.len(), true))
    }
}

/// Largest difference of place, velocity and, relative, spin, in the units of the model.
fn far_apart<R: Digits>(a: &Kinematics<R>, b: &Kinematics<R>) -> f64 {
    let position = distance(a.position.map(R::to_f64), b.position.map(R::to_f64));
    let velocity = distance(a.velocity.map(R::to_f64), b.velocity.map(R::to_f64));
    let (one, other) = (a.spin.to_f64(), b.spin.to_f64());
    let spin = (one - other).abs() / other.abs().max(1.0);
    assert_eq!((a.touch, a.turns.0), (b.touch, b.turns.0));
    position.max(velocity).max(spin)
}

#[test]
fn a_run_has_the_bits_of_its_steps_up_to_the_periods_that_it_passes_over() {
    let (mut changes, mut passed) = (0, 0);
    for case in open_cases() {
        for precision in PRECISIONS {
            for step in STEPS {
                let scene = scene(&case, precision, Math::Libm, step);
                let both = BothWays {
                    steps: case.result.t_end / step + 0.4,
                    tolerance: match precision {
                        Precision::F64 => 1e-12,
                        Precision::F32 => 1e-5,
                    },
                };
                let (told, over) = with_model(&scene, both).expect("valid case");
                changes += told;
                passed += usize::from(over);
            }
        }
    }
    assert!(changes > 3000 && passed >= 16, "{changes}, {passed}");
}

/// A thousand swings while the spin of the rig is used up, then rolling.
#[test]
fn spin_used_up_over_a_thousand_periods() {
    let mut scene = Scene::load("rig").expect("built-in scene");
    scene.run.duration = 45.0;
    let truth = touchdown_truth::simulate(&scene);
    let units = touchdown_truth::Units::of(&scene);
    for (precision, targets) in [
        (Precision::F64, [1e-10, 1e-11, 1e-11]),
        (Precision::F32, [2e-3, 1e-4, 1e-4]),
    ] {
        scene.model.precision = precision;
        let history = simulate(&scene).expect("valid scene");
        assert_eq!(history.rolling_starts.len(), truth.rolling_starts.len());
        let rolls = (history.rolling_starts[0] - truth.rolling_starts[0]).abs() / units.time;
        let (found, want) = (&history.end, &truth.end);
        let position = distance(found.position, want.position) / units.length;
        let velocity = distance(found.velocity, want.velocity) / units.speed;
        println!("{precision:?}: rolls {rolls:.1e} T, place {position:.1e}, speed {velocity:.1e}");
        let errors = [rolls, position, velocity];
        assert!(
            errors
                .iter()
                .zip(targets)
                .all(|(&error, target)| error <= target)
        );
        assert_eq!(history.regime, truth.regime);
    }
}

/// From the bottom at 400 rad/s, against the spin, in 13 kHz whirl soon; the reference has no such case in
/// `data/cases`.
#[test]
fn whirl_grows_until_it_rolls() {
    let mut scene = Scene::load("rig").expect("built-in scene");
    let rate = 400.0;
    scene.start = Start::Wall {
        angle: 0.0,
        tangential: -rate * scene.retainer.clearance * scene.rotor.spin.signum(),
    };
    scene.run.duration = 0.045;
    let truth = touchdown_truth::simulate(&scene);
    let unit = (scene.run.gravity * scene.retainer.clearance).sqrt();
    let speed = |history: &History| history.end.velocity[0].hypot(history.end.velocity[1]);
    for precision in PRECISIONS {
        for step in STEPS {
            scene.model.precision = precision;
            scene.model.step = step;
            let history = simulate(&scene).expect("valid scene");
            let fast = (speed(&history) - speed(&truth)).abs() / unit;
            let spin = (history.end.spin / truth.end.spin - 1.0).abs();
            let rolls = (history.rolling_starts[0] - truth.rolling_starts[0]).abs();
            println!(
                "{precision:?} {step:e} s: speed {fast:.1e} V, spin {spin:.1e}, rolls {rolls:.1e} s"
            );
            assert!(fast <= 1e-3 && spin <= 1e-6, "{precision:?} {step:e}");
            assert_eq!(history.regime, truth.regime);
        }
    }
}
