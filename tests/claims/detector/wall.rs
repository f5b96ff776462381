//! A wall or a zero that has moved since the commissioning check is told; one that has not is not.

use std::f64::consts::TAU;

use rayon::prelude::*;
use touchdown_core::event::{Notice, Plane};
use touchdown_core::health::FaultKind;
use touchdown_core::monitor::{Monitor, MonitorConfig, MonitorState};
use touchdown_core::sample::{Sample, TACHOMETERS};
use touchdown_core::sensing::Calibration;
use touchdown_tests::told_machine::config;
use touchdown_tests::plant::{Chain, Disturbance, Machine, Phase, Plant, Rng};

const RATE: f64 = 20_000.0;
/// Of each kind, where `TOUCHDOWN_RUNS` does not say how many.
const RUNS: u64 = 60;

/// What has changed, as parts of the told clearance.
#[derive(Clone, Copy)]
struct Change {
    wall: f64,
    zero: [f64; 2],
}

const NONE: Change = Change {
    wall: 0.0,
    zero: [0.0; 2],
};

fn machine(rng: &mut Rng) -> Machine {
    let gap = rng.uniform(1e-4, 5e-4);
    Machine {
        gap,
        restitution: rng.uniform(0.3, 0.8),
        friction: rng.uniform(0.05, 0.2),
        spin: rng.uniform(-300.0, 300.0),
        orbit: rng.uniform(0.0, 0.02) * gap,
        ..Machine::default()
    }
}

fn with_record(machine: &Machine, is_checked: bool) -> MonitorConfig {
    let mut config = config(machine, machine.gap, RATE);
    config.sensing.calibration = is_checked.then(Calibration::default);
    config
}

/// The planes that are told to have moved, of sensors that are told within 1 % of zero and gain but for the change.
fn told(rng: &mut Rng, config: &MonitorConfig, machine: &Machine, change: Change, phases: &[Phase]) -> Vec<Plane> {
    let mut chain = Chain::new(rng.next_u64(), RATE);
    let micro = machine.gap * 1e6;
    let mut error = || rng.uniform(-0.01, 0.01);
    chain.zero = [0, 1].map(|_| change.zero.map(|zero| micro * (zero + error())));
    chain.gain_error = [0, 1].map(|_| error());
    chain.noise = rng.uniform(0.3, 1.5);
    let there = Machine {
        gap: machine.gap * (1.0 + change.wall),
        ..machine.clone()
    };
    let monitor = Monitor::try_new(config).expect("valid");
    let mut state = MonitorState::default();
    let mut plant = Plant::new(&there, phases);
    let mut planes = Vec::new();
    while let Some(truth) = plant.next_sample(RATE) {
        let sample = Sample {
            counts: chain.counts(truth.place),
            valid: 0b1111,
            spin: Some(machine.spin as f32),
            levitated: None,
            edges: [None; TACHOMETERS],
        };
        for notice in &monitor.update(&mut state, &sample) {
            if let Notice::Declared(event) = notice
                && event.fault.is_some_and(|it| it.kind == FaultKind::Moved)
            {
                planes.push(event.plane);
            }
        }
    }
    planes
}

/// Lies since power-on, or comes to rest after a drop.
fn rest(rng: &mut Rng) -> Vec<Phase> {
    if rng.next_u64().is_multiple_of(2) {
        return vec![Phase::Rest { time: 1.0 }];
    }
    let disturbances = Vec::new();
    vec![Phase::Float { time: 0.4, disturbances }, Phase::Drop { time: 2.0 }]
}

/// Knocks that carry the rotor to the wall on one side while the magnets hold.
fn knocks(rng: &mut Rng, side: f64) -> Vec<Phase> {
    let knock = |number: u32| {
        let angle = side + rng.uniform(-0.3, 0.3);
        let strength = rng.uniform(80.0, 250.0);
        Disturbance::Shock {
            at: 0.4 + 0.1 * f64::from(number),
            duration: rng.uniform(2e-3, 5e-3),
            acceleration: [strength * angle.cos(), strength * angle.sin()],
        }
    };
    let disturbances = (0..8).map(knock).collect();
    vec![Phase::Float { time: 1.3, disturbances }]
}

fn all() -> u64 {
    let asked = std::env::var("TOUCHDOWN_RUNS").ok();
    asked.map_or(RUNS, |it| it.parse().expect("a number of runs"))
}

/// Runs in which it is told, of those of a kind.
fn runs(phases: fn(&mut Rng, f64) -> Vec<Phase>, change: fn(&mut Rng, f64) -> Change) -> u64 {
    let one = |seed: u64| {
        let mut rng = Rng(seed.wrapping_mul(0x2545_f491_4f6c_dd1d));
        let machine = machine(&mut rng);
        let side = rng.uniform(0.0, TAU);
        let (phases, change) = (phases(&mut rng, side), change(&mut rng, side));
        let config = with_record(&machine, true);
        let planes = told(&mut rng, &config, &machine, change, &phases);
        // Once a plane.
        assert!(planes.iter().filter(|it| **it == Plane::A).count() <= 1);
        assert!(planes.len() <= 2, "{planes:?}");
        u64::from(!planes.is_empty())
    };
    let told: u64 = (1..=all()).into_par_iter().map(one).sum();
    println!("{told} of {}", all());
    told
}

fn lying(rng: &mut Rng, _: f64) -> Vec<Phase> {
    rest(rng)
}

fn either(rng: &mut Rng, far: f64) -> f64 {
    far * [-1.0, 1.0][(rng.next_u64() % 2) as usize]
}

#[test]
fn at_rest_a_wall_that_has_moved_is_told() {
    assert_eq!(runs(lying, |_, _| NONE), 0);
    let by_3 = runs(lying, |rng, _| Change { wall: either(rng, 0.03), ..NONE });
    assert!(by_3 * 4 <= all(), "{by_3}");
    runs(lying, |rng, _| Change { wall: either(rng, 0.08), ..NONE });
    let by_10 = runs(lying, |rng, _| Change { wall: either(rng, 0.10), ..NONE });
    assert!(by_10 * 100 >= 85 * all(), "{by_10}");
    let by_15 = runs(lying, |rng, _| Change { wall: either(rng, 0.15), ..NONE });
    assert!(by_15 * 100 >= 95 * all(), "{by_15}");
}

#[test]
fn at_rest_a_zero_that_has_moved_up_or_down_is_told() {
    let by_10 = runs(lying, |rng, _| Change { zero: [0.0, either(rng, 0.1)], ..NONE });
    assert!(by_10 * 100 >= 85 * all(), "{by_10}");
    // Aside, the radius is nearly the same at the bottom, and friction holds a rotor aside by 0.2 of it at most.
    runs(lying, |rng, _| Change { zero: [either(rng, 0.1), 0.0], ..NONE });
    let aside = runs(lying, |rng, _| Change { zero: [either(rng, 0.25), 0.0], ..NONE });
    assert!(aside * 100 >= 60 * all(), "{aside}");
}

#[test]
fn knocks_against_a_wall_that_is_nearer_are_told() {
    assert_eq!(runs(knocks, |_, _| NONE), 0);
    assert_eq!(runs(knocks, |_, _| Change { wall: 0.1, ..NONE }), 0, "a mount that gives way");
    let nearer = runs(knocks, |_, _| Change { wall: -0.12, ..NONE });
    let zero = runs(knocks, |_, side| Change { zero: [-0.12 * side.cos(), -0.12 * side.sin()], ..NONE });
    assert!(nearer * 2 >= all() && zero * 2 >= all(), "{nearer} {zero}");
}

#[test]
fn without_a_check_on_record_nothing_is_told() {
    let mut rng = Rng(7);
    let machine = machine(&mut rng);
    let change = Change { wall: -0.15, ..NONE };
    let phases = [Phase::Rest { time: 1.0 }];
    let mut of = |is_checked| told(&mut rng, &with_record(&machine, is_checked), &machine, change, &phases);
    assert_eq!(of(false), []);
    assert_eq!(of(true), [Plane::A, Plane::B]);
}
