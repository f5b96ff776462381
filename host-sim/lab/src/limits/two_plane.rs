//! The extremes of a rotor that tilts.

use std::f64::consts::TAU;

use touchdown_base::input_error::InputError;
use touchdown_scene::{Magnet, Retainer, Scene, TwoPlane};

type Change = fn(&mut Scene, &mut TwoPlane);

/// Name, and what differs from the scene `two-plane`.
const EXTREMES: [(&str, Change); 18] = [
    ("as it is", |_, _| ()),
    ("nearly a needle", |s, it| {
        it.transverse_inertia = 1e4 * s.rotor.polar_inertia
    }),
    ("a thin disc", |s, it| {
        it.transverse_inertia = 0.5 * s.rotor.polar_inertia;
        it.rings.iter_mut().for_each(|ring| ring.place *= 0.1);
    }),
    ("one end high, one low", |_, it| it.tilt = [0.0, 2.4e-3]),
    ("one end next to its wall", |_, it| {
        it.tilt = [0.0, -2.49e-3]
    }),
    ("one ring, at the centre of mass", |_, it| {
        it.rings.truncate(1);
        it.rings[0].place = 0.0;
    }),
    ("one ring, beyond the other end", |_, it| {
        it.rings.truncate(1);
        it.rings[0].place = -0.3;
        it.tilt = [0.0; 2];
    }),
    ("four rings of one gap", |_, it| {
        let ring = it.rings[0].clone();
        it.rings = vec![ring; 4];
        let places = [-0.12, -0.04, 0.05, 0.12];
        (it.rings.iter_mut().zip(places)).for_each(|(ring, place)| ring.place = place);
    }),
    ("restitution 0", |_, it| {
        each_ring(it, |r| r.restitution = 0.0)
    }),
    ("restitution 1 without friction", |_, it| {
        each_ring(it, |r| {
            r.restitution = 1.0;
            r.friction = 0.0;
        });
    }),
    ("friction 2", |_, it| each_ring(it, |r| r.friction = 2.0)),
    ("no spin", |s, _| s.rotor.spin = 0.0),
    ("spin of 1 000 000 rpm", |s, it| {
        s.rotor.spin = 1e6 * TAU / 60.0;
        it.unbalance.eccentricity = 0.0;
    }),
    ("unbalance of 1 mm g a gram of rotor", |s, it| {
        it.unbalance.eccentricity = 3.42e-3 * 1e-1 / s.rotor.mass;
    }),
    ("principal axis 1 mrad askew", |_, it| {
        (it.unbalance.skew, it.unbalance.skew_angle) = (1e-3, 1.0);
    }),
    ("magnets that pull with ten times the weight", |s, it| {
        it.magnets = magnets(10.0 * s.rotor.mass * 9.81 / 0.3e-3);
    }),
    ("magnets that hold as much", |s, it| {
        it.magnets = magnets(-10.0 * s.rotor.mass * 9.81 / 0.3e-3);
    }),
    ("vertical", |s, it| {
        s.run.gravity = 0.0;
        it.tilt_rate = [0.1, 0.0];
    }),
];

fn each_ring(machine: &mut TwoPlane, change: impl Fn(&mut Retainer)) {
    for ring in &mut machine.rings {
        change(&mut ring.retainer);
    }
}

/// Half the stiffness (N/m) at each end.
fn magnets(stiffness: f64) -> Vec<Magnet> {
    let magnet = |place| Magnet {
        place,
        stiffness: 0.5 * stiffness,
        damping: 0.0,
        force: [0.0; 2],
        limit: None,
        on: None,
    };
    vec![magnet(-0.1), magnet(0.1)]
}

pub fn scenes() -> Result<Vec<(&'static str, Scene)>, InputError> {
    let rig = Scene::load("two-plane")?;
    let made = EXTREMES.iter().map(|(name, change)| {
        let mut scene = rig.clone();
        if let Some(mut machine) = scene.two_plane.take() {
            change(&mut scene, &mut machine);
            scene.two_plane = Some(machine);
        }
        (*name, scene)
    });
    Ok(made.collect())
}
