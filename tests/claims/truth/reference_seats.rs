//! The reference for rings that dry friction holds on their housing, against closed forms and its own account.

use std::f64::consts::PI;
use touchdown_base::machine::{Machine, Start};
use touchdown_scene::{Stop, Support};
use touchdown_tests::close::{close, close_pair};
use touchdown_tests::rig::RIG;
use touchdown_truth::reference::coupled::{CoupledMachine, CoupledReference, CoupledStart};

const ROTOR: Machine = Machine { restitution: 0.6, ..RIG };
/// Rounding of the speed of a ring at rest, m/s.
const STILL: f64 = 1e-15;
/// The rotor weighs 33.6 N.
const MOUNT: Support = Support {
    mass: 0.4,
    stiffness: 2e6,
    damping: 0.0,
    vertical: None,
    friction: 20.0,
    stop: None,
};

fn drop(rotor: &Machine, mount: Support, start: &CoupledStart, spin: f64) -> CoupledReference {
    CoupledReference::new(&CoupledMachine::level(rotor, Some(mount), None), start, spin)
}

/// A ring alone, the rotor far away and without weight.
fn ring_alone(mount: Support, position: [f64; 2], velocity: [f64; 2]) -> CoupledReference {
    let rotor = Machine { gravity: 0.0, clearance: 0.01, ..ROTOR };
    let start = CoupledStart { rings: vec![[position, velocity]], ..CoupledStart::default() };
    drop(&rotor, mount, &start, 0.0)
}

/// Half swings about F/k to this side and to that, until it stops within F/k of its rest.
#[test]
fn a_sliding_ring_swings_about_shifted_centres_until_it_stays() {
    let dead = MOUNT.friction / MOUNT.stiffness;
    let first = 8.6 * dead;
    let mut reference = ring_alone(MOUNT, [0.6 * first, 0.8 * first], [0.0; 2]);
    let rate = (MOUNT.stiffness / MOUNT.mass).sqrt();
    let half = PI / rate;
    // Stopping and setting off, four times, at 1e-7 and 2e-7 of the unit of speed, which is 1 m/s.
    let cut_off = 4.0 * 3e-7 / rate;
    for k in 0..600 {
        let time = f64::from(k) * 0.01 * half;
        let state = reference.advance(time, &mut |_, _| panic!("no contact"));
        // It turns at 8.6, -6.6, 4.6, -2.6 and 0.6 of F/k.
        let halves = (time / half).floor().min(4.0);
        let sign = if halves % 2.0 == 0.0 { 1.0 } else { -1.0 };
        let swing = first - (2.0 * halves + 1.0) * dead;
        let place = match halves {
            4.0 => 0.6 * dead,
            _ => sign * (dead + swing * (rate * (time - halves * half)).cos()),
        };
        close_pair(state.rings[0].position, [0.6 * place, 0.8 * place], cut_off);
    }
    let end = reference.advance(10.0 * half, &mut |_, _| panic!("no contact"));
    close_pair(end.rings[0].velocity, [0.0; 2], STILL);
    close_pair(end.rings[0].position, [0.36 * dead, 0.48 * dead], cut_off);
}

/// In the plane, on a mount of two stiffnesses: what it loses is the friction times its way.
#[test]
fn a_sliding_ring_loses_its_friction_times_its_way() {
    let mount = Support { vertical: Some([7e5, 0.0]), ..MOUNT };
    let mut reference = ring_alone(mount, [2e-4, 1e-5], [-0.1, 0.3]);
    let first = reference.advance(0.0, &mut |_, _| {});
    let mut before = (reference.energy(&first), 0.37);
    let (mut way, mut stopped) = (0.0, None);
    let step = 1e-6;
    let mut lost = 0.0;
    let speed = |reference: &mut CoupledReference, time: f64| {
        let state = reference.advance(time, &mut |_, _| {});
        let [x, y] = state.rings[0].velocity;
        (reference.energy(&state), f64::hypot(x, y))
    };
    let start = before.0;
    before.1 = f64::hypot(0.1, 0.3);
    for k in 0..40_000 {
        let time = f64::from(k) * step;
        let middle = speed(&mut reference, time + 0.5 * step);
        let after = speed(&mut reference, time + step);
        assert!(after.0 <= before.0 + 1e-15);
        way += step / 6.0 * (before.1 + 4.0 * middle.1 + after.1);
        lost = start - after.0;
        before = after;
        if after.1 < STILL {
            stopped = Some(time);
            break;
        }
    }
    println!("stopped at {stopped:?} s: {lost:.9} J, {:.1e}", lost / (mount.friction * way) - 1.0);
    assert!(stopped.is_some() && lost > 0.0);
    close(lost / (mount.friction * way), 1.0, 1e-8);
}

/// A rotor that lies on the ring: it stays where it is held, and else both swing down together, once.
#[test]
fn a_rotors_weight_moves_the_ring_only_beyond_its_friction() {
    let start = Start::Wall { angle: 0.0, tangential: 0.0 };
    let start = CoupledStart::level(&start, ROTOR.clearance);
    for (friction, travel) in [(40.0, None), (40.0, Some(1e-5)), (20.0, None), (20.0, Some(1e-5))] {
        let mount = Support { friction, stop: travel.map(Stop::rigid), ..MOUNT };
        let mut reference = drop(&ROTOR, mount, &start, 0.0);
        let weight = ROTOR.mass * ROTOR.gravity;
        let sag = (weight - friction).max(0.0) / MOUNT.stiffness;
        let rate = (MOUNT.stiffness / (MOUNT.mass + ROTOR.mass)).sqrt();
        let size = weight / MOUNT.stiffness;
        let hits = travel.filter(|travel| *travel < 2.0 * sag);
        for k in 0..100 {
            let time = f64::from(k) * 1e-4;
            let state = reference.advance(time, &mut |_, _| {});
            let free = sag * (1.0 - (rate * time).min(PI).cos());
            let place = hits.map_or(free, |travel| free.min(travel));
            if hits.is_none() {
                close_pair(state.rings[0].position, [0.0, -place], 1e-6 * size);
                close_pair(state.position, [0.0, -place - ROTOR.clearance], 1e-6 * size);
            } else if free < place {
                close_pair(state.rings[0].position, [0.0, -place], 1e-6 * size);
            }
        }
    }
}

/// On the way down it meets its stop, and lies on it.
#[test]
fn a_ring_comes_to_rest_on_its_stop() {
    let mount = Support { friction: 3.0, stop: Some(Stop::rigid(1e-5)), stiffness: 1e5, ..MOUNT };
    let start = CoupledStart { position: [1e-4, 0.0], ..CoupledStart::default() };
    let rotor = Machine { friction: 0.01, ..ROTOR };
    let mut reference = drop(&rotor, mount, &start, 0.0);
    let state = reference.advance(2.0, &mut |_, _| {});
    assert_eq!(reference.given_up(), None);
    close_pair(state.rings[0].velocity, [0.0; 2], STILL);
    let [x, y] = state.rings[0].position;
    close(f64::hypot(x, y), 1e-5, 1e-13);
}

/// A rotor that bounces, rubs and whirls on a ring that sticks and slides: stored energy only falls.
#[test]
fn a_drop_on_a_seated_ring_loses_energy_only() {
    for (spin, friction) in [(0.0, 20.0), (-300.0, 20.0), (-300.0, 200.0), (1000.0, 50.0)] {
        let mount = Support { friction, damping: 100.0, stop: Some(Stop::rigid(4e-5)), vertical: Some([3e6, 50.0]), ..MOUNT };
        let start = CoupledStart { position: [5e-5, 2e-5], ..CoupledStart::default() };
        let mut reference = drop(&ROTOR, mount, &start, spin);
        let (mut before, mut count) = (f64::INFINITY, 0);
        let mut last = None;
        for k in 0..=1000 {
            let state = reference.advance(f64::from(k) * 3e-5, &mut |_, _| count += 1);
            let energy = reference.energy(&state);
            assert!(energy <= before + 1e-13 * before.abs(), "{energy} after {before}");
            before = energy;
            last = Some(state);
        }
        println!("{spin} {friction}: {count} happenings, {:?} {:?}", last.map(|it| it.rings[0].position), reference.given_up());
        assert!(count > 5);
    }
}
