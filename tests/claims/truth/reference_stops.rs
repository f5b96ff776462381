//! The reference for rings whose stop gives way, against closed forms and what is kept.

use std::f64::consts::PI;
use touchdown_base::history::{Impact, ModelEvent};
use touchdown_base::machine::{Machine, Start};
use touchdown_scene::{Base, Stop, Support};
use touchdown_tests::close::{close, close_pair};
use touchdown_tests::rig::RIG;
use touchdown_truth::reference::coupled::{CoupledMachine, CoupledReference, CoupledStart, CoupledState, Retainer};
use touchdown_truth::reference::press::{Press, PressShape};

const ROTOR: Machine = Machine { friction: 0.0, restitution: 1.0, ..RIG };
const TRAVEL: f64 = 2e-5;
/// N/m.
const STOP: f64 = 3e7;
const MOUNT: Support = Support {
    mass: 0.4,
    stiffness: 2e6,
    damping: 0.0,
    vertical: None,
    friction: 0.0,
    stop: soft(TRAVEL, STOP),
};
const SPRING: Press = Press { shape: PressShape::Power { exponent: 1.0 }, stiffness: 1e8, balls: None, slowest: 1e-6 };
/// A diagonal.
const ALONG: [f64; 2] = [0.6, -0.8];

const fn soft(travel: f64, stiffness: f64) -> Option<Stop> {
    Some(Stop { travel, stiffness: Some(stiffness) })
}

fn level(rotor: &Machine, mount: Support, press: Option<Press>) -> CoupledMachine {
    let mut machine = CoupledMachine::level(rotor, Some(mount), None);
    machine.retainers[0].press = press;
    machine
}

/// In two such rings, at these places.
fn long(rotor: &Machine, mount: Support, press: Option<Press>, places: [f64; 2]) -> CoupledMachine {
    let level = level(rotor, mount, press);
    let one = level.retainers[0];
    let retainer = |place| Retainer { place, ..one };
    CoupledMachine { transverse_inertia: 0.03, retainers: places.map(retainer).to_vec(), ..level }
}

/// A ring alone, at its rest, the rotor far away and without weight.
fn ring_alone(mount: Support, velocity: [f64; 2]) -> CoupledReference {
    let rotor = Machine { gravity: 0.0, clearance: 0.01, ..ROTOR };
    let start = CoupledStart { rings: vec![[[0.0; 2], velocity]], ..CoupledStart::default() };
    CoupledReference::new(&level(&rotor, mount, None), &start, 0.0)
}

/// The rotor lies on the ring, at rest.
fn lying(clearance: f64) -> CoupledStart {
    CoupledStart::level(&Start::Wall { angle: 0.0, tangential: 0.0 }, clearance)
}

fn impacts(reference: &mut CoupledReference, time: f64) -> (CoupledState, Vec<(usize, Impact)>) {
    let mut impacts = Vec::new();
    let state = reference.advance(time, &mut |link, it| match it {
        ModelEvent::Impact(it) => impacts.push((link, it)),
        it => panic!("{it:?}"),
    });
    (state, impacts)
}

/// Of the first ring in its stop.
fn depth(state: &CoupledState) -> f64 {
    let [x, y] = state.rings[0].position;
    f64::hypot(x, y) - TRAVEL
}

/// Along each axis of a mount of two stiffnesses, and on none. With the mount's spring it is in the stop for less than half of
/// a period, as that pushes it back from the start.
#[test]
fn a_ring_swings_in_its_stop_and_leaves_as_fast_as_it_entered() {
    const SPEED: f64 = 0.5;
    let mount = Support { vertical: Some([5e6, 0.0]), ..MOUNT };
    let none = Support { stiffness: 0.0, ..MOUNT };
    for (mount, axis, sign) in [(mount, 0, 1.0), (mount, 1, -1.0), (none, 0, -1.0)] {
        let stiffness = mount.axes()[axis][0];
        let slow = (stiffness / mount.mass).sqrt();
        let before = |time: f64| match slow {
            0.0 => [SPEED * time, SPEED],
            _ => [SPEED / slow * (slow * time).sin(), SPEED * (slow * time).cos()],
        };
        let enters = match slow {
            0.0 => TRAVEL / SPEED,
            _ => (slow * TRAVEL / SPEED).asin() / slow,
        };
        let [_, speed] = before(enters);
        let rate = ((stiffness + STOP) / mount.mass).sqrt();
        let centre = STOP / (stiffness + STOP) * TRAVEL;
        let stays = 2.0 * speed.atan2(rate * (TRAVEL - centre)) / rate;
        let within = |time: f64| {
            let (sine, cosine) = (rate * time).sin_cos();
            let out = TRAVEL - centre;
            [centre + out * cosine + speed / rate * sine, speed * cosine - rate * out * sine]
        };
        let mut unit = [0.0; 2];
        unit[axis] = sign;
        let mut reference = ring_alone(mount, unit.map(|part| part * SPEED));
        let (mut entered, mut off) = (Vec::new(), [0.0_f64; 2]);
        for k in 0..=200 {
            let time = (2.0 * enters + stays) * f64::from(k) / 200.0;
            let (state, more) = impacts(&mut reference, time);
            entered.extend(more);
            let since = time - enters;
            let [place, rate] = if since < 0.0 {
                before(time)
            } else if since < stays {
                within(since)
            } else {
                let [place, rate] = before(enters + stays - since);
                [place, -rate]
            };
            let ring = state.rings[0];
            off[0] = off[0].max((ring.position[axis] * sign - place).abs() / TRAVEL);
            off[1] = off[1].max((ring.velocity[axis] * sign - rate).abs() / SPEED);
            close(state.normal_forces[1], STOP * (place - TRAVEL).max(0.0), 1e-13 * STOP * TRAVEL);
        }
        println!("axis {axis}, {stiffness} N/m: {:.3} of half a period, place {:.1e}, speed {:.1e}", stays * rate / PI, off[0], off[1]);
        let [(1, entry)] = entered[..] else { panic!("{entered:?}") };
        close(entry.state.time / enters, 1.0, 1e-14);
        close(entry.normal_speed / speed, 1.0, 1e-14);
        assert_eq!(entry.normal_impulse, 0.0);
        assert!(off[0] < 1e-13 && off[1] < 1e-14, "{off:?}");
    }
}

/// Obliquely, off rigid and compliant walls, on mounts of one and of two stiffnesses, in one ring and in two.
#[test]
fn elastic_drops_keep_energy_in_the_stop() {
    let two = Support { vertical: Some([5e6, 0.0]), ..MOUNT };
    let one = |mount, press| level(&ROTOR, mount, press);
    let both = |mount, press| long(&ROTOR, mount, press, [-0.08, 0.13]);
    let machines = [
        one(MOUNT, None),
        one(MOUNT, Some(SPRING)),
        one(two, None),
        both(MOUNT, None),
        both(two, Some(SPRING)),
    ];
    for machine in machines {
        let start = CoupledStart { position: [1e-4, 2e-5], tilt_rate: [0.1, 0.3], ..CoupledStart::default() };
        let mut reference = CoupledReference::new(&machine, &start, 0.0);
        let (first, _) = impacts(&mut reference, 0.0);
        let first = reference.energy(&first);
        let (mut hits, mut within, mut lost) = (0, 0, 0.0_f64);
        for k in 1..=2000 {
            let (state, more) = impacts(&mut reference, 5e-5 * f64::from(k));
            hits += more.len();
            within += usize::from(depth(&state) > 0.0);
            let off = (reference.energy(&state) - first) / (ROTOR.mass * ROTOR.gravity * ROTOR.clearance);
            lost = lost.max(off.abs());
        }
        println!("{hits} impacts, in the stop at {within} moments: energy {lost:.1e}");
        assert!(hits > 20 && within > 20 && lost < 1e-12);
        assert_eq!(reference.given_up(), None);
    }
}

/// Rotor and ring, without weight, on a mount that is alike all around.
#[test]
fn a_stop_has_no_friction() {
    let rotor = Machine { gravity: 0.0, ..ROTOR };
    let start = CoupledStart {
        position: [1e-4, 2e-5],
        velocity: [0.05, -0.03],
        rings: vec![[[0.0; 2], [0.3, 0.2]]],
        ..CoupledStart::default()
    };
    let mut reference = CoupledReference::new(&level(&rotor, MOUNT, None), &start, 0.0);
    let momentum = |state: &CoupledState| {
        let turns = |[x, y]: [f64; 2], [vx, vy]: [f64; 2]| x * vy - y * vx;
        let ring = state.rings[0];
        rotor.mass * turns(state.position, state.velocity) + MOUNT.mass * turns(ring.position, ring.velocity)
    };
    let (first, _) = impacts(&mut reference, 0.0);
    let (end, hits) = impacts(&mut reference, 0.1);
    let entries = hits.iter().filter(|(link, _)| *link == 1).count();
    let off = momentum(&end) / momentum(&first) - 1.0;
    println!("{} impacts, {entries} of them on the stop: {off:.1e}", hits.len());
    assert!(entries > 20 && hits.len() - entries > 10);
    close(off, 0.0, 1e-13);
}

/// Wherever the ring is: on a stop it would have that behind it.
#[test]
fn a_rotor_strikes_the_rings_mass_alone() {
    let rotor = Machine { restitution: 0.8, ..ROTOR };
    let start = CoupledStart { position: [1e-4, 2e-5], ..CoupledStart::default() };
    let new = || CoupledReference::new(&level(&rotor, MOUNT, None), &start, 0.0);
    let mut reference = new();
    let mut hits = Vec::new();
    reference.advance(0.1, &mut |link, it| match it {
        ModelEvent::Impact(it) if link == 0 => hits.push(it),
        _ => {}
    });
    let (mut again, mut within) = (new(), 0);
    for hit in &hits {
        let state = again.advance(hit.state.time, &mut |_, _| {});
        within += usize::from(depth(&state) > 0.0);
        let mobility = 1.0 / rotor.mass + 1.0 / MOUNT.mass;
        close(hit.normal_impulse * mobility / hit.normal_speed, 1.8, 1e-13);
    }
    println!("{} impacts, {within} of them in the stop", hits.len());
    assert!(within > 5);
}

/// On rigid and compliant walls, in one ring and in two.
#[test]
fn a_rotor_rests_at_the_depth_of_its_weight() {
    let rotor = Machine { restitution: 0.0, ..ROTOR };
    let mount = Support { stiffness: 1e5, damping: 1000.0, stop: soft(TRAVEL, 1e6), ..MOUNT };
    for press in [None, Some(Press { stiffness: 1e7, slowest: 0.1, ..SPRING })] {
        let machines = [level(&rotor, mount, press), long(&rotor, mount, press, [-0.1, 0.1])];
        for machine in machines {
            let rings = machine.retainers.len();
            let load = rotor.mass * rotor.gravity / rings as f64;
            let mut reference = CoupledReference::new(&machine, &lying(rotor.clearance), 0.0);
            let state = reference.advance(3.0, &mut |_, _| {});
            let down = (load + 1e6 * TRAVEL) / 1.1e6;
            let pressed = press.map_or(0.0, |press| load / press.stiffness);
            for ring in 0..rings {
                let off = -state.rings[ring].position[1] / down - 1.0;
                println!("{rings} rings, {press:?}: {off:.1e}");
                close(off, 0.0, 1e-14);
                close(state.normal_forces[ring] / load, 1.0, 1e-12);
                close(state.normal_forces[rings + ring] / (1e6 * (down - TRAVEL)), 1.0, 1e-12);
            }
            close(-state.position[1] / (rotor.clearance + down + pressed), 1.0, 1e-13);
            assert_eq!(reference.given_up(), None);
        }
    }
}

/// The mount all but carries the rotor: the stop has no least force.
#[test]
fn a_stop_takes_the_least_load() {
    let rotor = Machine { restitution: 0.0, ..ROTOR };
    let (weight, load) = (rotor.mass * rotor.gravity, 1e-6);
    let travel = (weight - load) / 1e5;
    let mount = Support { stiffness: 1e5, damping: 1000.0, stop: soft(travel, 1e9), ..MOUNT };
    let mut reference = CoupledReference::new(&level(&rotor, mount, None), &lying(rotor.clearance), 0.0);
    let mut count = 0;
    let state = reference.advance(3.0, &mut |_, _| count += 1);
    println!("{count} happenings, {:.1e} of the load", state.normal_forces[1] / load - 1.0);
    close(state.normal_forces[1] / load, 1.0, 1e-3);
    assert!(count < 1000 && reference.given_up().is_none());
}

/// Rotor and ring, which the weight keeps in the stop, on a base that shakes.
#[test]
fn a_base_shakes_a_ring_in_its_stop() {
    let rotor = Machine { restitution: 0.0, ..ROTOR };
    let (damping, stiffness) = (1000.0, 1.1e6);
    let mount = Support { stiffness: 1e5, damping, stop: soft(TRAVEL, 1e6), ..MOUNT };
    let base = Base { amplitude: [0.0, 1e-6], rate: 300.0, phase: 0.4 };
    let machine = CoupledMachine { base: Some(base), ..level(&rotor, mount, None) };
    let mut reference = CoupledReference::new(&machine, &lying(rotor.clearance), 0.0);
    let mass = rotor.mass + mount.mass;
    let down = (rotor.mass * rotor.gravity + 1e6 * TRAVEL) / stiffness;
    let push = mass * base.rate * base.rate * base.amplitude[1];
    let [spring, damper] = [stiffness - mass * base.rate * base.rate, damping * base.rate];
    let (size, lag) = (push / f64::hypot(spring, damper), damper.atan2(spring));
    for k in 0..100 {
        let time = 2.0 + 1e-3 * f64::from(k);
        let state = reference.advance(time, &mut |_, _| {});
        let swing = size * (base.phase + base.rate * time - lag).cos();
        close_pair(state.rings[0].position, [0.0, swing - down], 1e-12 * size);
    }
}

/// Pushed along a diagonal, it turns where spring and stop push it with a little less than the friction, or a little more. Then
/// it stays, or swings back by as much on the other side.
#[test]
fn dry_friction_holds_a_ring_against_its_stop_up_to_its_limit() {
    const NEAR: f64 = 1e-5;
    let mount = Support { stiffness: 1e5, friction: 200.0, stop: soft(TRAVEL, 1e6), ..MOUNT };
    let at = |part: f64| (part * mount.friction + 1e6 * TRAVEL) / 1.1e6;
    for more in [-NEAR, NEAR] {
        let turns = at(1.0 + more);
        let stored = 0.5 * 1e5 * turns * turns + 0.5 * 1e6 * (turns - TRAVEL).powi(2);
        let speed = (2.0 * (stored + mount.friction * turns) / mount.mass).sqrt();
        let mut reference = ring_alone(mount, ALONG.map(|part| part * speed));
        let state = reference.advance(0.1, &mut |_, _| {});
        let [x, y] = state.rings[0].position;
        let off = (f64::hypot(x, y) - at(1.0 - NEAR)) / (at(1.0) - at(1.0 - NEAR));
        println!("{more}: {off:.1e} of {NEAR} of the limit");
        close(off, 0.0, if more < 0.0 { 1e-6 } else { 1e-2 });
        close_pair(state.rings[0].velocity, [0.0; 2], 1e-15);
    }
}

/// A rotor that bounces, rubs and whirls on rings that stick and slide, in their stops too.
#[test]
fn drops_into_the_stop_lose_energy_only() {
    let rotor = Machine { friction: 0.15, restitution: 0.6, ..ROTOR };
    for (spin, friction, press) in [(0.0, 20.0, None), (-300.0, 20.0, None), (-300.0, 0.0, Some(SPRING)), (1000.0, 50.0, Some(SPRING))] {
        let mount = Support { friction, damping: 100.0, vertical: Some([3e6, 50.0]), ..MOUNT };
        for machine in [level(&rotor, mount, press), long(&rotor, mount, press, [-0.08, 0.13])] {
            let start = CoupledStart { position: [5e-5, 2e-5], ..CoupledStart::default() };
            let mut reference = CoupledReference::new(&machine, &start, spin);
            let (mut before, mut count, mut within) = (f64::INFINITY, 0, 0);
            for k in 0..=1000 {
                let state = reference.advance(f64::from(k) * 3e-5, &mut |_, _| count += 1);
                let energy = reference.energy(&state);
                assert!(energy <= before + 1e-13 * before.abs(), "{energy} after {before}");
                before = energy;
                within += usize::from(depth(&state) > 0.0);
            }
            println!("{spin} {friction} {}: {count} happenings, in the stop at {within} moments, {:?}", machine.retainers.len(), reference.given_up());
            assert!(count > 5 && within > 5 && reference.given_up().is_none());
        }
    }
}

/// Its force falls with its stiffness; that of a rigid one does not.
#[test]
fn a_stop_without_stiffness_is_none() {
    let rotor = Machine { friction: 0.1, restitution: 0.6, ..ROTOR };
    let start = CoupledStart { position: [1e-4, 2e-5], ..CoupledStart::default() };
    let end = |stop: Option<Stop>| {
        let mount = Support { damping: 300.0, stop, ..MOUNT };
        let mut reference = CoupledReference::new(&level(&rotor, mount, None), &start, -300.0);
        let (mut hits, mut entries) = (0, 0);
        let state = reference.advance(0.05, &mut |link, it| match it {
            ModelEvent::Impact(_) if link == 0 => hits += 1,
            ModelEvent::Impact(_) => entries += 1,
            _ => {}
        });
        (state.position, hits, entries)
    };
    let (want, hits, _) = end(None);
    for stiffness in [1e-6, 1.0, 1e3] {
        let (have, alike, entries) = end(soft(TRAVEL, stiffness));
        let off = f64::hypot(have[0] - want[0], have[1] - want[1]) / rotor.clearance;
        println!("{stiffness} N/m: {hits} and {alike} impacts, {entries} on the stop, off by {off:.1e}");
        assert!(alike == hits && entries > 3);
        close(off, 0.0, 1e-11 + 1e-5 * stiffness);
    }
}
