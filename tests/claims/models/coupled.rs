//! Rung `coupled`: what it keeps, what it is in the cases of the other rungs, its order, and the extremes.

use touchdown_lab::limits::machine;
use touchdown_models::{
    ActuatorConfig, Coupled, CoupledConfig, CoupledState, ModeConfig, MountConfig, Placement, StopConfig,
    RaceConfig,
};
use touchdown_rotor::{Change, Precision, Touch};
use touchdown_run::model::coupled::watch;
use touchdown_scene::Scene;
use touchdown_tests::rotors::{built, ring, rotor};

fn mode(speed: f64, damping_ratio: f64, mass: f64) -> ModeConfig {
    ModeConfig {
        speed,
        damping_ratio,
        mass,
        centre: -0.6,
    }
}

fn mount(mass: f64, stiffness: f64, damping: f64, travel: Option<f64>) -> Option<MountConfig> {
    Some(MountConfig {
        mass,
        stiffness,
        damping,
        vertical: None,
        friction: 0.0,
        stop: travel.map(StopConfig::rigid),
    })
}

fn race(inertia: f64, dry_drag: f64, viscous_drag: f64) -> Option<RaceConfig> {
    Some(RaceConfig {
        inertia,
        dry_drag,
        viscous_drag,
        cage_ratio: 0.4,
        heat_capacity: 1.0,
        heat_loss: 0.1,
    })
}

/// Two ends on springs, one bending mode.
fn two_ends(step: f64) -> CoupledConfig<2> {
    let mut rings = [ring(1.2), ring(-0.7)];
    for (ring, shape) in rings.iter_mut().zip([0.8, 1.1]) {
        ring.shape[0] = shape;
        ring.mount = mount(0.05, 40.0, 0.0, None);
    }
    let mut config = rotor(rings, 0.4, step);
    config.modes[0] = Some(mode(25.0, 0.0, 0.7));
    config
}

const TILTED: Placement<f64> = Placement {
    position: [0.1, 0.2],
    velocity: [0.5, -0.3],
    tilt: [0.1, -0.2],
    tilt_rate: [0.4, 0.6],
};

fn cross(a: [f64; 2], b: [f64; 2]) -> f64 {
    a[0] * b[1] - a[1] * b[0]
}

/// No friction, no loss: springs, bending, gyroscopic effect and magnets keep energy and angular momentum in
/// impacts between them.
#[test]
fn energy_and_angular_momentum_are_kept_in_bounces() {
    for (step, sprung) in [(2e-3, true), (2e-3, false), (1e-2, false)] {
        let mut config = two_ends(step);
        if !sprung {
            for ring in &mut config.rings {
                ring.mount = None;
            }
        }
        config.gravity = [0.0; 2];
        for (magnet, place) in config.magnets.iter_mut().zip([0.9, -0.9]) {
            magnet.place = place;
            magnet.stiffness = 0.5;
            magnet.shape[0] = 0.3;
        }
        let model = built::<2, 3>(&config);
        let mut impacts = 0;
        let mut state = model.start(&TILTED, 20.0, |_| {}).expect("valid start");
        let momentum = |state: &CoupledState<f64, 2, 3>| {
            let mut sum = 0.0;
            for k in 0..3 {
                let (x, v) = state.coordinate(k);
                sum += cross(x, v);
            }
            for ring in 0..2 {
                let ring = model.ring(state, ring);
                sum += 0.05 * cross(ring.position, ring.velocity);
            }
            let tilt = state.coordinate(1).0;
            sum - 0.5 * 0.4 * 20.0 * (tilt[0] * tilt[0] + tilt[1] * tilt[1])
        };
        let (first, round) = (model.energy(&state).stored(), momentum(&state));
        let (mut worst, mut turned, mut deepest) = (0.0_f64, 0.0_f64, 0.0_f64);
        for _ in 0..10_000 {
            model.step(&mut state, |it| match it.event.change {
                Change::Impact { impulse, .. } => {
                    assert!(impulse > 0.0);
                    impacts += 1;
                }
                change => panic!("{change:?}"),
            });
            worst = worst.max((model.energy(&state).total() - first).abs());
            let taken = model.energy(&state).mounts;
            assert!((-1e-12..1e-4 * first).contains(&taken), "{taken:e}");
            turned = turned.max((momentum(&state) - round).abs());
            for ring in 0..2 {
                deepest = deepest.max(model.reach_at(&state, ring) - 1.0);
            }
        }
        println!(
            "{step}: {impacts} impacts, energy {worst:.1e} of {first}, momentum {turned:.1e}, {deepest:.1e}"
        );
        assert!(impacts > 10);
        // An impact on a spring that moves in it takes part of the square of the step from the ring.
        let most = if sprung { 1e-6 } else { 1e-11 };
        assert!(worst <= 1e-11 && turned <= most && deepest <= 1e-12);
    }
}

/// In a ring at the centre of mass the tilt stays at rest: one coordinate says what two say, with spring, stop and
/// ball bearing.
#[test]
fn a_ring_at_the_centre_does_not_tilt_the_rotor() {
    for travel in [None, Some(0.15)] {
        let mut seat = ring(0.0);
        (seat.friction, seat.restitution) = (0.15, 0.6);
        seat.mount = mount(0.1, 30.0, 0.8, travel);
        seat.race = race(0.02, 0.001, 0.002);
        let config = rotor([seat], 0.5, 1e-3);
        let (moves, tilts) = (built::<1, 1>(&config), built::<1, 2>(&config));
        let start = Placement {
            velocity: [0.2, 0.0],
            ..Placement::default()
        };
        let (mut one, mut two) = (Vec::new(), Vec::new());
        let mut a = moves.start(&start, 6.0, |_| {}).expect("valid");
        let mut b = tilts.start(&start, 6.0, |_| {}).expect("valid");
        for _ in 0..8000 {
            moves.step(&mut a, |it| one.push(it));
            tilts.step(&mut b, |it| two.push(it));
        }
        assert!(one.len() > 5, "{one:?}");
        assert_eq!(one, two);
        assert_eq!(a.centre(), b.centre());
        assert_eq!(moves.ring(&a, 0), tilts.ring(&b, 0));
        assert_eq!(b.coordinate(1), ([0.0; 2], [0.0; 2]));
        let tilted = Placement {
            tilt: [0.1, 0.0],
            ..start
        };
        assert!(moves.start(&tilted, 6.0, |_| {}).is_err());
    }
}

/// A held rotor on springs that bends: the error falls by the square of the step.
#[test]
fn contact_and_bending_are_of_second_order() {
    let at = |step: f64| {
        let mut config = two_ends(step);
        for ring in &mut config.rings {
            (ring.friction, ring.restitution) = (0.02, 0.0);
            ring.mount = mount(0.1, 60.0, 1.0, None);
            ring.race = race(5.0, 0.0, 0.003);
        }
        config.modes[0] = Some(mode(12.0, 0.05, 0.7));
        let start = Placement {
            position: [0.0, -1.0],
            velocity: [0.3, 0.0],
            ..Placement::default()
        };
        let model = built::<2, 3>(&config);
        let mut state = model.start(&start, 20.0, |_| {}).expect("valid");
        for _ in 0..(2.0 / step).round() as u64 {
            model.step(&mut state, |_| {});
        }
        assert_eq!(model.kinematics_at(&state, 0).touch, Touch::Sliding);
        let ((x, _), (tilt, _), (eta, _)) = (
            state.coordinate(0),
            state.coordinate(1),
            state.coordinate(2),
        );
        [x[0], x[1], tilt[0], tilt[1], eta[0], eta[1], state.spin()]
    };
    let exact = at(1.25e-4);
    let error = |step: f64| {
        let found = at(step);
        let square: f64 = found
            .iter()
            .zip(exact)
            .map(|(a, b)| (a - b) * (a - b))
            .sum();
        square.sqrt()
    };
    let errors = [8e-3, 4e-3, 2e-3].map(error);
    println!("{errors:?}");
    assert!(errors[0] / errors[2] > 10.0, "{errors:?}");
}

/// After an impact the rotor rings: without another one the mode's energy decays as exp(-2 zeta Omega t).
#[test]
fn a_bending_mode_rings_and_decays() {
    let mut config = two_ends(1e-3);
    config.modes[0] = Some(mode(25.0, 0.02, 0.7));
    config.gravity = [0.0; 2];
    for ring in &mut config.rings {
        ring.mount = None;
    }
    let model = built::<2, 3>(&config);
    let start = Placement {
        velocity: [0.5, 0.0],
        ..Placement::default()
    };
    let mut state = model.start(&start, 0.0, |_| {}).expect("valid");
    let mut last = 0;
    let mut energies = Vec::new();
    for step in 0..4000 {
        let mut hit = false;
        model.step(&mut state, |_| hit = true);
        if hit {
            last = step;
            energies.clear();
        }
        let (x, v) = state.coordinate(2);
        energies.push(0.5 * (v[0] * v[0] + 25.0 * 25.0 * x[0] * x[0]));
        // Two periods after the step of the impact.
        if last > 0 && step == last + 504 {
            break;
        }
    }
    let periods = 2.0 * core::f64::consts::TAU / 25.0;
    let steps = (periods / 1e-3).round() as usize;
    let kept = energies[1 + steps] / energies[1];
    let wanted = (-2.0 * 0.02 * 25.0 * periods).exp();
    println!("{last}: {kept} for {wanted}");
    assert!(last > 0 && energies[1] > 1e-3);
    assert!((kept / wanted - 1.0).abs() < 2e-3, "{kept} {wanted}");
}

/// A magnet with damping only takes energy.
#[test]
fn magnets_damp() {
    let mut config = rotor([ring(0.0)], 0.4, 1e-3);
    config.gravity = [0.0; 2];
    config.magnets[0] = ActuatorConfig {
        stiffness: -4.0,
        damping: 0.4,
        ..ActuatorConfig::default()
    };
    let start = Placement {
        position: [0.9, 0.0],
        ..Placement::default()
    };
    let model = built::<1, 2>(&config);
    let mut state = model.start(&start, 0.0, |_| {}).expect("valid");
    let first = model.energy(&state).total();
    for _ in 0..3000 {
        model.step(&mut state, |_| panic!("no contact"));
    }
    // x'' + 0.4 x' + 4 x = 0 after 3 T.
    let speed = (4.0_f64 - 0.04).sqrt();
    let exact = 0.9 * (-0.6_f64).exp() * ((3.0 * speed).cos() + 0.2 / speed * (3.0 * speed).sin());
    assert!((state.centre().0[0] - exact).abs() < 2e-6);
    assert!((model.energy(&state).total() - first).abs() < 1e-13);
}

/// A seeded stream of numbers from 0 to 1 (SplitMix64).
struct Draw(u64);

impl Draw {
    fn part(&mut self) -> f64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        (z ^ (z >> 31)) as f64 / u64::MAX as f64
    }

    fn between(&mut self, low: f64, high: f64) -> f64 {
        low + (high - low) * self.part()
    }

    fn decades(&mut self, low: f64, high: f64) -> f64 {
        10.0_f64.powf(self.between(low, high))
    }

    fn yes(&mut self) -> bool {
        self.part() < 0.5
    }
}

fn random(draw: &mut Draw) -> CoupledConfig<3> {
    let step = draw.decades(-4.0, -1.5);
    let places = [1.0, -1.0, 0.2].map(|at| at * draw.between(0.1, 2.0));
    let mut config = rotor(places.map(ring), draw.between(0.01, 2.0), step);
    for ring in &mut config.rings {
        ring.clearance = draw.between(0.5, 2.0);
        ring.radius = draw.between(0.5, 2.0);
        ring.friction = if draw.yes() {
            draw.between(0.0, 0.4)
        } else {
            draw.decades(-2.0, 2.0)
        };
        ring.restitution = draw.part();
        if draw.yes() {
            let travel = draw.yes().then(|| draw.between(0.05, 0.5));
            ring.mount = mount(
                draw.decades(-4.0, 1.0),
                draw.decades(0.0, 5.0),
                draw.decades(-2.0, 2.0),
                travel,
            );
        }
        if draw.yes() {
            ring.race = race(draw.decades(-5.0, 1.0), 0.0, draw.decades(-4.0, -1.0));
        }
        ring.shape = [(); 3].map(|()| draw.between(-1.5, 1.5));
    }
    if draw.yes() {
        config.modes[0] = Some(mode(
            draw.decades(0.5, 3.0),
            draw.between(0.0, 0.1),
            draw.between(0.2, 2.0),
        ));
    }
    if draw.yes() {
        config.magnets[0] = ActuatorConfig {
            place: draw.between(-1.0, 1.0),
            stiffness: draw.between(-5.0, 1.0),
            damping: draw.between(0.0, 2.0),
            ..ActuatorConfig::default()
        };
    }
    config
}

/// Farthest beyond a wall, greatest gain of stored energy and of the account, over the energy at the start.
fn extremes<R: Precision>(config: &CoupledConfig<3>, spin: f64) -> Option<[f64; 3]> {
    let model = Coupled::<R, 3, 3>::try_new(config).ok()?;
    let start = Placement {
        velocity: [0.3, -0.2],
        tilt_rate: [0.1, 0.2],
        ..Placement::default()
    };
    let mut state = model
        .start(&start.rounded(), R::lit(spin), |_| {})
        .expect("valid");
    let first = model.energy(&state).to_f64();
    let size = first.motion + first.spin + 3.0;
    let mut worst = [0.0_f64; 3];
    let mut least = first.stored();
    for _ in 0..(6.0 / config.step).min(4000.0) as u32 {
        model.step(&mut state, |_| {});
        let energy = model.energy(&state).to_f64();
        assert!(energy.stored().is_finite());
        least = least.min(energy.stored());
        for ring in 0..3 {
            worst[0] = worst[0].max(model.reach_at(&state, ring).to_f64() - 1.0);
        }
        worst[1] = worst[1].max((energy.stored() - least) / size);
        worst[2] = worst[2].max((energy.total() - first.total()).abs() / size);
    }
    Some(worst)
}

#[test]
fn five_hundred_machines_neither_gain_energy_nor_leave_their_gaps() {
    let mut draw = Draw(1);
    let (mut most, mut run) = ([[0.0_f64; 3]; 2], 0);
    for index in 0..500 {
        let config = random(&mut draw);
        let spin = draw.between(-1.0, 1.0) * draw.decades(0.0, 2.0);
        let found = [
            extremes::<f64>(&config, spin),
            extremes::<f32>(&config, spin),
        ];
        for (most, found) in most.iter_mut().zip(found) {
            let Some(found) = found else {
                continue;
            };
            run += 1;
            if found[0] > 0.05 || found[1] > 0.01 || found[2] > 1e-3 {
                println!("machine {index}: {found:?}, step {}", config.step);
            }
            for (most, found) in most.iter_mut().zip(found) {
                *most = most.max(found);
            }
        }
    }
    println!("{run} runs: beyond, gained, account: {most:?}");
    assert!(run > 900);
    assert!(
        most[0][0] < 0.1 && most[0][1] < 0.02 && most[0][2] < 1e-9,
        "{most:?}"
    );
    assert!(
        most[1][0] < 0.1 && most[1][1] < 0.02 && most[1][2] < 1e-2,
        "{most:?}"
    );
}

/// Their whirl on both walls presses by less than the rounding of its path, at the normals that a stretch begins with: the
/// walls opened and closed in turn for ever, and stretches became so short that an impulse was infinite.
#[test]
fn two_ends_that_whirl_on_their_walls_stay_finite_in_f32() {
    for number in [1504, 688] {
        let mut scene = Scene::parse("machine", &machine(number)).expect("a valid scene");
        scene.model.precision = touchdown_scene::Precision::F32;
        let mut whirls = 0.0_f64;
        watch(&scene, &mut |view| {
            assert!(view.energy.total().is_finite(), "machine {number}");
            whirls = whirls.max(view.energy.motion / view.energy.spin);
        })
        .expect("a valid scene");
        assert!(whirls > 1.0, "machine {number}: {whirls}");
    }
}

/// A ring without mount and bearing is one that a hard spring holds, and that does not turn.
#[test]
fn absent_parts_are_those_that_do_not_move() {
    let at = |stiff: bool| {
        let mut config = rotor([ring(1.2), ring(-0.7)], 0.4, 1e-3);
        for ring in &mut config.rings {
            (ring.friction, ring.restitution) = (0.1, 0.5);
            if stiff {
                ring.mount = mount(1.0, 1e12, 0.0, None);
                ring.race = race(1e9, 0.0, 0.0);
            }
        }
        config.modes[0] = stiff.then(|| ModeConfig {
            centre: 0.0,
            ..mode(30.0, 0.0, 1.0)
        });
        let model = built::<2, 3>(&config);
        let mut state = model.start(&TILTED, 5.0, |_| {}).expect("valid");
        for _ in 0..2000 {
            model.step(&mut state, |_| {});
        }
        state.centre().0
    };
    let (a, b) = (at(false), at(true));
    assert!((a[0] - b[0]).hypot(a[1] - b[1]) < 1e-5, "{a:?} {b:?}");
}
