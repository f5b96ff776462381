//! Straight impacts on rung `hertz`: the restitution that comes out of force and damping, against the
//! one that was asked for.

use touchdown_rotor::error::ConfigError;

use crate::limits::extreme::free;
use crate::limits::row::Row;
use crate::limits::{PRECISIONS, refused};
use touchdown_base::failure::Failure;
use touchdown_base::machine::Start;
use touchdown_run::model::simulate;
use touchdown_scene::scales::compliance;
use touchdown_scene::{Fidelity, Precision, Scene, Scheme};

/// Asked for, as given (`docs/know/model.md`: below 0.02 it is 0.02), and in words.
const ASKED: [(f64, f64, &str); 4] = [
    (0.0, 0.02, "0, which is 0.02"),
    (0.8, 0.8, "0.8"),
    (0.99, 0.99, "0.99"),
    (1.0, 1.0, "1"),
];
/// What it may be off at T_c/25 (`docs/know/model.md`), relative.
const LIMIT: f64 = 5e-3;
/// m.
const GAPS: [f64; 3] = [10e-6, 0.3e-3, 2e-3];
/// Parts of a step at which the wall may be reached.
const PHASES: u32 = 8;
/// Of a contact, s over T_c: at 0.02 the rotor creeps out.
const LONGEST: f64 = 100.0;

/// All of them in either precision.
pub fn rows() -> Result<Vec<Row>, Failure> {
    let rig = Scene::load("rig")?;
    let mut rows = Vec::new();
    for (asked, given, words) in ASKED {
        for precision in PRECISIONS {
            let worst = worst(&rig, asked, given, precision).map_err(refused)?;
            let name = format!("hertz: straight impact, restitution {words}: restitution");
            rows.push(Row::of(name, precision).at_most(worst, LIMIT, "relative"));
        }
    }
    Ok(rows)
}

fn worst(rig: &Scene, asked: f64, given: f64, precision: Precision) -> Result<f64, ConfigError> {
    let mut worst = 0.0_f64;
    for gap in GAPS {
        for &scheme in Fidelity::Hertz.schemes() {
            let mut scene = straight(rig, gap, asked);
            scene.model.precision = precision;
            for phase in 0..PHASES {
                let error = (bounce(&mut scene, scheme, phase)? / given - 1.0).abs();
                // NaN is the worst there is.
                worst = if error <= worst { worst } else { error };
            }
        }
    }
    Ok(worst)
}

fn straight(rig: &Scene, gap: f64, restitution: f64) -> Scene {
    let mut scene = rig.clone();
    let speed = (2.0 * scene.run.gravity * gap).sqrt();
    scene.rotor.spin = 0.0;
    scene.retainer.clearance = gap;
    scene.retainer.friction = 0.0;
    scene.retainer.restitution = restitution;
    scene.run.gravity = 0.0;
    scene.model.rung = Fidelity::Hertz;
    scene.start = free([0.0; 2], [0.0, -speed]);
    scene
}

/// Speed out of the first contact over that into it, at T_c/25; no number where there is none.
fn bounce(scene: &mut Scene, scheme: Scheme, phase: u32) -> Result<f64, ConfigError> {
    let stiff = compliance(scene)?;
    scene.model.scheme = scheme;
    scene.model.step = stiff.accurate_step();
    scene.run.duration = LONGEST * stiff.contact_time;
    if let Start::Free { position, velocity } = &mut scene.start {
        let steps = 2.0 + f64::from(phase) / f64::from(PHASES);
        position[1] = -steps * scene.model.step * velocity[1] - scene.retainer.clearance;
    }
    let history = simulate(scene)?;
    let first = history.impacts.first().filter(|it| it.pulse.is_some());
    Ok(first.map_or(f64::NAN, |it| it.state.velocity[1] / it.normal_speed))
}
