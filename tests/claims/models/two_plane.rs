//! Rung `two-plane`: in flight and in impacts against closed forms, and the plane as its special case.

use std::f64::consts::TAU;

use touchdown_base::history::Recorder;
use touchdown_models::{ActuatorConfig, Coupled, CoupledConfig, Placement, RingEvent};
use touchdown_rotor::Change;
use touchdown_rotor::error::ConfigError;
use touchdown_run::model::simulate;
use touchdown_scene::{Fidelity, Scene, Scheme};
use touchdown_tests::rotors::{built, ring, rotor, run};
use touchdown_truth::reference::Reference;

fn distance(a: [f64; 2], b: [f64; 2]) -> f64 {
    (a[0] - b[0]).hypot(a[1] - b[1])
}

fn turned(angle: f64) -> [f64; 2] {
    [angle.cos(), angle.sin()]
}

/// A scene's rotor in one ring at its centre of mass, as in the plane.
fn of_scene(scene: &Scene, step: f64) -> Coupled<f64, 1, 2> {
    let retainer = scene.retainer;
    let mut config = rotor([ring(0.0)], 1.0, step);
    config.mass = scene.rotor.mass;
    config.polar_inertia = scene.rotor.polar_inertia;
    config.transverse_inertia = scene.rotor.polar_inertia;
    config.rings[0].clearance = retainer.clearance;
    config.rings[0].radius = scene.rotor.radius;
    config.rings[0].friction = retainer.friction;
    config.rings[0].restitution = retainer.restitution;
    config.gravity = [0.0, -scene.run.gravity];
    built(&config)
}

/// Both ends fall alike: one ring in the plane, through bounces, sliding and rolling. One case is short of 1e-12: at long
/// arms without friction a round wall throws ends that are apart sideways farther apart, and solving
/// both ends at once leaves them apart by a last digit.
#[test]
fn a_symmetric_drop_is_the_drop_in_the_plane() {
    for place in [0.2, 0.5, 1.0, 3f64.sqrt(), 3.0] {
        for (friction, spin) in [(0.1, -1390.0), (0.3, -20.0), (0.0, 50.0)] {
            let like = |place| {
                let mut ring = ring(place);
                (ring.friction, ring.restitution) = (friction, 0.8);
                ring.radius = 80.0;
                ring
            };
            let mut one = rotor([like(0.0)], 1.0, 1.8e-3);
            one.polar_inertia = 3200.0;
            one.transverse_inertia = 1e4;
            let mut two = rotor([like(100.0 * place), like(-100.0 * place)], 1.0, 1.8e-3);
            (two.polar_inertia, two.transverse_inertia) = (3200.0, 1e4);
            let start = Placement {
                position: [0.02, 0.0],
                ..Placement::default()
            };
            let (one, two) = (built::<1, 2>(&one), built::<2, 2>(&two));
            let mut plane = one.start(&start, spin, |_| {}).expect("valid");
            let mut space = two.start(&start, spin, |_| {}).expect("valid");
            let (mut worst, mut tilt) = (0.0_f64, 0.0_f64);
            // Contact begins after 10 T. Friction drives the tilt of rings that are close together.
            let steps = if place < 1.0 { 9_000 } else { 20_000 };
            for _ in 0..steps {
                one.step(&mut plane, |_| {});
                two.step(&mut space, |_| {});
                worst = worst.max(distance(plane.centre().0, space.centre().0));
                worst = worst.max((plane.spin() - space.spin()).abs() / spin.abs());
                tilt = tilt.max(distance(space.coordinate(1).0, [0.0; 2]));
            }
            let a = one.kinematics_at(&plane, 0);
            let b = two.kinematics_at(&space, 1);
            println!(
                "zeta {place}, mu {friction}: {worst:.1e}, tilt {tilt:.1e} {:?}",
                a.touch
            );
            assert_eq!(a.touch, b.touch);
            let most = match (place, friction) {
                (3.0, 0.0) => 1e-10,
                _ => 1e-12,
            };
            assert!(
                worst <= most && tilt <= most,
                "{place}: {worst:e} {tilt:e}"
            );
        }
    }
}

/// Impacts against the independent reference: second order and better, where `moreau` is of first.
#[test]
fn drops_of_the_plane_converge_to_the_reference() {
    for name in ["rig", "rig-wide-gap", "rolling"] {
        let scene = Scene::load(name).expect("built-in scene");
        let mut recorder = Recorder::new(-scene.first_sample_time());
        let mut reference = Reference::new(&scene.machine(), &scene.start, scene.rotor.spin);
        let end = reference.advance(scene.run.duration, &mut |h| recorder.take(h));
        let truth = recorder.finish(end, reference.still_speed());
        let unit = (scene.retainer.clearance / scene.run.gravity).sqrt();
        let mut errors = Vec::new();
        for step in [1e-5, 1e-4] {
            let model = of_scene(&scene, step);
            let [x, y] = match scene.start {
                touchdown_scene::Start::Free { position, .. } => position,
                _ => panic!("free start"),
            };
            let start = Placement {
                position: [x / scene.retainer.clearance, y / scene.retainer.clearance],
                ..Placement::default()
            };
            let spin = scene.rotor.spin / model.scales().spin;
            let mut times = Vec::new();
            let mut contact = None;
            let mut keep = |RingEvent { event: h, .. }: RingEvent<f64>| {
                let time = (h.at.tick as f64 + h.at.fraction) * step;
                match h.change {
                    Change::Impact { .. } => times.push(time),
                    Change::ContactStarts if contact.is_none() => contact = Some(time),
                    _ => {}
                }
            };
            let mut state = model.start(&start, spin, &mut keep).expect("valid");
            for _ in 0..(scene.run.duration / step).round() as u64 {
                model.step(&mut state, &mut keep);
            }
            let error = |k: usize| (times[k] - truth.impacts[k].state.time).abs() / unit;
            let mut moreau = scene.clone();
            (moreau.model.rung, moreau.model.scheme) = (Fidelity::Moreau, Scheme::Midpoint);
            moreau.model.step = step;
            let stepped = simulate(&moreau).expect("valid");
            let other = (times[0] - stepped.impacts[0].state.time).abs();
            let late = contact.expect("contact") - truth.contact_starts[0];
            println!(
                "{name} {step}: {:.1e} {:.1e} {:.1e} T; moreau {other:.1e} s; contact {late:+.1e} s",
                error(0),
                error(2),
                error(9)
            );
            assert!(other <= step && late.abs() <= 8.0 * step, "{name}");
            errors.push(error(9));
        }
        assert!(errors[0] <= 5e-9 && errors[1] <= 5e-6, "{name} {errors:?}");
    }
}

/// Forward nutation at (J_p/J_t) w: the midpoint rule turns by 2 atan(n h/2), slow by (n h)^2/12.
#[test]
fn free_tilt_nutates_at_the_gyroscopic_rate() {
    for polar in [2.0, 0.3, 1e-3] {
        let (spin, step) = (50.0, 1e-4);
        let mut config = rotor([ring(1.0)], polar, step);
        config.gravity = [0.0; 2];
        let start = Placement {
            tilt_rate: [0.1 * polar * spin, 0.0],
            ..Placement::default()
        };
        let state = run(&config, &start, spin, 1.0);
        let nutation = polar * spin;
        // psi = psi'(0) (exp(i n t) - 1)/(i n).
        let [cos, sin] = turned(nutation);
        let want = [0.1 * sin, 0.1 * (1.0 - cos)];
        let off = distance(state.coordinate(1).0, want);
        let bound = 0.1 * nutation * (nutation * step).powi(2) / 12.0;
        println!("J_p/J_t {polar}: {off:.1e} of {bound:.1e}");
        assert!(off <= 1.2 * bound + 1e-12, "{polar}: {off:e}");
    }
}

/// Two springs of 4 at +-1.5: p' = 8, tilt 18. Conical modes n/2 +- sqrt((n/2)^2 + 18).
#[test]
fn magnets_that_hold_split_the_conical_modes() {
    for spin in [0.0, 5.0, 40.0] {
        let (polar, step) = (0.6, 1e-4);
        let mut config = rotor([ring(1.5)], polar, step);
        config.gravity = [0.0; 2];
        for (magnet, place) in config.magnets.iter_mut().zip([1.5, -1.5]) {
            *magnet = ActuatorConfig { place, stiffness: -4.0, ..ActuatorConfig::default() };
        }
        let half = 0.5 * polar * spin;
        let root = (half * half + 18.0_f64).sqrt();
        for mode in [half + root, half - root] {
            let start = Placement {
                position: [0.3, 0.0],
                tilt: [0.1, 0.0],
                tilt_rate: [0.0, 0.1 * mode],
                ..Placement::default()
            };
            let state = run(&config, &start, spin, 3.0);
            let tilt = turned(3.0 * mode).map(|x| 0.1 * x);
            let off = distance(state.coordinate(1).0, tilt);
            let swing = (state.centre().0[0] - 0.3 * (3.0 * 8f64.sqrt()).cos()).abs();
            println!("spin {spin}: mode {mode:.3}, {off:.1e}; in the plane {swing:.1e}");
            // (mode h)^2/12 of the phase each.
            let bound = 0.1 * 3.0 * mode.abs() * (half + root).powi(2) * step * step / 6.0;
            assert!(
                off <= bound + 1e-9 && swing <= 1e-7,
                "{spin}: {off:e} {swing:e}"
            );
        }
    }
}

/// A magnet that pulls the rotor off, and a constant force: p = a (cosh(s t) - 1)/s^2.
#[test]
fn magnets_that_pull_and_push_follow_their_closed_form() {
    let mut config = rotor([ring(0.0)], 0.5, 1e-4);
    config.magnets[0] = ActuatorConfig {
        place: 0.0,
        stiffness: 2.0,
        force: [0.3, 0.1], ..ActuatorConfig::default()
    };
    let state = run(&config, &Placement::default(), 3.0, 0.8);
    let grown = ((0.8 * 2f64.sqrt()).cosh() - 1.0) / 2.0;
    let want = [0.3 * grown, -0.9 * grown];
    assert!(
        distance(state.centre().0, want) < 1e-8,
        "{:?}",
        state.centre()
    );
}

/// p = p0 + g t^2/2 - e (exp(i (w t + d)) - exp(i d) (1 + i w t)), and the couple likewise in psi.
#[test]
fn unbalance_in_flight_follows_its_closed_form() {
    let (spin, step, time) = (8.0, 1e-4, 0.7);
    let mut config = rotor([ring(0.0)], 0.4, step);
    config.unbalance.eccentricity = 0.02;
    config.unbalance.angle = 0.5;
    config.unbalance.skew = 0.03;
    config.unbalance.skew_angle = -1.0;
    let state = run(&config, &Placement::default(), spin, time);
    let wt = spin * time;
    let (a, b) = (turned(wt + 0.5), turned(0.5));
    let want = [
        -0.02 * (a[0] - b[0] + wt * b[1]),
        -0.5 * time * time - 0.02 * (a[1] - b[1] - wt * b[0]),
    ];
    let off = distance(state.centre().0, want);
    // psi'' = i n psi' + (1 - g) chi w^2 exp(i (w t + c)), n = g w, from rest:
    // psi = -size exp(i c) ((exp(i w t) - 1)/w - (exp(i n t) - 1)/n).
    let nutation = 0.4 * spin;
    let size = 0.6 * 0.03 * spin * spin / (spin - nutation);
    let part = |rate: f64| {
        let [cos, sin] = turned(rate * time);
        [(1.0 - cos) / rate, -sin / rate]
    };
    let (fast, slow) = (part(spin), part(nutation));
    let sum = [fast[0] - slow[0], fast[1] - slow[1]];
    let [cos, sin] = turned(-1.0);
    let tilt = [
        size * (sum[0] * cos - sum[1] * sin),
        size * (sum[0] * sin + sum[1] * cos),
    ];
    let skew = distance(state.coordinate(1).0, tilt);
    println!("static {off:.1e}, couple {skew:.1e}");
    assert!(
        off < 1e-8 && skew < 1e-8,
        "{off:e} {skew:e}: {tilt:?} {:?}",
        state.coordinate(1).0
    );
}

/// One end high, one low: each lands at sqrt(2 (1 - drop)), off the centre of mass.
#[test]
fn tilted_ends_land_at_their_times() {
    for (tilt, near, far) in [(0.3, 0.7, 1.8), (-0.2, 1.2, 0.4), (0.05, 2.0, 2.0)] {
        let mut config = rotor([ring(near), ring(-far)], 0.4, 1e-3);
        config.rings[0].restitution = 0.0;
        config.rings[1].clearance = 1.3;
        let model = built::<2, 2>(&config);
        let start = Placement {
            tilt: [0.0, tilt],
            ..Placement::default()
        };
        let want = [
            (2.0 * (1.0 + tilt * near)).sqrt(),
            (2.0 * (1.3 - tilt * far)).sqrt(),
        ];
        let first = if want[0] < want[1] { 0 } else { 1 };
        let mut landed = None;
        let mut keep = |RingEvent { ring, event: h }: RingEvent<f64>| {
            if let (Change::Impact { .. }, None) = (h.change, landed) {
                landed = Some((ring, (h.at.tick as f64 + h.at.fraction) * 1e-3));
            }
        };
        let mut state = model.start(&start, 0.0, &mut keep).expect("valid");
        for _ in 0..2500 {
            model.step(&mut state, &mut keep);
        }
        let (ring, time) = landed.expect("lands");
        println!("tilt {tilt}: ring {ring}, {:+.1e} T", time - want[first]);
        assert_eq!(ring, first);
        // The crossing is that of a parabola through |q|^2, exact but for the step's third power.
        assert!((time - want[first]).abs() < 1e-9, "{time} {want:?}");
    }
}

/// An impact changes the velocity at zeta' by (1 + zeta zeta')/(1 + zeta^2) of its own end's: the centre
/// of percussion at -1/zeta does not feel it.
#[test]
fn an_impact_reaches_the_other_end_by_its_mobility() {
    for zeta in [0.5, 1.0, 2.5] {
        let mut config = rotor([ring(zeta)], 0.4, 1e-3);
        config.gravity = [0.0; 2];
        config.rings[0].restitution = 0.7;
        let start = Placement {
            position: [0.0, -0.5],
            velocity: [0.0, -0.6],
            tilt_rate: [0.0, -0.2],
            ..Placement::default()
        };
        let state = run(&config, &start, 0.0, 1.0);
        let before = |place: f64| -0.6 - 0.2 * place;
        for place in [zeta, 0.0, -1.0 / zeta, -zeta] {
            let gained = -1.7 * before(zeta) * (1.0 + zeta * place) / (1.0 + zeta * zeta);
            let now = state.axis_at(&[1.0, place]).1[1];
            assert!(
                (now - before(place) - gained).abs() < 1e-14,
                "{zeta} {place}"
            );
        }
        let other = state.axis_at(&[1.0, -1.0 / zeta]).1[1];
        assert!((other - before(-1.0 / zeta)).abs() < 1e-14);
    }
}

/// A vertical machine does not fall: it drifts, bounces and keeps going.
#[test]
fn a_vertical_rotor_drifts() {
    let mut config = rotor([ring(1.0), ring(-1.0)], 0.4, 1e-3);
    config.gravity = [0.0; 2];
    let start = Placement {
        velocity: [0.3, 0.1],
        ..Placement::default()
    };
    let state = run(&config, &start, 0.0, 2.0);
    assert!(distance(state.centre().0, [0.6, 0.2]) < 1e-12);
    let later = run(&config, &start, 0.0, 200.0);
    let [u, v] = later.centre().1;
    assert!((u.hypot(v) - 0.1_f64.sqrt()).abs() < 1e-12);
}

#[test]
fn bad_values_are_refused_by_name() {
    let good = rotor([ring(1.0), ring(-1.0)], 0.4, 1e-3);
    let name = |change: fn(&mut CoupledConfig<2>)| {
        let mut config = good;
        change(&mut config);
        let error: ConfigError = Coupled::<f64, 2, 2>::try_new(&config).expect_err("refused");
        error.parameter()
    };
    assert_eq!(name(|c| c.mass = 0.0), "mass");
    assert_eq!(name(|c| c.polar_inertia = 2.1), "polar_inertia");
    assert_eq!(
        name(|c| c.transverse_inertia = f64::NAN),
        "transverse_inertia"
    );
    assert_eq!(name(|c| c.rings[1].clearance = -1.0), "clearance");
    assert_eq!(name(|c| c.rings[1].restitution = 1.1), "restitution");
    assert_eq!(name(|c| c.rings[0].place = f64::INFINITY), "place");
    assert_eq!(name(|c| c.gravity[0] = f64::NAN), "gravity");
    assert_eq!(name(|c| c.unbalance.skew = f64::NAN), "unbalance");
    assert_eq!(name(|c| c.magnets[1].force[0] = f64::NAN), "magnets");
    assert_eq!(name(|c| c.magnets[1].stiffness = 2e6), "step");
    let model = built::<2, 2>(&good);
    let outside = Placement {
        position: [0.0, 0.9],
        tilt: [0.0, 0.2],
        ..Placement::default()
    };
    assert!(model.start(&outside, 0.0, |_| {}).is_err());
    assert!(
        model
            .start(&Placement::default(), f64::NAN, |_| {})
            .is_err()
    );
    assert!(Coupled::<f64, 0, 2>::try_new(&rotor([], 0.4, 1e-3)).is_err());
    assert!(Coupled::<f64, 5, 2>::try_new(&rotor([ring(0.0); 5], 0.4, 1e-3)).is_err());
}

#[test]
fn the_spin_angle_keeps_its_phase() {
    let config = rotor([ring(0.0)], 0.4, 1e-3);
    let state = run(&config, &Placement::default(), 300.0, 1.0);
    let want = 300.0_f64.rem_euclid(TAU);
    assert!((state.angle() - want).abs() < 1e-10);
}
