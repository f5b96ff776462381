//! The reference for a whole machine against itself with less, closed forms and what is kept.

use std::f64::consts::PI;
use touchdown_base::history::ModelEvent;
use touchdown_base::machine::Machine;
use touchdown_tests::close::{close, close_pair};
use touchdown_scene::{Magnet, Mode, Race, Shape, Stop, Support, Unbalance};
use touchdown_truth::reference::coupled::{CoupledMachine, CoupledReference, CoupledStart, Retainer};

const CLEARANCE: f64 = 3e-4;
const MASS: f64 = 3.42;
const RADIUS: f64 = 0.024;
const POLAR: f64 = 0.000_984_96;
const SPIN: f64 = -1000.0 * PI;
const MOUNT: Support = Support {
    mass: 0.4,
    stiffness: 2e6,
    damping: 300.0,
    vertical: None, friction: 0.0, stop: None,
};
const RACE: Race = Race {
    inertia: 3e-5,
    dry_drag: 0.01,
    viscous_drag: 1e-5,
    cage_ratio: 0.4,
    heat_capacity: 92.0,
    heat_loss: 0.0,
};

fn retainer(place: f64, mount: Option<Support>, race: Option<Race>) -> Retainer {
    Retainer {
        place,
        radius: RADIUS,
        clearance: CLEARANCE,
        friction: 0.1,
        restitution: 0.8,
        mount,
        race,
        press: None,
    }
}

fn machine(retainers: Vec<Retainer>) -> CoupledMachine {
    CoupledMachine {
        mass: MASS,
        polar_inertia: POLAR,
        transverse_inertia: 0.03,
        gravity: [0.0, -9.81],
        retainers,
        unbalance: Unbalance::default(),
        magnets: Vec::new(),
        bending: Vec::new(),
        base: None,
    }
}

/// Like a beam's first mode: at the rings and in the middle.
fn bending(speed: f64, damping_ratio: f64) -> Mode {
    Mode {
        speed,
        damping_ratio,
        mass: 1.0,
        shape: Shape::Points(vec![[-0.1, 0.8], [0.0, -0.6], [0.13, 0.8]]),
    }
}

fn at(position: [f64; 2], tilt: [f64; 2]) -> CoupledStart {
    CoupledStart {
        position,
        tilt,
        ..CoupledStart::default()
    }
}

fn frictionless(machine: &mut CoupledMachine, restitution: f64) {
    for it in &mut machine.retainers {
        it.friction = 0.0;
        it.restitution = restitution;
    }
}

/// Times of impacts at one contact, with the normal speeds.
fn impacts(happenings: &[(usize, ModelEvent)], contact: usize) -> Vec<(f64, f64)> {
    let impact = |(of, happening): &(usize, ModelEvent)| match happening {
        ModelEvent::Impact(it) if *of == contact => Some((it.state.time, it.normal_speed)),
        _ => None,
    };
    happenings.iter().filter_map(impact).collect()
}

/// The same impacts at the same times (s) with the same speeds (m/s).
fn alike(have: &[(f64, f64)], want: &[(f64, f64)], tolerance: f64) {
    assert_eq!(have.len(), want.len());
    for (have, want) in have.iter().zip(want) {
        close(have.0, want.0, tolerance * 5e-3);
        close(have.1, want.1, tolerance * 0.05);
    }
}

/// Of two planes, with unbalance and a magnet.
#[test]
fn heavy_rings_are_rigid_ones() {
    let unbalance = Unbalance {
        eccentricity: 1e-6,
        angle: 0.3,
        skew: 1e-5,
        skew_angle: 0.1,
    };
    let magnet = Magnet {
        place: 0.05,
        stiffness: -1e4,
        force: [1.0, 2.0],
        damping: 0.0,
        limit: None, on: None,
    };
    let mut whole = machine(vec![retainer(-0.1, None, None), retainer(0.13, None, None)]);
    (whole.unbalance, whole.magnets) = (unbalance, vec![magnet]);
    let start = at([2e-5, 0.0], [1e-4, 2e-4]);
    let mut want = CoupledReference::new(&whole, &start, 0.1 * SPIN);
    for it in &mut whole.retainers {
        it.mount = Some(Support { mass: 1e15, stiffness: 1e12, damping: 0.0, vertical: None, friction: 0.0, stop: Some(Stop::rigid(1e-4)) });
        it.race = Some(Race { inertia: 1e15, dry_drag: 1e-3, viscous_drag: 1e-3, ..RACE });
    }
    let mut have = CoupledReference::new(&whole, &start, 0.1 * SPIN);
    let (mut hits, mut wanted) = (Vec::new(), Vec::new());
    let a = have.advance(0.04, &mut |i, it| hits.push((i, it)));
    let b = want.advance(0.04, &mut |i, it| wanted.push((i, it)));
    assert!(hits.len() > 8, "{}", hits.len());
    for ring in 0..2 {
        alike(&impacts(&hits, ring), &impacts(&wanted, ring), 1e-12);
    }
    close_pair(a.position, b.position, 1e-12 * CLEARANCE);
    close_pair(a.tilt, b.tilt, 1e-11 * CLEARANCE);
    close(a.spin, b.spin, 1e-12 * SPIN.abs());
}

fn one_plane(mass: f64, polar_inertia: f64, mount: Support, race: Race) -> CoupledReference {
    let rotor = Machine {
        mass,
        radius: RADIUS,
        polar_inertia,
        clearance: CLEARANCE,
        friction: 0.1,
        restitution: 0.8,
        gravity: 9.81,
    };
    let machine = CoupledMachine::level(&rotor, Some(mount), Some(race));
    CoupledReference::new(&machine, &at([2e-5, 0.0], [0.0; 2]), SPIN)
}

/// One ring at the centre of mass; or two ends alike, each of which bears half.
#[test]
fn level_it_is_one_plane() {
    let mount = Support {
        vertical: None, friction: 0.0, stop: Some(Stop::rigid(4e-5)),
        ..MOUNT
    };
    for places in [vec![0.0], vec![-0.1, 0.1]] {
        let ends = places.len();
        let retainers = places.iter().map(|z| retainer(*z, Some(mount), Some(RACE)));
        let whole = machine(retainers.collect());
        let mut have = CoupledReference::new(&whole, &at([2e-5, 0.0], [0.0; 2]), SPIN);
        let parts = ends as f64;
        let mut want = one_plane(MASS / parts, POLAR / parts, mount, RACE);
        let (mut hits, mut wanted) = (Vec::new(), Vec::new());
        let a = have.advance(0.02, &mut |i, it| hits.push((i, it)));
        let b = want.advance(0.02, &mut |i, it| wanted.push((i, it)));
        assert!(impacts(&wanted, 0).len() > 2 && !impacts(&wanted, 1).is_empty());
        for end in 0..ends {
            alike(&impacts(&hits, end), &impacts(&wanted, 0), 1e-9);
            alike(&impacts(&hits, ends + end), &impacts(&wanted, 1), 1e-9);
            close_pair(a.rings[end].position, b.rings[0].position, 1e-9 * CLEARANCE);
            close(a.rings[end].race_spin, b.rings[0].race_spin, 1e-9 * SPIN.abs());
        }
        close_pair(a.position, b.position, 1e-9 * CLEARANCE);
        close(a.spin, b.spin, 1e-10 * SPIN.abs());
    }
}

#[test]
fn bending_rings_at_its_frequency_with_its_damping() {
    let mut whole = machine(vec![retainer(-0.1, None, None)]);
    whole.gravity = [0.0; 2];
    for damping_ratio in [0.0, 0.02, 0.3] {
        let rate = 2.0 * PI * 800.0;
        whole.bending = vec![bending(rate, damping_ratio)];
        let start = CoupledStart {
            bending: vec![[[1e-4, -5e-5], [0.0; 2]]],
            ..CoupledStart::default()
        };
        let mut reference = CoupledReference::new(&whole, &start, 0.0);
        let (decay, damped) = (
            rate * damping_ratio,
            rate * (1.0 - damping_ratio.powi(2)).sqrt(),
        );
        for k in 0..200 {
            let time = f64::from(k) * 1e-4;
            let state = reference.advance(time, &mut |_, _| panic!("no contact"));
            let (sine, cosine) = (damped * time).sin_cos();
            let left = (-decay * time).exp() * (cosine + decay / damped * sine);
            close_pair(
                state.bending[0],
                [1e-4 * left, -5e-5 * left],
                1e-12 * CLEARANCE,
            );
            close_pair(state.position, [0.0; 2], 0.0);
        }
    }
}

/// A whirling unbalance bends the free rotor by the part that it has in the mode.
#[test]
fn unbalance_bends_by_its_part_in_the_mode() {
    let mut whole = machine(vec![retainer(-0.1, None, None)]);
    whole.gravity = [0.0; 2];
    whole.unbalance.eccentricity = 1e-6;
    let rate = 2.0 * PI * 800.0;
    whole.bending = vec![bending(rate, 0.0)];
    let spin = 0.5 * rate;
    let force = MASS * 1e-6 * spin * spin;
    let bent = -0.6 * force / (rate * rate - spin * spin);
    let start = CoupledStart {
        position: [-1e-6, 0.0],
        velocity: [0.0, -1e-6 * spin],
        bending: vec![[[bent, 0.0], [0.0, bent * spin]]],
        ..CoupledStart::default()
    };
    let mut reference = CoupledReference::new(&whole, &start, spin);
    for k in 0..100 {
        let time = f64::from(k) * 1e-4;
        let state = reference.advance(time, &mut |_, _| panic!("no contact"));
        let (sine, cosine) = (spin * time).sin_cos();
        close_pair(
            state.bending[0],
            [bent * cosine, bent * sine],
            1e-11 * CLEARANCE,
        );
        let end = [cosine, sine].map(|c| c * (-1e-6 + 0.8 * bent));
        close_pair(state.displacement(-0.1, &[0.8]), end, 1e-11 * CLEARANCE);
    }
}

/// A magnet with damping: the rotor comes to rest as an oscillator does.
#[test]
fn magnet_damps() {
    let mut whole = machine(vec![retainer(-0.1, None, None)]);
    let magnet = Magnet {
        place: 0.0,
        stiffness: -1e5,
        force: [0.0, 9.81 * MASS],
        damping: 200.0,
        limit: None, on: None,
    };
    whole.magnets = vec![magnet];
    let mut reference = CoupledReference::new(&whole, &at([1e-4, 0.0], [0.0; 2]), 0.0);
    let decay = 100.0 / MASS;
    let rate = (1e5 / MASS - decay * decay).sqrt();
    for k in 0..100 {
        let time = f64::from(k) * 1e-3;
        let state = reference.advance(time, &mut |_, _| panic!("no contact"));
        let (sine, cosine) = (rate * time).sin_cos();
        let left = (-decay * time).exp() * (cosine + decay / rate * sine);
        close_pair(state.position, [1e-4 * left, 0.0], 1e-12 * CLEARANCE);
    }
}

fn whole_machine(restitution: f64) -> CoupledMachine {
    let mount = Support {
        damping: 0.0,
        ..MOUNT
    };
    let mut whole = machine(vec![
        retainer(-0.1, Some(mount), Some(RACE)),
        retainer(0.13, Some(mount), None),
    ]);
    frictionless(&mut whole, restitution);
    whole.bending = vec![bending(2.0 * PI * 800.0, 0.0)];
    whole
}

#[test]
fn elastic_impacts_keep_energy() {
    let whole = whole_machine(1.0);
    let start = at([1e-4, 2e-5], [2e-4, 1e-3]);
    let mut reference = CoupledReference::new(&whole, &start, 0.02 * SPIN);
    let first = reference.advance(0.0, &mut |_, _| {});
    let (first, spin) = (reference.energy(&first), first.spin);
    let mut count = 0;
    let end = reference.advance(0.5, &mut |_, _| count += 1);
    let lost = (reference.energy(&end) - first) / (MASS * 9.81 * CLEARANCE);
    println!("{count} impacts: energy {lost:.1e}");
    assert!(count > 50 && lost.abs() < 1e-10 && end.spin == spin);
}

/// Of rotor and rings, none of which anything holds.
#[test]
fn free_rings_keep_momentum() {
    let mut whole = whole_machine(0.8);
    whole.gravity = [0.0; 2];
    for it in &mut whole.retainers {
        it.mount = Some(Support {
            stiffness: 0.0,
            damping: 0.0,
            ..MOUNT
        });
        it.friction = 0.1;
    }
    let start = CoupledStart {
        velocity: [0.03, 0.04],
        tilt_rate: [0.2, 0.0],
        ..CoupledStart::default()
    };
    let mut reference = CoupledReference::new(&whole, &start, 0.2 * SPIN);
    let mut count = 0;
    let end = reference.advance(0.1, &mut |_, _| count += 1);
    let momentum = [0, 1].map(|k| {
        let rings: f64 = end.rings.iter().map(|ring| ring.velocity[k]).sum();
        MASS * end.velocity[k] + MOUNT.mass * rings
    });
    println!("{count} happenings");
    assert!(count > 10);
    close_pair(momentum, [0.03 * MASS, 0.04 * MASS], 1e-12 * MASS);
}

/// Friction turns rotor and inner ring with opposite arms: J_p w / R + J w_i / (R + c) is kept, and
/// in the end the surfaces run alike.
#[test]
fn inner_rings_spin_up_at_the_rotors_cost() {
    let race = Race {
        inertia: 1e-6,
        dry_drag: 0.0,
        viscous_drag: 0.0,
        ..RACE
    };
    let ends = [-0.1, 0.13].map(|place| retainer(place, Some(MOUNT), Some(race)));
    let mut whole = machine(ends.to_vec());
    whole.bending = vec![bending(2.0 * PI * 800.0, 0.05)];
    let mut reference = CoupledReference::new(&whole, &at([2e-5, 0.0], [0.0; 2]), SPIN);
    let bore = RADIUS + CLEARANCE;
    let kept = POLAR * SPIN / RADIUS;
    for k in 0..=100 {
        let state = reference.advance(f64::from(k) * 3e-3, &mut |_, _| {});
        let races: f64 = state.rings.iter().map(|ring| ring.race_spin).sum();
        close(
            POLAR * state.spin / RADIUS + race.inertia * races / bore,
            kept,
            1e-11 * kept.abs(),
        );
    }
    let end = reference.advance(0.3, &mut |_, _| {});
    for ring in &end.rings {
        close(bore * ring.race_spin / (RADIUS * end.spin), 1.0, 1e-2);
    }
    assert_eq!(reference.given_up(), None);
}

#[test]
fn it_converges() {
    let mut whole = whole_machine(0.6);
    whole
        .retainers
        .iter_mut()
        .for_each(|it| it.friction = 0.1);
    let end = |accuracy: f64| {
        let mut reference =
            CoupledReference::new(&whole, &at([2e-5, 0.0], [1e-4, 0.0]), 0.01 * SPIN);
        reference.set_accuracy(accuracy);
        reference.advance(0.015, &mut |_, _| {}).position
    };
    let truth = end(1e-18);
    let error = |accuracy: f64| {
        let have = end(accuracy);
        f64::hypot(have[0] - truth[0], have[1] - truth[1]) / CLEARANCE
    };
    let errors = [1e-4, 1e-8, 1e-12].map(error);
    println!("{errors:?}");
    assert!(errors[0] > errors[1] && errors[1] > errors[2] && errors[2] < 1e-8);
}
