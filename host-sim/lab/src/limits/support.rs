//! The extremes of a retainer that gives way or turns.

use std::f64::consts::TAU;

use super::extreme::free;
use touchdown_base::input_error::InputError;
use touchdown_models::RaceConfig;
use touchdown_scene::{BallBearing, Model, Scene, Stop, Support};

type Change = fn(&mut Scene);

/// Name, and what differs from the rig on the support of the scene `soft-support`.
const EXTREMES: [(&str, Change); 20] = [
    ("as it is", |_| ()),
    ("support nearly rigid", |s| on(s, |it| it.stiffness = 1e12)),
    ("support of 1000 N/m", |s| {
        on(s, |it| {
            it.stiffness = 1e3;
            it.stop = None;
        });
    }),
    ("undamped", |s| on(s, |it| it.damping = 0.0)),
    ("damped a thousandfold", |s| on(s, |it| it.damping *= 1e3)),
    ("ring of 1 mg", |s| on(s, |it| it.mass = 1e-6)),
    ("ring of 1 t", |s| on(s, |it| it.mass = 1e3)),
    ("hard stop after 1 um", |s| stopped(s, None)),
    ("soft stop after 1 um", |s| stopped(s, Some(1e8))),
    ("restitution 0", |s| s.retainer.restitution = 0.0),
    ("restitution 1 without friction", |s| {
        s.retainer.restitution = 1.0;
        s.retainer.friction = 0.0;
    }),
    ("friction 2", |s| s.retainer.friction = 2.0),
    ("no spin", |s| s.rotor.spin = 0.0),
    ("spin of 1 000 000 rpm", |s| s.rotor.spin = 1e6 * TAU / 60.0),
    ("no gravity", |s| {
        s.run.gravity = 0.0;
        s.start = free([0.05e-3, 0.1e-3], [0.02, -0.1]);
    }),
    ("gap of 20 um", |s| {
        s.retainer.clearance = 20e-6;
        s.start = free([0.0; 2], [0.0; 2]);
    }),
    ("inner ring without inertia", |s| turning(s, 1e-12)),
    ("inner ring of 1000 kg m^2", |s| turning(s, 1e3)),
    ("inner ring on a sprung support", |s| {
        let support = s.support;
        turning(s, 3e-5);
        s.support = support;
    }),
    ("inner ring held by drag", |s| {
        turning(s, 3e-5);
        if let Some(bearing) = &mut s.ball_bearing {
            bearing.race.dry_drag = 1e3;
        }
    }),
];

fn on(scene: &mut Scene, change: impl Fn(&mut Support)) {
    if let Some(support) = &mut scene.support {
        change(support);
    }
}

/// After 1 um by a stop of this stiffness, N/m.
fn stopped(scene: &mut Scene, stiffness: Option<f64>) {
    let travel = 1e-6;
    on(scene, |it| it.stop = Some(Stop { travel, stiffness }));
}

/// On a fixed support, with an inner ring of this inertia, kg m^2.
fn turning(scene: &mut Scene, inertia: f64) {
    scene.support = None;
    scene.ball_bearing = Some(BallBearing {
        race: RaceConfig {
            inertia,
            dry_drag: 0.005,
            viscous_drag: 1e-5,
            cage_ratio: 0.4,
            heat_capacity: 50.0,
            heat_loss: 0.5,
        },
        stiffness: None,
        marks: [None; 2],
    });
}

pub fn scenes() -> Result<Vec<(&'static str, Scene)>, InputError> {
    let soft = Scene::load("soft-support")?;
    let rig = Scene::load("rig")?;
    let made = EXTREMES.iter().map(|(name, change)| {
        let mut scene = Scene {
            model: Model {
                step: rig.model.step,
                ..soft.model
            },
            support: soft.support,
            ..rig.clone()
        };
        change(&mut scene);
        (*name, scene)
    });
    Ok(made.collect())
}
