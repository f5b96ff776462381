//! What is published of the built-in machines, against the numbers of their scenes. No drop of any of them is. The program
//! does not simulate levitation: its frequencies are those of springs on the scene's rotor.

use std::f64::consts::TAU;

use serde_json::Value;
use tempfile::TempDir;
use touchdown_scene::{Scene, TwoPlane};
use touchdown_tests::binary::touchdown;

fn machine(name: &str) -> (Scene, TwoPlane) {
    let scene = Scene::load(name).expect("built-in scene");
    let two_plane = scene.two_plane.clone().expect("two planes");
    (scene, two_plane)
}

fn row(what: &str, published: f64, ours: f64) {
    let off = 100.0 * (ours / published - 1.0);
    println!("| {what} | {published} | {ours:.4} | {off:+.1} % |");
}

fn assert_near(ours: f64, expected: f64, tolerance: f64) {
    assert!(
        (ours / expected - 1.0).abs() <= tolerance,
        "{ours} {expected}"
    );
}

/// Stiffness and mass of the rotor with some of its modes on springs (N/m) at two places, m.
fn on_springs(
    scene: &Scene,
    it: &TwoPlane,
    modes: usize,
    spring: f64,
    places: [f64; 2],
) -> (Vec<Vec<f64>>, Vec<f64>) {
    let modes = &it.modes[..modes];
    let mut mass = vec![scene.rotor.mass, it.transverse_inertia];
    mass.extend(modes.iter().map(|mode| mode.mass));
    let mut stiffness = vec![vec![0.0; mass.len()]; mass.len()];
    for (k, mode) in modes.iter().enumerate() {
        stiffness[k + 2][k + 2] = mode.mass * mode.speed * mode.speed;
    }
    for place in places {
        let mut at = vec![1.0, place];
        at.extend(modes.iter().map(|mode| mode.at(place)));
        for (i, row) in stiffness.iter_mut().enumerate() {
            for (j, value) in row.iter_mut().enumerate() {
                *value += spring * at[i] * at[j];
            }
        }
    }
    (stiffness, mass)
}

/// How many natural frequencies are below `hertz`: negative pivots of K - w^2 M.
fn below((stiffness, mass): &(Vec<Vec<f64>>, Vec<f64>), hertz: f64) -> usize {
    let (mut a, n) = (stiffness.clone(), mass.len());
    for (k, mass) in mass.iter().enumerate() {
        a[k][k] -= (TAU * hertz).powi(2) * mass;
    }
    for k in 0..n {
        for i in k + 1..n {
            let factor = a[i][k] / a[k][k];
            let pivot_row = a[k].clone();
            for (value, pivot) in a[i].iter_mut().zip(pivot_row) {
                *value -= factor * pivot;
            }
        }
    }
    (0..n).filter(|&k| a[k][k] < 0.0).count()
}

/// The `index`-th natural frequency, Hz.
fn natural(system: &(Vec<Vec<f64>>, Vec<f64>), index: usize) -> f64 {
    let (mut low, mut high) = (0.0, 1e4);
    for _ in 0..60 {
        let middle = 0.5 * (low + high);
        let more = below(system, middle) > index;
        (low, high) = if more { (low, middle) } else { (middle, high) };
    }
    high
}

/// The source measured 52.013 Hz at P = 5000 and takes it for a rigid rotor on two springs. Its gains give 1.5e5 N/m; its
/// estimate for the bending rotor is 1.1e5.
#[test]
fn the_levitated_mode_of_munich() {
    let (scene, it) = machine("tum-mbtr");
    let places = [-0.252, 0.258];
    let published = 52.013;
    let of_gains = 5000.0 * 50.0 - 1e5;
    let rigid = natural(&on_springs(&scene, &it, 0, of_gains, places), 0);
    assert_near(
        rigid,
        (2.0 * of_gains / scene.rotor.mass).sqrt() / TAU,
        1e-3,
    );
    let bent = natural(&on_springs(&scene, &it, 3, of_gains, places), 1);
    let soft = natural(&on_springs(&scene, &it, 3, 1.1e5, places), 1);
    row("tum-mbtr, Hz: rigid, gains", published, rigid);
    row("tum-mbtr, Hz: bending, gains", published, bent);
    row("tum-mbtr, Hz: bending, 1.1e5 N/m", published, soft);
    assert_near(rigid, published, 0.08);
    assert_near(soft, published, 0.04);
    // A miss: above the first bending mode the rotor is not one mass.
    assert!((0.15..0.25).contains(&(bent / published - 1.0)), "{bent}");
    // Below it lies the first bending mode, which no spring at the magnets lifts above 22 Hz.
    assert!(natural(&on_springs(&scene, &it, 3, of_gains, places), 0) < 22.38);
}

/// Three spin-downs from full speed took 2.75 h. The drag is derived from them, so this checks the scene alone.
#[test]
fn the_coast_down_of_vycon() {
    let (scene, it) = machine("vycon");
    let bearings = it
        .rings
        .iter()
        .filter_map(|ring| ring.ball_bearing.as_ref());
    let drag: f64 = bearings.map(|bearing| bearing.race.dry_drag).sum();
    let hours = scene.rotor.polar_inertia * scene.rotor.spin / drag / 3600.0;
    row("vycon, h", 2.75, hours);
    assert_near(hours, 2.75, 0.03);
}

/// Magnet ring and inertia about the pivot, of the source, give 18.05 Hz; it was run at 17 and 18.9 Hz.
#[test]
fn the_resonance_of_dtu() {
    let (scene, it) = machine("dtu");
    let spring: f64 = it.magnets.iter().map(|magnet| -magnet.stiffness).sum();
    let hertz = (spring / scene.rotor.mass).sqrt() / TAU;
    row("dtu, Hz", 18.05, hertz);
    assert_near(hertz, 18.05, 1e-3);
}

/// York trips at 100 um and counts a landing beyond 120 um. Balanced, the rotor falls freely to both.
#[test]
fn the_thresholds_of_york() {
    let text = Scene::text("york-ymc2").expect("built in").into_owned();
    let text = text.replace("unbalance_g_mm = 67.0", "unbalance_g_mm = 0.0");
    let text = text.replace("duration_s = 0.3", "duration_s = 0.02");
    let scene = Scene::parse("york.toml", &text).expect("valid");
    let fall = |way: f64| 1e3 * (2.0 * way / scene.run.gravity).sqrt();
    row(
        "york-ymc2, um: trip",
        100.0,
        2e6 / 3.0 * scene.retainer.clearance,
    );
    row(
        "york-ymc2, um: landing",
        120.0,
        0.8e6 * scene.retainer.clearance,
    );
    row("york-ymc2, ms: fall to the trip", 4.52, fall(100e-6));
    row("york-ymc2, ms: fall to a landing", 4.95, fall(120e-6));
    let folder = TempDir::new().unwrap();
    std::fs::write(folder.path().join("york.toml"), text).unwrap();
    touchdown(folder.path())
        .args(["drop", "york.toml", "--json", "a.json"])
        .assert()
        .success();
    let json = std::fs::read_to_string(folder.path().join("a.json")).unwrap();
    let json: Value = serde_json::from_str(&json).unwrap();
    let alarms = json["controller"]["alarms"].as_array().unwrap();
    let danger = alarms.iter().find(|alarm| alarm["level"] == "danger");
    let told = 1e3 * danger.expect("danger")["time_s"].as_f64().unwrap();
    row("york-ymc2, ms: the guard tells danger", 4.52, told);
    // Three quarters of a millisecond must be beyond it.
    assert!((0.7..0.8).contains(&(told - fall(100e-6))), "{told}");
    let impact = 1e3 * json["impacts"][0]["time_s"].as_f64().unwrap();
    let [x, gap] = [7.5e-6_f64, scene.retainer.clearance];
    assert_near(impact, fall((gap * gap - x * x).sqrt()), 1e-5);
}
