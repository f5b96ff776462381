//! The reference for walls that give way, against Hertz' impact, closed forms over the force, and what is kept.

use std::f64::consts::PI;
use touchdown_base::history::{Impact, ModelEvent};
use touchdown_base::machine::Machine;
use touchdown_scene::{Stop, Support};
use touchdown_tests::close::{close, close_pair};
use touchdown_tests::rig::RIG;
use touchdown_truth::reference::coupled::{CoupledMachine, CoupledReference, CoupledStart, CoupledState};
use touchdown_truth::reference::press::{Press, PressShape};

const ROTOR: Machine = Machine { friction: 0.0, restitution: 1.0, gravity: 0.0, ..RIG };
const HERTZ: Press = Press { shape: PressShape::Power { exponent: 1.5 }, stiffness: 2e10, balls: None, slowest: 1e-6 };
const SPRING: Press = Press { shape: PressShape::Power { exponent: 1.0 }, stiffness: 1e8, ..HERTZ };
const LINE: Press = Press { shape: PressShape::Line { clearance: RIG.clearance }, stiffness: 1e9, ..HERTZ };
/// Friction of what slips all the time.
const SLIPPERY: f64 = 0.1;
/// Of balls that give way about as the walls do, N/m.
const BALLS: Option<f64> = Some(1e8);
const ALL: [Press; 6] = [
    HERTZ,
    SPRING,
    LINE,
    Press { balls: BALLS, ..HERTZ },
    Press { balls: BALLS, ..SPRING },
    Press { balls: BALLS, ..LINE },
];
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
    for press in ALL {
        for restitution in [0.02, 0.1, 0.3, 0.6, 0.9, 0.99] {
            let rotor = Machine { restitution, ..ROTOR };
            let mut reference = drop(&rotor, None, press, &thrown([SPEED, 0.0]), 0.0);
            let (state, _) = impacts(&mut reference, 1.5 * ROTOR.clearance / SPEED);
            println!("{press:?} {restitution}: {:.1e}", -state.velocity[0] / SPEED - restitution);
            close(state.velocity[0] / SPEED, -restitution, 1e-12);
        }
    }
}

/// Off a ring on its mount, under weight; also while walls are pressed.
#[test]
fn elastic_impacts_keep_energy() {
    let rotor = Machine { gravity: 9.81, ..ROTOR };
    let mount = Support { mass: 0.4, stiffness: 2e6, damping: 0.0, vertical: None, friction: 0.0, stop: None };
    for (press, mount) in ALL.into_iter().flat_map(|press| [(press, None), (press, Some(mount))]) {
        let start = CoupledStart { position: [1e-4, 2e-5], ..CoupledStart::default() };
        let mut reference = drop(&rotor, mount, press, &start, 0.0);
        let (mut hits, mut pressed, mut lost) = (0, 0, 0.0_f64);
        let (first, _) = impacts(&mut reference, 0.0);
        let first = reference.energy(&first);
        for k in 1..=1500 {
            let (state, more) = impacts(&mut reference, 1e-4 * f64::from(k));
            hits += more.len();
            pressed += usize::from(state.normal_forces[0] > 0.0);
            let off = (reference.energy(&state) - first) / (rotor.mass * rotor.gravity * rotor.clearance);
            lost = lost.max(off.abs());
        }
        println!("{hits} impacts, pressed at {pressed} moments: energy {lost:.1e}");
        assert!(hits > 5 && pressed > 20 && lost < 1e-10);
        assert_eq!(reference.given_up(), None);
    }
}

/// Of what slips in the undamped wall: places, their rates and the rate of the spin.
fn rates(press: &Press, [x, y, vx, vy, _]: [f64; 5]) -> [f64; 5] {
    let distance = f64::hypot(x, y);
    let depth = (distance - ROTOR.clearance).max(0.0);
    let normal = found(depth, |force| at_force(press, force)[0]);
    let [nx, ny] = [x / distance, y / distance];
    let rubbed = -SLIPPERY * normal;
    let push = [-nx * normal - ny * rubbed, -ny * normal + nx * rubbed];
    [vx, vy, push[0] / ROTOR.mass, push[1] / ROTOR.mass, rubbed * ROTOR.radius / ROTOR.polar_inertia]
}

/// One step of fourth order.
fn step(press: &Press, at: [f64; 5], time: f64) -> [f64; 5] {
    let moved = |rates: [f64; 5], time: f64| [0, 1, 2, 3, 4].map(|k| at[k] + time * rates[k]);
    let a = rates(press, at);
    let b = rates(press, moved(a, 0.5 * time));
    let c = rates(press, moved(b, 0.5 * time));
    let d = rates(press, moved(c, time));
    [0, 1, 2, 3, 4].map(|k| at[k] + time / 6.0 * (a[k] + 2.0 * (b[k] + c[k]) + d[k]))
}

/// It slips counter-clockwise all the time: against many small steps.
#[test]
fn friction_turns_the_impact() {
    let rotor = Machine { friction: SLIPPERY, ..ROTOR };
    let spin = 1000.0 * PI;
    let touch = ROTOR.clearance / SPEED;
    for press in [HERTZ, Press { balls: BALLS, ..LINE }] {
        let mut reference = drop(&rotor, None, press, &thrown([SPEED, 0.0]), spin);
        let mut at = [ROTOR.clearance, 0.0, SPEED, 0.0, spin];
        for part in 1..=8 {
            for _ in 0..10_000 {
                at = step(&press, at, 1e-8);
            }
            let (state, _) = impacts(&mut reference, touch + 1e-4 * f64::from(part));
            let off = f64::hypot(state.velocity[0] - at[2], state.velocity[1] - at[3]) / SPEED;
            println!("{press:?}: {part} off by {off:.1e}");
            close_pair(state.position, [at[0], at[1]], 1e-9 * ROTOR.clearance);
            close_pair(state.velocity, [at[2], at[3]], 1e-9 * SPEED);
            close(state.spin / at[4], 1.0, 1e-12);
        }
        assert!(at[2] < -0.9 * SPEED && at[3] < -0.1 * SPEED, "{at:?}");
    }
}

/// It falls, bounces, comes to rest in the wall and rolls there, on a ring with a stop: stored energy only falls.
#[test]
fn a_rotor_comes_to_rest_in_the_wall() {
    let rotor = Machine { friction: 0.2, restitution: 0.3, gravity: 9.81, ..ROTOR };
    let press = Press { stiffness: 1e9, slowest: 1e-3, ..HERTZ };
    let mount = Support { mass: 0.4, stiffness: 1e6, damping: 500.0, vertical: None, friction: 5.0, stop: Some(Stop::rigid(2e-5)) };
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

/// Of a wall and its balls at a force: depth, compliance and stored energy.
fn at_force(press: &Press, force: f64) -> [f64; 3] {
    let spring = force / press.stiffness;
    let [depth, compliance, energy] = match press.shape {
        PressShape::Power { exponent } => {
            let depth = spring.powf(1.0 / exponent);
            let energy = press.stiffness * depth.powf(exponent + 1.0) / (exponent + 1.0);
            [depth, depth / (exponent * force), energy]
        }
        PressShape::Line { clearance } => {
            let logarithm = f64::ln(4.0 * clearance / spring);
            let energy = 0.5 * force * spring * (logarithm - 1.5);
            [spring * (logarithm - 1.0), (logarithm - 2.0) / press.stiffness, energy]
        }
    };
    let balls = press.balls.map_or(0.0, |stiffness| 1.0 / stiffness);
    [depth + force * balls, compliance + balls, energy + 0.5 * force * force * balls]
}

/// The force at which what rises with it has a value: halved down to rounding.
fn found(value: f64, of: impl Fn(f64) -> f64) -> f64 {
    let (mut low, mut high) = (0.0, 1e4);
    for _ in 0..70 {
        let force = 0.5 * (low + high);
        if of(force) < value { low = force } else { high = force }
    }
    low
}

/// Greatest force of an undamped impact.
fn peak(press: &Press, energy: f64) -> f64 {
    found(energy, |force| at_force(press, force)[2])
}

/// Duration of it: twice the integral of dd/v over the way in, v from the energy. The force is its peak times sin^6, which
/// leaves nothing singular at the ends; Gauss' points in each of many parts.
fn duration(press: &Press, speed: f64) -> f64 {
    const PARTS: u32 = 4000;
    let energy = 0.5 * ROTOR.mass * speed * speed;
    let most = peak(press, energy);
    let width = 0.5 * PI / f64::from(PARTS);
    let at = |angle: f64| {
        let force = most * angle.sin().powi(6);
        let [_, compliance, stored] = at_force(press, force);
        let speed = (2.0 * (energy - stored) / ROTOR.mass).sqrt();
        compliance * 6.0 * force / angle.tan() / speed
    };
    let gauss = 0.5 / f64::sqrt(3.0);
    let part = |k: u32| {
        let middle = f64::from(k) + 0.5;
        0.5 * width * (at(width * (middle - gauss)) + at(width * (middle + gauss)))
    };
    2.0 * (0..PARTS).map(part).sum::<f64>()
}

/// Head-on: peak against the closed form of the energy, duration against the integral, and the way back.
#[test]
fn undamped_impacts_take_the_time_of_their_energy() {
    for press in ALL {
        let touch = ROTOR.clearance / SPEED;
        let duration = duration(&press, SPEED);
        let mut reference = drop(&ROTOR, None, press, &thrown([SPEED, 0.0]), 0.0);
        let (state, _) = impacts(&mut reference, touch + 0.5 * duration);
        let most = peak(&press, 0.5 * ROTOR.mass * SPEED * SPEED);
        let off = state.normal_forces[0] / most - 1.0;
        let deepest = (state.position[0] - ROTOR.clearance) / at_force(&press, most)[0] - 1.0;
        let (state, _) = impacts(&mut reference, 1.5 * touch + duration);
        let took = 0.5 * touch + duration - (ROTOR.clearance - state.position[0]) / SPEED;
        let slower = state.velocity[0] / SPEED + 1.0;
        println!("{press:?}: peak {off:.1e}, depth {deepest:.1e}, {duration:e} s off by {:.1e}, speed {slower:.1e}", took / duration - 1.0);
        close(off, 0.0, 1e-12);
        close(deepest, 0.0, 1e-12);
        close(took / duration, 1.0, 1e-11);
        close(slower, 0.0, 1e-12);
    }
}

/// Against a ring that nothing holds: Newton's two bodies.
#[test]
fn an_impact_on_a_free_ring_keeps_momentum() {
    let mount = Support { mass: 0.4, stiffness: 0.0, damping: 0.0, vertical: None, friction: 0.0, stop: None };
    for (press, restitution) in ALL.into_iter().flat_map(|press| [(press, 0.3), (press, 1.0)]) {
        let rotor = Machine { restitution, ..ROTOR };
        let mut reference = drop(&rotor, Some(mount), press, &thrown([SPEED, 0.0]), 0.0);
        let (state, hits) = impacts(&mut reference, 1.5 * ROTOR.clearance / SPEED);
        let all = rotor.mass + mount.mass;
        let [left, pushed] = [rotor.mass - restitution * mount.mass, rotor.mass * (1.0 + restitution)].map(|it| it / all);
        let [x, u] = [state.velocity[0] / SPEED, state.rings[0].velocity[0] / SPEED];
        let kept = (rotor.mass * x + mount.mass * u) / rotor.mass - 1.0;
        println!("{press:?} {restitution}: {:.1e} {:.1e}, momentum {kept:.1e}", x - left, u - pushed);
        assert!(hits.len() == 1 && kept.abs() < 1e-14);
        close(x, left, 1e-12);
        close(u, pushed, 1e-12);
    }
}

/// Let down onto the wall, it bounces, and then lies as deep as its weight presses it.
#[test]
fn a_rotor_rests_at_the_depth_of_its_weight() {
    let rotor = Machine { restitution: 0.3, gravity: 9.81, ..ROTOR };
    let weight = rotor.mass * rotor.gravity;
    for press in ALL {
        let press = Press { stiffness: press.stiffness / 100.0, slowest: 1e-3, ..press };
        let start = CoupledStart { position: [0.0, -0.99 * rotor.clearance], ..CoupledStart::default() };
        let mut reference = drop(&rotor, None, press, &start, 0.0);
        let mut count = 0;
        let state = reference.advance(2.0, &mut |_, _| count += 1);
        let depth = at_force(&press, weight)[0];
        let off = (-state.position[1] - rotor.clearance) / depth - 1.0;
        println!("{press:?}: {count} impacts, {depth:e} m off by {off:.1e}, moves at {:e} m/s", state.velocity[1]);
        assert!(count > 0 && reference.given_up().is_none());
        close(off, 0.0, 1e-12);
        close(state.normal_forces[0] / weight, 1.0, 1e-12);
    }
}

/// A soft line under a fast rotor: where its stiffness would have no bound, the run ends. The last step passes that by a little.
#[test]
fn a_line_pressed_beyond_its_law_is_given_up() {
    let press = Press { stiffness: 1e6, ..LINE };
    for press in [press, Press { balls: Some(1e7), ..press }] {
        let mut reference = drop(&ROTOR, None, press, &thrown([1.0, 0.0]), 0.0);
        let (state, hits) = impacts(&mut reference, 0.1);
        let most = 4.0 * press.stiffness * ROTOR.clearance * f64::exp(-2.0);
        let deep = (state.position[0] - ROTOR.clearance) / at_force(&press, most)[0];
        println!("{deep} of the depth, force {}", state.normal_forces[0] / most);
        assert!(hits.len() == 1 && (0.9999..1.01).contains(&deep));
        assert_eq!(reference.given_up(), Some(state.time));
    }
}
