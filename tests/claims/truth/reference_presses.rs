//! The reference for walls that give way, against Hertz' impact and what is kept.

use std::f64::consts::PI;
use touchdown_base::history::{Impact, ModelEvent};
use touchdown_base::machine::Machine;
use touchdown_scene::Support;
use touchdown_tests::close::{close, close_pair};
use touchdown_tests::rig::RIG;
use touchdown_truth::reference::coupled::{CoupledMachine, CoupledReference, CoupledStart, CoupledState, Press};

const ROTOR: Machine = Machine { friction: 0.0, restitution: 1.0, gravity: 0.0, ..RIG };
const HERTZ: Press = Press { stiffness: 2e10, exponent: 1.5, slowest: 1e-6 };
/// Of Hertz' impact: V times its duration over its depth, 2 sqrt(pi) Gamma(7/5)/Gamma(9/10).
const DURATION: f64 = 2.943_275_184_324_706;
const SPEED: f64 = 0.06;

fn drop(rotor: &Machine, mount: Option<Support>, press: Press, start: &CoupledStart, spin: f64) -> CoupledReference {
    let mut machine = CoupledMachine::level(rotor, mount, None);
    machine.retainers[0].press = Some(press);
    CoupledReference::new(&machine, start, spin)
}

fn thrown(velocity: [f64; 2]) -> CoupledStart {
    CoupledStart { velocity, ..CoupledStart::default() }
}

fn impacts(reference: &mut CoupledReference, time: f64) -> (CoupledState, Vec<Impact>) {
    let mut impacts = Vec::new();
    let state = reference.advance(time, &mut |_, it| match it {
        ModelEvent::Impact(it) => impacts.push(it),
        it => panic!("{it:?}"),
    });
    (state, impacts)
}

/// Head-on against a point: duration, peak and the way back.
#[test]
fn an_undamped_impact_is_hertz() {
    let touch = ROTOR.clearance / SPEED;
    let energy = 1.25 * ROTOR.mass * SPEED * SPEED;
    let duration = DURATION * (energy / HERTZ.stiffness).powf(0.4) / SPEED;
    let peak = HERTZ.stiffness.powf(0.4) * energy.powf(0.6);
    let mut reference = drop(&ROTOR, None, HERTZ, &thrown([0.6 * SPEED, 0.8 * SPEED]), 0.0);
    let (state, entered) = impacts(&mut reference, touch + 0.5 * duration);
    close(state.normal_forces[0] / peak, 1.0, 1e-11);
    close_pair(state.velocity, [0.0; 2], 1e-10 * SPEED);
    assert_eq!(entered.len(), 1);
    close(entered[0].normal_speed / SPEED, 1.0, 1e-14);
    close(entered[0].state.time, touch, 1e-8 * touch);
    let (state, more) = impacts(&mut reference, touch + duration + 0.1 * touch);
    assert!(more.is_empty() && state.normal_forces[0] == 0.0);
    close_pair(state.velocity, [-0.6 * SPEED, -0.8 * SPEED], 1e-12 * SPEED);
    let left = f64::hypot(state.position[0], state.position[1]);
    let took = 0.1 * touch + duration - (ROTOR.clearance - left) / SPEED;
    println!("peak {peak} N, {duration:e} s: off by {:.1e}", took / duration - 1.0);
    close(took / duration, 1.0, 1e-9);
}

#[test]
fn a_damped_impact_leaves_with_its_restitution() {
    for exponent in [1.0, 1.5] {
        for restitution in [0.02, 0.1, 0.3, 0.6, 0.9, 0.99] {
            let rotor = Machine { restitution, ..ROTOR };
            let press = Press { exponent, stiffness: if exponent == 1.0 { 1e8 } else { 2e10 }, ..HERTZ };
            let mut reference = drop(&rotor, None, press, &thrown([SPEED, 0.0]), 0.0);
            let (state, _) = impacts(&mut reference, 1.5 * ROTOR.clearance / SPEED);
            println!("{exponent} {restitution}: {:.1e}", -state.velocity[0] / SPEED - restitution);
            close(state.velocity[0] / SPEED, -restitution, 1e-9);
        }
    }
}

/// Off a ring on its mount, under weight.
#[test]
fn elastic_impacts_keep_energy() {
    let rotor = Machine { gravity: 9.81, ..ROTOR };
    let mount = Support { mass: 0.4, stiffness: 2e6, damping: 0.0, vertical: None, friction: 0.0, travel: None };
    for mount in [None, Some(mount)] {
        let start = CoupledStart { position: [1e-4, 2e-5], ..CoupledStart::default() };
        let mut reference = drop(&rotor, mount, HERTZ, &start, 0.0);
        let (first, _) = impacts(&mut reference, 0.0);
        let first = reference.energy(&first);
        let (end, hits) = impacts(&mut reference, 0.15);
        let lost = (reference.energy(&end) - first) / (rotor.mass * rotor.gravity * rotor.clearance);
        println!("{} impacts: energy {lost:.1e}", hits.len());
        assert!(hits.len() > 5 && lost.abs() < 1e-10);
        assert_eq!(reference.given_up(), None);
    }
}

/// Of what slips in the undamped wall: places, their rates and the rate of the spin.
fn rates(friction: f64, [x, y, vx, vy, _]: [f64; 5]) -> [f64; 5] {
    let distance = f64::hypot(x, y);
    let normal = HERTZ.stiffness * (distance - ROTOR.clearance).max(0.0).powf(HERTZ.exponent);
    let [nx, ny] = [x / distance, y / distance];
    let rubbed = -friction * normal;
    let push = [-nx * normal - ny * rubbed, -ny * normal + nx * rubbed];
    [vx, vy, push[0] / ROTOR.mass, push[1] / ROTOR.mass, rubbed * ROTOR.radius / ROTOR.polar_inertia]
}

/// One step of fourth order.
fn step(friction: f64, at: [f64; 5], time: f64) -> [f64; 5] {
    let moved = |rates: [f64; 5], time: f64| [0, 1, 2, 3, 4].map(|k| at[k] + time * rates[k]);
    let a = rates(friction, at);
    let b = rates(friction, moved(a, 0.5 * time));
    let c = rates(friction, moved(b, 0.5 * time));
    let d = rates(friction, moved(c, time));
    [0, 1, 2, 3, 4].map(|k| at[k] + time / 6.0 * (a[k] + 2.0 * (b[k] + c[k]) + d[k]))
}

/// It slips counter-clockwise all the time: against many small steps.
#[test]
fn friction_turns_the_impact() {
    let rotor = Machine { friction: 0.1, ..ROTOR };
    let spin = 1000.0 * PI;
    let touch = ROTOR.clearance / SPEED;
    let mut reference = drop(&rotor, None, HERTZ, &thrown([SPEED, 0.0]), spin);
    let mut at = [ROTOR.clearance, 0.0, SPEED, 0.0, spin];
    for part in 1..=8 {
        for _ in 0..10_000 {
            at = step(0.1, at, 1e-8);
        }
        let (state, _) = impacts(&mut reference, touch + 1e-4 * f64::from(part));
        close_pair(state.position, [at[0], at[1]], 1e-9 * ROTOR.clearance);
        close_pair(state.velocity, [at[2], at[3]], 1e-9 * SPEED);
        close(state.spin / at[4], 1.0, 1e-12);
    }
    assert!(at[2] < -0.9 * SPEED && at[3] < -0.1 * SPEED, "{at:?}");
}

/// It falls, bounces, comes to rest in the wall and rolls there, on a ring with a stop: stored energy only falls.
#[test]
fn a_rotor_comes_to_rest_in_the_wall() {
    let rotor = Machine { friction: 0.2, restitution: 0.3, gravity: 9.81, ..ROTOR };
    let press = Press { stiffness: 1e9, slowest: 1e-3, ..HERTZ };
    let mount = Support { mass: 0.4, stiffness: 1e6, damping: 500.0, vertical: None, friction: 5.0, travel: Some(2e-5) };
    for mount in [None, Some(mount)] {
        let start = CoupledStart { position: [1e-4, 0.0], ..CoupledStart::default() };
        let mut reference = drop(&rotor, mount, press, &start, 5.0);
        let (mut before, mut hits) = (f64::INFINITY, 0);
        let mut end = None;
        for k in 0..=500 {
            let mut count = |_, it| hits += i32::from(matches!(it, ModelEvent::Impact(_)));
            let state = reference.advance(f64::from(k) * 2e-4, &mut count);
            let energy = reference.energy(&state);
            assert!(energy <= before + 1e-13 * before.abs(), "{energy} after {before}");
            before = energy;
            end = Some(state);
        }
        let end = end.expect("a state");
        println!("{hits} impacts, {:?} {:?} {:?}", end.modes, end.normal_forces, reference.given_up());
        assert!(reference.given_up().is_none() && hits > 0);
    }
}
