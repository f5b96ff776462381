//! Rung `two-plane`: energy and angular momentum, the ledger, contact in each ring, and the extremes.

use proptest::prelude::*;
use touchdown_models::{ActuatorConfig, Coupled, CoupledConfig, CoupledState, Placement};
use touchdown_rotor::{Change, Precision, Touch};
use touchdown_tests::rotors::{built, ring, rotor, run};

fn cross(a: [f64; 2], b: [f64; 2]) -> f64 {
    a[0] * b[1] - a[1] * b[0]
}

/// About the axis z, per mass: of the centre, of the tilt, and the gyroscopic part -n |psi|^2/2.
fn momentum<R: Precision, const N: usize>(state: &CoupledState<R, N, 2>, nutation: f64) -> f64 {
    let f64s = |(a, b): ([R; 2], [R; 2])| (a.map(R::to_f64), b.map(R::to_f64));
    let (p, v) = f64s(state.centre());
    let (psi, rate) = f64s(state.coordinate(1));
    cross(p, v) + cross(psi, rate) - 0.5 * nutation * (psi[0] * psi[0] + psi[1] * psi[1])
}

/// Largest change of energy (without the spin's) and of angular momentum, and the impacts.
fn swing<R: Precision>(
    config: &CoupledConfig<2>,
    start: &Placement<f64>,
    spin: f64,
    steps: u32,
) -> (f64, f64, u32) {
    let model = Coupled::<R, 2, 2>::try_new(config).expect("valid");
    let mut impacts = 0;
    let mut state = model
        .start(&start.rounded(), R::lit(spin), |_| {})
        .expect("valid start");
    let nutation = config.polar_inertia * spin;
    let energy = |state: &CoupledState<R, 2, 2>| {
        let energy = model.energy(state);
        [energy.motion, energy.height, energy.magnets]
            .map(R::to_f64)
            .iter()
            .sum::<f64>()
    };
    let (first, round) = (energy(&state), momentum(&state, nutation));
    let (mut worst, mut turned) = (0.0_f64, 0.0_f64);
    for _ in 0..steps {
        model.step(&mut state, |it| match it.event.change {
            Change::Impact { .. } => impacts += 1,
            change => panic!("{change:?}"),
        });
        worst = worst.max((energy(&state) - first).abs());
        turned = turned.max((momentum(&state, nutation) - round).abs());
    }
    (worst, turned, impacts)
}

/// No friction, no loss: whatever the step, disc or needle, with magnets and a tumbling rotor.
#[test]
fn energy_and_angular_momentum_are_kept_in_bounces() {
    let start = Placement {
        position: [0.1, 0.2],
        velocity: [0.5, -0.3],
        tilt: [0.1, -0.2],
        tilt_rate: [0.4, 0.6],
    };
    for polar in [2.0, 0.4, 1e-4] {
        for step in [1e-3, 5e-3] {
            let mut config = rotor([ring(1.2), ring(-0.7)], polar, step);
            config.gravity = [0.0; 2];
            for (place, magnet) in [0.9, -0.9].iter().zip(&mut config.magnets) {
                *magnet = ActuatorConfig {
                    place: *place,
                    stiffness: 0.5,
                    force: [0.0; 2], ..ActuatorConfig::default()
                };
            }
            let (energy, turned, impacts) = swing::<f64>(&config, &start, 20.0, 20_000);
            let (single, single_turned, _) = swing::<f32>(&config, &start, 20.0, 20_000);
            println!(
                "{polar} {step}: {impacts} impacts, energy {energy:.1e}, momentum {turned:.1e}; f32 {single:.1e} {single_turned:.1e}"
            );
            assert!(impacts > 10);
            assert!(energy <= 1e-13 && turned <= 1e-13);
            assert!(single <= 1e-4 && single_turned <= 1e-5);
        }
    }
}

#[test]
fn energy_is_kept_under_gravity() {
    let start = Placement {
        tilt: [0.1, -0.2],
        tilt_rate: [0.4, 0.6],
        ..Placement::default()
    };
    let config = rotor([ring(1.2), ring(-0.7)], 0.4, 1e-3);
    let (energy, _, impacts) = swing::<f64>(&config, &start, 20.0, 50_000);
    println!("{impacts} impacts, energy {energy:.1e}");
    assert!(energy <= 1e-13 && impacts > 20, "{energy:e} {impacts}");
}

/// One end held without friction: a pendulum that tilts.
#[test]
fn a_held_ring_does_no_work_without_friction() {
    for (step, polar) in [(1e-3, 0.4), (0.02, 0.4), (1e-3, 2.0)] {
        let mut config = rotor([ring(1.2), ring(-0.7)], polar, step);
        for ring in &mut config.rings {
            ring.restitution = 0.0;
        }
        let start = Placement {
            position: [0.0, -0.9],
            tilt: [0.0, -0.1 / 1.2],
            velocity: [0.3, 0.0],
            ..Placement::default()
        };
        let model = built::<2, 2>(&config);
        let mut starts = [0; 2];
        let mut state = model
            .start(&start, 5.0, |it| starts[it.ring] += 1)
            .expect("valid");
        assert_eq!(starts, [1, 0]);
        let mut last = model.energy(&state);
        let first = last;
        let mut worst = 0.0_f64;
        for _ in 0..(60.0 / step) as u32 {
            model.step(&mut state, |_| {});
            let now = model.energy(&state);
            // Whatever goes is booked, and goes in impacts alone.
            assert!(now.lost >= last.lost - 1e-14);
            worst = worst.max((now.total() - first.total()).abs());
            last = now;
        }
        println!(
            "step {step}: ledger {worst:.1e}, lost {:.3}",
            last.lost - first.lost
        );
        assert!(worst <= 1e-13);
        for k in 0..2 {
            let at = model.kinematics_at(&state, k);
            let beyond = at.position[0].hypot(at.position[1]) - 1.0;
            println!("ring {k}: {:?}, {beyond:.1e}", at.touch);
            assert!(beyond < 1e-12 && (at.touch == Touch::None || beyond > -1e-12));
        }
    }
}

/// Stored + heat + loss, from release to rest, with friction in both rings and a magnet.
#[test]
fn the_ledger_closes() {
    for (spin, friction) in [(-50.0, 0.2), (8.0, 0.5), (300.0, 0.1)] {
        for step in [1e-3, 1e-2] {
            let mut config = rotor([ring(1.2), ring(-0.7)], 0.5, step);
            for ring in &mut config.rings {
                (ring.friction, ring.restitution) = (friction, 0.6);
            }
            config.rings[1].clearance = 0.8;
            config.magnets[0] = ActuatorConfig {
                place: 0.9,
                stiffness: 0.3,
                force: [0.05, 0.1], ..ActuatorConfig::default()
            };
            let start = Placement {
                tilt: [0.1, -0.2],
                ..Placement::default()
            };
            let model = built::<2, 2>(&config);
            let mut state = model.start(&start, spin, |_| {}).expect("valid");
            let first = model.energy(&state);
            let mut worst = 0.0_f64;
            for _ in 0..(60.0 / step) as u32 {
                model.step(&mut state, |_| {});
                let off = model.energy(&state).total() - first.total();
                worst = worst.max(off.abs() / first.total());
            }
            let end = model.energy(&state);
            println!(
                "spin {spin}, step {step}: {worst:.1e}; heat {:.3}, lost {:.3}, {} shortened",
                end.heat,
                end.lost,
                state.shortened()
            );
            assert!(end.heat > 0.0 && end.lost > 0.0 && state.shortened() == 0);
            assert!(worst <= 1e-12, "{worst:e}");
        }
    }
}

/// What the unbalance gives is booked too.
#[test]
fn the_ledger_closes_with_unbalance() {
    let mut config = rotor([ring(1.2), ring(-0.7)], 0.5, 1e-3);
    for ring in &mut config.rings {
        (ring.friction, ring.restitution) = (0.2, 0.6);
    }
    config.unbalance.eccentricity = 0.02;
    config.unbalance.skew = 0.01;
    let model = built::<2, 2>(&config);
    let mut state = model
        .start(&Placement::default(), 30.0, |_| {})
        .expect("valid");
    let first = model.energy(&state).total();
    for _ in 0..20_000 {
        model.step(&mut state, |_| {});
    }
    let end = model.energy(&state);
    let off = (end.total() - first).abs() / first;
    println!("{off:.1e}; driven {:.3}", end.driven);
    assert!(off <= 1e-12 && end.driven.abs() > 1e-3);
}

/// v' = mu v^2 in one ring at the centre, without gravity: 1/v falls evenly.
#[test]
fn whirl_without_gravity_grows_by_its_law() {
    let off = |step: f64| {
        let mut config = rotor([ring(0.0)], 0.5, step);
        config.gravity = [0.0; 2];
        config.rings[0].friction = 0.1;
        let start = Placement {
            position: [0.0, -1.0],
            velocity: [1.0, 0.0],
            ..Placement::default()
        };
        let state = run(&config, &start, -1e4, 8.0);
        assert_eq!(state.shortened(), 0);
        let [u, v] = state.centre().1;
        u.hypot(v) * (1.0 - 0.8) - 1.0
    };
    let [fine, coarse, long] = [1e-3, 4e-3, 0.4].map(off);
    println!("{fine:+.1e}, {coarse:+.1e}, {long:+.1e}");
    // From 1 to 5 V: 4.5 and 72 steps' squares. The longest step is cut to a quarter of a radian.
    assert!(fine.abs() <= 6e-6 && (coarse / fine - 16.0).abs() < 2.0);
    assert!(long.abs() <= 0.06);
}

/// The end of a slide of a tilted rotor on both walls. With friction the nutation is that of the spin
/// at the step's start, which is of first order in what the spin loses.
#[test]
fn contact_is_of_second_order() {
    let end = |step: f64| {
        let mut config = rotor([ring(1.2), ring(-0.7)], 0.5, step);
        for ring in &mut config.rings {
            (ring.friction, ring.restitution) = (0.0, 0.0);
        }
        // Both on the wall, one end 0.2 rad further round.
        let (a, b) = (
            (0.5_f64.sin(), 0.5_f64.cos()),
            (0.3_f64.sin(), 0.3_f64.cos()),
        );
        let tilt = [(a.0 - b.0) / 1.9, (b.1 - a.1) / 1.9];
        let start = Placement {
            position: [a.0 - 1.2 * tilt[0], -a.1 - 1.2 * tilt[1]],
            tilt,
            ..Placement::default()
        };
        let mut lifted = 0;
        let model = built::<2, 2>(&config);
        let mut state = model.start(&start, -6.0, |_| {}).expect("valid");
        for _ in 0..(1.0 / step).round() as u32 {
            model.step(&mut state, |it| {
                lifted += u32::from(it.event.change == Change::LiftsOff)
            });
        }
        assert_eq!(lifted, 0);
        state.axis_at(&[1.0, 1.2]).0
    };
    let finest = end(1.25e-4);
    let off = |step| {
        let there: [f64; 2] = end(step);
        (there[0] - finest[0]).hypot(there[1] - finest[1])
    };
    let (coarse, fine) = (off(8e-3), off(2e-3));
    println!("{coarse:.2e} {fine:.2e}");
    assert!(coarse / fine > 12.0 && coarse / fine < 20.0);
}

/// Until the first impacts are far, f32 follows f64.
#[test]
fn single_precision_follows_double() {
    let mut config = rotor([ring(1.2), ring(-0.7)], 0.5, 1.8e-3);
    for ring in &mut config.rings {
        (ring.friction, ring.restitution) = (0.1, 0.5);
    }
    let start = Placement {
        tilt: [0.1, -0.2],
        ..Placement::default()
    };
    let model = built::<2, 2>(&config);
    let single = Coupled::<f32, 2, 2>::try_new(&config).expect("valid");
    let mut a = model.start(&start, 40.0, |_| {}).expect("valid");
    let mut b = single
        .start(&start.rounded(), 40.0, |_| {})
        .expect("valid");
    let mut worst = 0.0_f64;
    for tick in 1..=2800 {
        model.step(&mut a, |_| {});
        single.step(&mut b, |_| {});
        for k in 0..2 {
            let (p, q) = (model.kinematics_at(&a, k), single.kinematics_at(&b, k));
            let off = (p.position[0] - f64::from(q.position[0]))
                .hypot(p.position[1] - f64::from(q.position[1]));
            worst = worst.max(off);
        }
        if tick % 700 == 0 {
            println!("{:.1} T: {worst:.1e}", f64::from(tick) * 1.8e-3);
        }
    }
    assert!(worst <= 2e-4, "{worst:e}");
}

#[derive(Clone, Copy, Debug)]
struct Case {
    config: CoupledConfig<3>,
    spin: f64,
    start: Placement<f64>,
}

prop_compose! {
    fn cases()(friction in prop_oneof![Just(0.0), 0.0..2.0_f64, 0.0..100.0_f64],
               restitution in prop_oneof![Just(0.0), Just(1.0), Just(0.99), 0.0..1.0_f64],
               polar in prop_oneof![Just(2.0), 1e-4..2.0_f64, Just(1e-6)],
               spin in prop_oneof![Just(0.0), -20.0..20.0_f64, -5e4..5e4_f64],
               gravity in prop_oneof![Just([0.0, -1.0]), Just([0.0, 0.0]), Just([0.6, 0.8])],
               step in prop_oneof![Just(1.8e-4), Just(1.8e-3), Just(0.018), Just(0.18)],
               places in [-3.0..3.0_f64, -3.0..3.0_f64, -3.0..3.0_f64],
               clearance in prop_oneof![Just(1.0), 0.5..2.0_f64],
               stiffness in -2.0..2.0_f64,
               moves in [-0.2..0.2_f64, -0.2..0.2_f64, -3.0..3.0_f64, -3.0..3.0_f64],
               tilts in [-0.1..0.1_f64, -0.1..0.1_f64, -2.0..2.0_f64, -2.0..2.0_f64])
               -> Case {
        let mut config = rotor(places.map(ring), polar, step);
        for ring in &mut config.rings {
            (ring.friction, ring.restitution, ring.radius) = (friction, restitution, 1.0);
        }
        config.rings[2].clearance = clearance;
        config.gravity = gravity;
        config.magnets[0] = ActuatorConfig { place: 1.0, stiffness, force: [0.0, 0.1], ..ActuatorConfig::default() };
        Case { config, spin, start: Placement {
            position: [moves[0], moves[1]], velocity: [moves[2], moves[3]],
            tilt: [tilts[0], tilts[1]], tilt_rate: [tilts[2], tilts[3]],
        } }
    }
}

/// All stays finite, in the gap and within its energy.
fn check<R: Precision>(case: &Case, steps: u32, rounding: f64) -> Result<(), TestCaseError> {
    let model = Coupled::<R, 3, 2>::try_new(&case.config).expect("valid");
    let Ok(mut state) = model.start(&case.start.rounded(), R::lit(case.spin), |_| {}) else {
        return Ok(());
    };
    let first = model.energy(&state).total().to_f64();
    let size = model.energy(&state).stored().to_f64().abs().max(1.0);
    let mut speeds = [0.0_f64; 3];
    for _ in 0..steps {
        let mut changes = 0;
        model.step(&mut state, |_| changes += 1);
        let energy = model.energy(&state);
        let total = energy.total().to_f64();
        prop_assert!(
            (total - first).abs() <= rounding * size,
            "ledger {first} -> {total}"
        );
        // A rolling ring has no slip at the end of a step, in its mean one of the square of the step.
        let gained = -(energy.heat.to_f64() + energy.lost.to_f64());
        let most = rounding + 0.5 * case.config.step * case.config.step;
        prop_assert!(gained <= most * size, "{gained} gained");
        prop_assert!(changes <= 200, "{changes} changes in a step");
        for (k, ring) in case.config.rings.iter().enumerate() {
            let at = model.kinematics_at(&state, k);
            let [x, y] = at.position.map(R::to_f64);
            let [u, v] = at.velocity.map(R::to_f64);
            let beyond = x.hypot(y) - ring.clearance;
            let speed = u.hypot(v);
            // Beyond its wall until the end of the step that turned it round.
            let path = case.config.step * (speed.max(speeds[k]) + case.config.step);
            speeds[k] = speed;
            prop_assert!(
                beyond <= path + rounding,
                "ring {k}: {beyond} beyond, path {path}"
            );
        }
    }
    Ok(())
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 150, failure_persistence: None,
                                        rng_seed: prop::test_runner::RngSeed::Fixed(1),
                                        ..ProptestConfig::default() })]

    #[test]
    fn extremes_in_f64(case in cases()) {
        check::<f64>(&case, 400, 1e-9)?;
    }

    #[test]
    fn extremes_in_f32(case in cases()) {
        check::<f32>(&case, 400, 1e-3)?;
    }
}
