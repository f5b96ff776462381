//! Stops of a ring that give way: their closed forms, and that they give back what they take.

use touchdown_models::{Coupled, CoupledState, MountConfig, Placement, StopConfig};
use touchdown_tests::mounted::{decades, one, random_drop};
use touchdown_tests::rotors::built;

/// Of the ring, over the rotor's: it is left behind by a rotor that bounces off it.
const HEAVY: f64 = 2.0;
const STIFFNESS: f64 = 18.0;
const STOP: StopConfig = StopConfig { travel: 0.1, stiffness: Some(400.0) };
const MOUNT: MountConfig = MountConfig {
    mass: HEAVY,
    stiffness: STIFFNESS,
    damping: 0.0,
    vertical: None,
    friction: 0.0,
    stop: Some(STOP),
};

fn steps(model: &Coupled<f64, 1, 2>, state: &mut CoupledState<f64, 1, 2>, count: u32) {
    (0..count).for_each(|_| model.step(state, |_| ()));
}

/// On its spring to the stop, on both springs in it, and on its spring back.
#[test]
fn a_struck_ring_leaves_its_stop_as_it_came() {
    let (travel, stop) = (STOP.travel, STOP.stiffness.unwrap());
    let speed = 2.0 / (1.0 + HEAVY);
    let rate = (STIFFNESS / HEAVY).sqrt();
    let inner = ((STIFFNESS + stop) / HEAVY).sqrt();
    let there = (rate * travel / speed).asin() / rate;
    let entered = speed * (rate * there).cos();
    // About the place where both springs balance.
    let middle = stop * travel / (STIFFNESS + stop);
    let within = 2.0 * (std::f64::consts::FRAC_PI_2 - (inner * (travel - middle) / entered).atan()) / inner;
    for (time, name) in [(there + 0.3 * within, "in the stop"), (there + within + 0.1, "after it")] {
        let exact = if time < there + within {
            let (sin, cos) = (inner * (time - there)).sin_cos();
            middle + (travel - middle) * cos + entered / inner * sin
        } else {
            let (sin, cos) = (rate * (time - there - within)).sin_cos();
            travel * cos - entered / rate * sin
        };
        let mut errors = Vec::new();
        for count in [100, 200, 400, 800] {
            let model = built::<1, 2>(&one(MOUNT, time / f64::from(count)));
            let start = Placement { position: [1.0, 0.0], velocity: [1.0, 0.0], ..Placement::default() };
            let mut state = model.start(&start, 0.0, |_| {}).expect("valid");
            let first = model.energy(&state).total();
            steps(&model, &mut state, count);
            let [x, y] = model.ring(&state, 0).position;
            errors.push(f64::hypot(x - exact, y));
            let energy = model.energy(&state);
            assert!((energy.total() - first).abs() < 1e-14, "{energy:?}");
            assert!(energy.stops.abs() < 1e-14, "{energy:?}");
        }
        println!("{name}, at {exact:.4}: off by {errors:?}");
        assert!(errors[3] < 2e-6 && errors[3] < 0.03 * errors[0], "{name}: {errors:?}");
    }
}

/// The rotor's weight on the ring, both at rest: the two springs carry it.
#[test]
fn spring_and_stop_carry_the_weight() {
    let stop = StopConfig { travel: 0.02, ..STOP };
    let mount = MountConfig { damping: 10.0, stop: Some(stop), ..MOUNT };
    let mut config = one(mount, 2e-3);
    config.gravity = [0.0, -1.0];
    config.rings[0].restitution = 0.0;
    let model = built::<1, 2>(&config);
    let start = Placement { position: [0.0, -1.0], ..Placement::default() };
    let mut state = model.start(&start, 0.0, |_| {}).expect("valid");
    steps(&model, &mut state, 10_000);
    let exact = (1.0 + 400.0 * 0.02) / (STIFFNESS + 400.0);
    let [x, y] = model.ring(&state, 0).position;
    println!("at {y} of {}", -exact);
    assert!(x.abs() < 1e-15 && (y + exact).abs() < 1e-13, "{x} {y} {exact}");
}

/// A ring that was struck, and that its dry friction holds: the force of spring and stop is what friction can take.
#[test]
fn dry_friction_holds_a_ring_in_its_stop() {
    let stop = StopConfig { travel: 0.01, stiffness: Some(20.0) };
    let mut in_stop = 0;
    for tenths in 1..30 {
        let friction = 0.1 * f64::from(tenths);
        let mount = MountConfig { friction, stop: Some(stop), ..MOUNT };
        let model = built::<1, 2>(&one(mount, 1e-3));
        let start = Placement { position: [1.0, 0.0], velocity: [1.0, 0.0], ..Placement::default() };
        let mut state = model.start(&start, 0.0, |_| {}).expect("valid");
        let first = model.energy(&state).total();
        steps(&model, &mut state, 1_500);
        let ring = model.ring(&state, 0);
        if ring.velocity != [0.0; 2] {
            continue;
        }
        let x = ring.position[0].abs();
        let force = STIFFNESS * x + 20.0 * (x - 0.01).max(0.0);
        let energy = model.energy(&state);
        assert!(force <= friction, "{friction}: {force}");
        assert!((energy.total() - first).abs() < 1e-14, "{friction}: {energy:?}");
        let stored = 0.5 * (STIFFNESS * x * x + 20.0 * (x - 0.01).max(0.0).powi(2));
        assert!((energy.springs - stored).abs() < 1e-14, "{friction}: {energy:?}");
        in_stop += usize::from(x > 0.01 && STIFFNESS * x < friction);
    }
    println!("{in_stop} held in the stop");
    assert!(in_stop > 10);
}

/// Rotors that fall, bounce and rub in a ring that goes into its stop, with dry friction or not, by steps that are too long
/// for it.
#[test]
fn stops_that_give_way_keep_the_energy() {
    let mut deepest: f64 = 0.0;
    for seed in 0..300 {
        let mut travel = 0.0;
        let (model, mut state) = random_drop(seed, |mount, random| {
            let stop = mount.stop.as_mut().expect("a stop");
            stop.stiffness = Some(decades(random, -1.0, 6.0));
            travel = stop.travel;
            if seed % 2 == 0 {
                mount.friction = 0.0;
            }
        });
        let first = model.energy(&state).total();
        for _ in 0..2_000 {
            model.step(&mut state, |_| ());
            let energy = model.energy(&state);
            let account = energy.total() - first;
            assert!(account.abs() < 1e-9, "{seed}: account {account:e}");
            assert!(energy.stops.abs() < 1e-9, "{seed}: the stop took {:e}", energy.stops);
            let [x, y] = model.ring(&state, 0).position;
            deepest = deepest.max(f64::hypot(x, y) / travel - 1.0);
        }
        assert_eq!(state.shortened(), 0, "{seed}");
    }
    println!("deepest {deepest:.2} of the travel");
    assert!(deepest > 0.1);
}
