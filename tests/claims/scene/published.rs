//! The built-in machines against what is published of them. Levitation is not simulated: its modes are those
//! of the scene's mass on the published stiffness.

use std::f64::consts::TAU;

use touchdown_scene::Scene;
use touchdown_truth::Truth;

fn scene(name: &str) -> Scene {
    Scene::load(name).expect("built in")
}

/// Says both, and by what part ours is off.
fn off(what: &str, ours: f64, published: f64) -> f64 {
    let off = ours / published - 1.0;
    println!("{what}: {ours:.4}, published {published}, off by {:.1} %", 100.0 * off);
    off
}

/// The controller of 5000 A/m at 50 N/A, less the magnets' own 1e5 N/m, on both ends.
#[test]
fn the_thin_shaft_floats_slower_than_measured() {
    let stiffness = 2.0 * (5000.0 * 50.0 - 1e5);
    let rate = (stiffness / scene("tum-mbtr").rotor.mass).sqrt() / TAU;
    let off = off("tum-mbtr, levitated mode, Hz", rate, 52.013);
    assert!((-0.08..-0.06).contains(&off), "{off}");
}

/// The drag of the scene is derived from it: this holds inertia, speed and drag together.
#[test]
fn the_flywheel_coasts_down_in_its_time() {
    let scene = scene("vycon");
    let rings = &scene.two_plane.as_ref().expect("two ends").rings;
    let drags = rings.iter().filter_map(|it| it.ball_bearing);
    let drag: f64 = drags.map(|it| it.dry_drag).sum();
    let hours = scene.rotor.polar_inertia * scene.rotor.spin / drag / 3600.0;
    let off = off("vycon, coast-down, h", hours, 2.75);
    assert!(off.abs() < 0.03, "{off}");
}

/// The passive magnet, 4957 N/m at the contact, is not in the scene.
#[test]
fn the_rotor_on_a_pivot_resonates_where_it_should() {
    let rate = (4957.0 / scene("dtu").rotor.mass).sqrt() / TAU;
    let off = off("dtu, resonance, Hz", rate, 18.05);
    assert!(off.abs() < 1e-3, "{off}");
}

/// Trip at 100 um, landing at 120 um, against a free fall without unbalance. The rotor is released at rest: its
/// unbalance first throws it up.
#[test]
fn the_chiller_falls_to_its_thresholds_in_time() {
    let scene = scene("york-ymc2");
    for (threshold, free_fall) in [(100e-6, 4.52), (120e-6, 4.95)] {
        let mut truth = Truth::new(&scene);
        let mut samples = (0..).map(|k| f64::from(k) * 1e-5);
        let passed = samples.find(|time| {
            let [x, y] = truth.advance(*time).sensed[0];
            x.hypot(y) >= threshold
        });
        let ms = 1e3 * passed.expect("it falls");
        let off = off(&format!("york-ymc2, at {:.0} um, ms", 1e6 * threshold), ms, free_fall);
        assert!((0.0..0.06).contains(&off), "{off}");
    }
}
