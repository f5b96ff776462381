//! The reference for magnets whose force has a limit, against closed forms and what is kept.

use touchdown_base::machine::Machine;
use touchdown_scene::Magnet;
use touchdown_tests::close::{close, close_pair};
use touchdown_tests::rig::RIG;
use touchdown_truth::reference::coupled::{CoupledMachine, CoupledReference, CoupledStart, CoupledState};

const ROTOR: Machine = Machine { friction: 0.0, restitution: 1.0, ..RIG };
const MAGNET: Magnet = Magnet {
    place: 0.0,
    stiffness: -5e5,
    damping: 0.0,
    force: [0.0; 2],
    limit: Some(60.0),
    on: None,
};

fn drop(rotor: &Machine, magnet: Magnet, start: &CoupledStart) -> CoupledReference {
    let mut machine = CoupledMachine::level(rotor, None, None);
    machine.magnets.push(magnet);
    CoupledReference::new(&machine, start, 0.0)
}

fn silent(reference: &mut CoupledReference, time: f64) -> CoupledState {
    reference.advance(time, &mut |_, _| panic!("no contact"))
}

/// Place and speed of 3.42 kg in half a swing from rest at `start`: pushed by 60 N up to where the spring has as much, then a
/// harmonic, then against 60 N; with the time that the half takes.
fn half_swing(start: f64, time: f64) -> ([f64; 2], f64) {
    let (most, mass) = (60.0, ROTOR.mass);
    let knee = most / 5e5;
    let push = most / mass;
    let reaches = (2.0 * (start - knee) / push).sqrt();
    let speed = push * reaches;
    let rate = (5e5 / mass).sqrt();
    let crosses = 2.0 * (rate * knee / speed).atan() / rate;
    let swung = if time < reaches {
        [start - 0.5 * push * time * time, -push * time]
    } else if time < reaches + crosses {
        let (sine, cosine) = (rate * (time - reaches)).sin_cos();
        [knee * cosine - speed / rate * sine, -knee * rate * sine - speed * cosine]
    } else {
        let left = 2.0 * reaches + crosses - time;
        [-start + 0.5 * push * left * left, -push * left]
    };
    (swung, 2.0 * reaches + crosses)
}

/// Along y, held against its weight and swinging about that.
#[test]
fn a_limited_spring_swings_in_three_parts() {
    let rotor = Machine { gravity: 0.0, ..ROTOR };
    let amplitude = 0.9 * ROTOR.clearance;
    let start = CoupledStart { position: [0.0, amplitude], ..CoupledStart::default() };
    let mut reference = drop(&rotor, MAGNET, &start);
    let (_, half) = half_swing(amplitude, 0.0);
    for k in 0..1000 {
        let time = f64::from(k) * 0.01 * half;
        let state = silent(&mut reference, time);
        let halves = (time / half).floor();
        let ([place, speed], _) = half_swing(amplitude, time - halves * half);
        let sign = if halves % 2.0 == 0.0 { 1.0 } else { -1.0 };
        close_pair(state.position, [0.0, sign * place], 1e-12 * ROTOR.clearance);
        close(state.velocity[1], sign * speed, 1e-12 * amplitude * 4e2);
    }
}

/// A damper that pulls with its most, then in proportion to the speed; the other axis has its own limit.
#[test]
fn a_limited_damper_brakes_evenly_and_then_less_and_less() {
    let rotor = Machine { gravity: 0.0, clearance: 0.02, ..ROTOR };
    let magnet = Magnet { stiffness: 0.0, damping: 400.0, ..MAGNET };
    let start = CoupledStart { velocity: [-0.5, 0.1], ..CoupledStart::default() };
    let mut reference = drop(&rotor, magnet, &start);
    let (push, decay) = (60.0 / ROTOR.mass, 400.0 / ROTOR.mass);
    let knee = (0.5 - 0.15) / push;
    for k in 0..500 {
        let time = f64::from(k) * 1e-4;
        let state = silent(&mut reference, time);
        let x = if time < knee {
            0.5 * time - 0.5 * push * time * time
        } else {
            let left = -(-decay * (time - knee)).exp_m1();
            0.5 * knee - 0.5 * push * knee * knee + 0.15 / decay * left
        };
        let y = -0.1 / decay * (-decay * time).exp_m1();
        close_pair(state.position, [-x, y], 1e-12 * 0.02);
    }
}

/// Switched on in the middle of a fall, beyond the knee of its spring.
#[test]
fn a_magnet_that_comes_back_pulls_with_its_most() {
    let magnet = Magnet { on: Some([4e-3, f64::INFINITY]), ..MAGNET };
    let start = CoupledStart { position: [0.0, -1e-4], ..CoupledStart::default() };
    let mut reference = drop(&ROTOR, magnet, &start);
    let (fall, up) = (9.81, 60.0 / ROTOR.mass - 9.81);
    let fallen = [-1e-4 - 0.5 * fall * 16e-6, -fall * 4e-3];
    for k in 0..40 {
        let time = 4e-3 + f64::from(k) * 1e-4;
        let state = silent(&mut reference, time);
        let since = time - 4e-3;
        let place = fallen[0] + fallen[1] * since + 0.5 * up * since * since;
        close_pair(state.position, [0.0, place], 1e-12 * ROTOR.clearance);
    }
}

/// With a bias that keeps most of the weight, in elastic impacts.
#[test]
fn a_limited_spring_keeps_energy() {
    let magnet = Magnet { force: [-5.0, 30.0], place: 0.1, ..MAGNET };
    let start = CoupledStart { position: [1e-4, 2e-5], velocity: [0.05, 0.02], ..CoupledStart::default() };
    let mut reference = drop(&ROTOR, magnet, &start);
    let first = reference.advance(0.0, &mut |_, _| {});
    let first = reference.energy(&first);
    let mut count = 0;
    let end = reference.advance(1.0, &mut |_, _| count += 1);
    let lost = (reference.energy(&end) - first) / (ROTOR.mass * ROTOR.gravity * ROTOR.clearance);
    println!("{count} impacts: energy {lost:.1e}");
    assert!(count > 50 && lost.abs() < 1e-10, "{count} {lost:.1e}");
    assert_eq!(reference.given_up(), None);
}
