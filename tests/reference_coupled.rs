//! The reference for coupled systems against the planar reference, closed forms and what is kept.

use std::f64::consts::PI;
use touchdown_sim::history::{Happening, Impact};
use touchdown_sim::reference::coupled::{
    Mode, Mount, Race, SupportMachine, SupportReference, SupportStart,
};
use touchdown_sim::reference::{Machine, Reference, Start};

const RIG: Machine = Machine {
    mass: 3.42,
    radius: 0.024,
    polar_inertia: 0.000_984_96,
    clearance: 0.0003,
    friction: 0.1,
    restitution: 0.8,
    gravity: 9.81,
};
const SPIN: f64 = 1000.0 * PI;

fn free(position: [f64; 2], velocity: [f64; 2]) -> Start {
    Start::Free { position, velocity }
}

/// Worst of the impacts' differences: time, position and speed in units of the scale law, spin as
/// surface speed.
fn difference(a: &Impact, b: &Impact) -> f64 {
    let time = (RIG.clearance / RIG.gravity).sqrt();
    let speed = RIG.clearance / time;
    let (a, b) = (a.state, b.state);
    let mut worst = ((a.time - b.time) / time).abs();
    for k in 0..2 {
        worst = worst.max(((a.position[k] - b.position[k]) / RIG.clearance).abs());
        worst = worst.max(((a.velocity[k] - b.velocity[k]) / speed).abs());
    }
    worst.max((RIG.radius * (a.spin - b.spin) / speed).abs())
}

#[test]
fn without_support_it_is_the_planar_reference() {
    for (friction, restitution, spin, position, end) in [
        (0.1, 0.8, -SPIN, [2e-5, 0.0], 0.3),
        (0.1, 0.8, SPIN, [-1e-4, 1e-4], 0.3),
        (0.1, 0.8, -10.0 * PI, [2e-5, 0.0], 0.8),
        (0.3, 0.5, 0.0, [1e-4, 0.0], 0.4),
        (0.2, 0.0, -SPIN, [1e-4, 5e-5], 0.2),
        (0.4, 0.7, -SPIN, [1e-4, 5e-5], 0.2),
    ] {
        let machine = Machine {
            friction,
            restitution,
            ..RIG
        };
        let start = free(position, [0.0; 2]);
        let mut expected = Vec::new();
        let planar = Reference::new(&machine, &start, spin)
            .advance(end, &mut |happening| expected.push(happening));
        let support = SupportMachine {
            rotor: machine,
            mount: None,
            race: None,
        };
        let mut reference = SupportReference::new(&support, &SupportStart::new(start, spin));
        let mut found = Vec::new();
        let clock = std::time::Instant::now();
        let state = reference.advance(end, &mut |_, happening| found.push(happening));
        println!("took {:?}", clock.elapsed());
        let impacts = |list: &[Happening]| {
            let impact = |h: &Happening| match h {
                Happening::Impact(i) => Some(*i),
                _ => None,
            };
            list.iter().filter_map(impact).collect::<Vec<_>>()
        };
        let (a, b) = (impacts(&expected), impacts(&found));
        let worst = a
            .iter()
            .zip(&b)
            .map(|(a, b)| difference(a, b))
            .collect::<Vec<_>>();
        println!(
            "{} {} {} {} {:?}",
            expected.len(),
            found.len(),
            a.len(),
            b.len(),
            worst.iter().copied().fold(0.0, f64::max)
        );
        println!(
            "{:?}\n{:?}",
            expected
                .iter()
                .filter(|h| !matches!(h, Happening::Impact(_)))
                .collect::<Vec<_>>(),
            found
                .iter()
                .filter(|h| !matches!(h, Happening::Impact(_)))
                .collect::<Vec<_>>()
        );
        println!(
            "{planar:?}\n{:?} {:?} {} {} {:?}",
            state.position, state.velocity, state.spin, state.turns_in_contact, state.modes
        );
    }
}
