//! How hard a drop was, from position and speed alone, against the reference.

use touchdown_core::monitor::Monitor;
use touchdown_core::severity::Severity;
use touchdown_sim::forecast_score::scenes;
use touchdown_sim::history::PhaseKind;
use touchdown_sim::scene::Scene;
use touchdown_sim::sensors::{Motion, Sensors};
use touchdown_sim::truth::Truth;

/// Angle of whirl in a sample, rad, beyond which the load is left out: the core's own limit.
const FOLLOWED: f64 = 0.3;

/// Up to the end, or to where whirl is too fast to be followed.
struct Drop {
    seen: Severity,
    impulses: Vec<f64>,
    speeds: Vec<f64>,
    dwell: f64,
    /// Greatest speed of the centre, m/s.
    speed: f64,
    /// Greatest force in contact, once it has gone round, N.
    whirl_load: Option<f64>,
}

fn watch(scene: &Scene, told: &Scene) -> Drop {
    let rate = scene.run.sample_rate;
    let sensors = Sensors::try_new(&scene.sensors, rate).expect("valid sensors");
    let mut chain = sensors.start(scene.run.seed);
    let monitor = Monitor::try_new(&told.monitor_config()).expect("valid configuration");
    let mut state = monitor.start();
    let mut truth = Truth::new(scene);
    let levitated = scene.levitated_samples() as f64;
    let (mut speed, mut load, mut whirl_load, mut end) = (0.0_f64, 0.0_f64, None, 0.0);
    for k in 0..(levitated + scene.run.duration * rate) as u64 {
        let time = (k as f64 - levitated) / rate;
        let at = truth.advance(time);
        let ([x, y], [u, v]) = (at.rotor.position, at.rotor.velocity);
        let radius = f64::hypot(x, y);
        let turn_rate = if radius > 0.0 {
            (x * v - y * u) / (radius * radius)
        } else {
            0.0
        };
        let turns = at.rotor.turns_in_contact.abs();
        if turns == 0.0 {
            load = 0.0;
        } else if turn_rate.abs() > FOLLOWED * rate {
            break;
        } else {
            let (mass, gravity) = (scene.rotor.mass, scene.run.gravity);
            // As at the bottom, where the weight adds to it.
            load = load.max(mass * (radius * turn_rate * turn_rate + gravity));
        }
        if turns >= 1.0 {
            whirl_load = Some(load);
        }
        speed = speed.max(f64::hypot(u, v));
        end = time;
        let motion = Motion {
            planes: at.sensed,
            spin: at.rotor.spin,
            levitated: time < 0.0,
            bearing: None,
        };
        monitor.update(&mut state, &sensors.read(&mut chain, &motion));
    }
    let history = truth.finish().whole;
    let impacts = || history.impacts.iter().filter(|it| it.state.time <= end);
    let contact = [PhaseKind::Sliding, PhaseKind::Rolling];
    let contacts = history
        .phases
        .iter()
        .filter(|it| contact.contains(&it.phase));
    Drop {
        seen: *state.severity(),
        impulses: impacts().map(|it| it.normal_impulse).collect(),
        speeds: impacts().map(|it| it.normal_speed).collect(),
        dwell: contacts
            .map(|it| (it.end_s.min(end) - it.start_s).max(0.0))
            .sum(),
        speed,
        whirl_load,
    }
}

fn of_scene(name: &str) -> Drop {
    let scene = Scene::load(name).expect("built-in scene");
    watch(&scene, &scene)
}

fn random(drops: u64, misled: f64) -> impl Iterator<Item = (u64, Scene, Drop)> {
    (0..drops).map(move |seed| {
        let [scene, told] = scenes(5000 + seed, misled).expect("a valid scene");
        let drop = watch(&scene, &told);
        (seed, scene, drop)
    })
}

fn off(seen: f32, truth: f64) -> f64 {
    f64::from(seen) / truth - 1.0
}

fn largest(values: &[f64]) -> f64 {
    values.iter().copied().fold(0.0, f64::max)
}

fn quantile(mut values: Vec<f64>, part: f64) -> f64 {
    values.sort_by(f64::total_cmp);
    values[(part * (values.len() - 1) as f64) as usize]
}

#[test]
fn impulses_are_right_to_10_percent() {
    for name in ["rig", "rig-wide-gap", "rolling"] {
        let drop = of_scene(name);
        let (greatest, sum) = (largest(&drop.impulses), drop.impulses.iter().sum());
        println!("{name}: {:?}, truth {greatest} and {sum} N s", drop.seen);
        assert!(off(drop.seen.impulse, greatest).abs() < 0.02, "{name}");
        assert!(off(drop.seen.total_impulse, sum).abs() < 0.1, "{name}");
        assert!(
            off(drop.seen.impact_speed, largest(&drop.speeds)).abs() < 0.02,
            "{name}"
        );
    }
    let mut sums = Vec::new();
    for (seed, scene, drop) in random(200, 0.0) {
        let greatest = largest(&drop.impulses);
        if greatest < 0.018 * scene.rotor.mass {
            continue;
        }
        // The worst of 600 was off by 2.4 %.
        let off_by = off(drop.seen.impulse, greatest);
        assert!(off_by.abs() < 0.1, "{seed}: {off_by}");
        sums.push(off(drop.seen.total_impulse, drop.impulses.iter().sum()).abs());
    }
    assert!(sums.len() > 150, "{}", sums.len());
    // The sum lives of impacts that no sensor sees: nine in ten are right to 10 %, some are far off.
    let tenth = quantile(sums, 0.9);
    assert!(tenth < 0.1, "{tenth}");
}

#[test]
fn a_restitution_told_wrong_is_unlearnt() {
    let mut errors = Vec::new();
    for (_, scene, drop) in random(100, 0.3) {
        let greatest = largest(&drop.impulses);
        if greatest >= 0.018 * scene.rotor.mass {
            errors.push(off(drop.seen.impulse, greatest).abs());
        }
    }
    // 1 + restitution, told wrong, would be off by up to 14 %.
    let tenth = quantile(errors, 0.9);
    assert!(tenth < 0.1, "{tenth}");
}

#[test]
fn whirl_load_is_right_to_5_percent() {
    let whirl = of_scene("backward-whirl");
    let truth = whirl.whirl_load.expect("it goes round");
    println!("backward-whirl: {:?}, truth {truth} N", whirl.seen);
    assert!(off(whirl.seen.whirl_load, truth).abs() < 0.05);
    let mut whirls = 0;
    for (seed, _, drop) in random(200, 0.0) {
        let Some(truth) = drop.whirl_load else {
            continue;
        };
        let off_by = off(drop.seen.whirl_load, truth);
        assert!(off_by.abs() < 0.05, "{seed}: {off_by} of {truth} N");
        whirls += 1;
    }
    assert!(whirls > 30, "{whirls}");
}

#[test]
fn dwell_and_velocity_index() {
    for name in ["rig", "rig-wide-gap", "rolling"] {
        let scene = Scene::load(name).expect("built-in scene");
        let drop = watch(&scene, &scene);
        // As permanent contact is dated: to 1 ms.
        let late = f64::from(drop.seen.dwell) - drop.dwell;
        assert!(late.abs() < 1e-3, "{name}: {late}");
        let unit = (scene.run.gravity * scene.retainer.clearance).sqrt();
        let off_by = off(drop.seen.velocity_index, drop.speed / unit);
        assert!(off_by.abs() < 0.03, "{name}: {off_by}");
    }
}

#[test]
fn nothing_before_the_first_drop() {
    let mut scene = Scene::load("rig").expect("built-in scene");
    scene.run.duration = 1e-3;
    scene.run.seed = 3;
    let drop = watch(&scene, &scene);
    assert_eq!(
        (drop.seen.impacts, drop.seen.impulse, drop.seen.dwell),
        (0, 0.0, 0.0)
    );
}
