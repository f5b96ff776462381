//! What a healthy machine does, and must not set the detector off.

use touchdown_core::event::{EventKind, Level, Notice};
use touchdown_core::monitor::MonitorConfig;
use touchdown_core::severity::Severity;
use touchdown_run::controller_trace::MonitorOutput;
use touchdown_scene::Scene;
use touchdown_scene::sensors::{Motion, Sensors};
use touchdown_tests::monitor_run;

const CLEARANCE: f64 = 0.3e-3;

/// Runs a motion (position in m by time in s) through the default sensors and the monitor.
fn watched(seconds: f64, position: impl Fn(f64) -> [f64; 2]) -> Vec<Notice> {
    let scene = Scene::load("rig").expect("built-in scene");
    watched_in(&scene, seconds, position)
}

fn watched_in(scene: &Scene, seconds: f64, position: impl Fn(f64) -> [f64; 2]) -> Vec<Notice> {
    output_in(scene, seconds, position).notices
}

fn output_in(scene: &Scene, seconds: f64, position: impl Fn(f64) -> [f64; 2]) -> MonitorOutput {
    let rate = scene.run.sample_rate;
    let config: MonitorConfig = scene.monitor_config();
    let sensors = Sensors::try_new(&scene.sensors, rate).expect("default sensors");
    let mut state = sensors.start(7);
    let samples = (0..(seconds * rate) as u64).map(|k| {
        let motion = Motion {
            planes: [position(k as f64 / rate); 2],
            spin: scene.rotor.spin,
            levitated: true,
            bearing: None,
        };
        sensors.read(&mut state, &motion)
    });
    monitor_run::run(&config, samples).expect("valid")
}

fn kinds(notices: &[Notice]) -> Vec<EventKind> {
    let declared = |notice: &Notice| match notice {
        Notice::Declared(event) => Some(event.kind),
        _ => None,
    };
    notices.iter().filter_map(declared).collect()
}

#[test]
fn what_floats_goes_through_nothing() {
    let scene = Scene::load("rig").expect("built-in scene");
    let orbit = |t: f64| [30e-6 * (3_000.0 * t).cos(), 30e-6 * (3_000.0 * t).sin()];
    let output = output_in(&scene, 0.3, orbit);
    assert_eq!(output.severity, Severity::default());
}

/// From 0 to 1 with no jump of acceleration.
fn smooth(t: f64) -> f64 {
    let t = t.clamp(0.0, 1.0);
    t * t * t * (10.0 - 15.0 * t + 6.0 * t * t)
}

#[test]
fn nothing_in_five_minutes_of_levitation() {
    let at_alert = [0.0, -0.5 * CLEARANCE];
    for place in [[0.0, 0.0], [20e-6, -60e-6], at_alert] {
        let mut notices = watched(100.0, |_| place);
        if place == at_alert {
            // It is where the guard's lower limit is: each plane may tell that once, and nothing else.
            let is_alert = |it: &Notice| matches!(it, Notice::Alarm(it) if it.level == Level::Alert);
            assert!(notices.iter().filter(|it| is_alert(it)).count() <= 2);
            notices.retain(|it| !is_alert(it));
        }
        assert!(notices.is_empty(), "{place:?}: {notices:?}");
    }
}

#[test]
fn lifted_from_rest_on_the_bearing() {
    // At rest for 0.5 s, then lifted to the centre within 0.2 s, then floating.
    let notices = watched(1.5, |t| [0.0, -CLEARANCE * (1.0 - smooth((t - 0.5) / 0.2))]);
    let kinds = kinds(&notices);
    println!("{kinds:?}");
    let expected = [
        EventKind::Sliding,
        EventKind::Rest,
        EventKind::LiftOff,
        EventKind::Levitated,
    ];
    assert_eq!(kinds, expected);
}

/// Height above the bottom of the wall, m, of a straight drop with restitution 0.8, s after release.
fn straight_drop(mut time: f64) -> f64 {
    let mut fall = (2.0 * CLEARANCE / 9.81).sqrt();
    if time <= fall {
        return CLEARANCE - 0.5 * 9.81 * time * time.max(0.0);
    }
    time -= fall;
    for _ in 0..60 {
        fall *= 0.8;
        if time < 2.0 * fall {
            return 9.81 * time * (fall - 0.5 * time);
        }
        time -= 2.0 * fall;
    }
    0.0
}

#[test]
fn a_drop_before_arming_is_found() {
    let notices = watched(0.5, |t| [0.0, straight_drop(t - 0.02) - CLEARANCE]);
    let kinds = kinds(&notices);
    for kind in [EventKind::FreeFall, EventKind::Impact, EventKind::Sliding] {
        assert!(kinds.contains(&kind), "{kinds:?}");
    }
}

#[test]
fn a_rotor_that_lies_still_without_spin_rolls_and_rests() {
    let mut scene = Scene::load("rig").expect("built-in scene");
    scene.rotor.spin = 0.0;
    let kinds = kinds(&watched_in(&scene, 1.0, |_| [0.0, -CLEARANCE]));
    assert_eq!(kinds, [EventKind::Rolling, EventKind::Rest]);
}

#[test]
fn a_drop_after_being_lifted_is_found() {
    let fall = |t: f64| 0.5 * 9.81 * t * t;
    let notices = watched(1.5, |t| {
        let lifted = -CLEARANCE * (1.0 - smooth((t - 0.2) / 0.2));
        let fallen = if t > 1.2 { fall(t - 1.2) } else { 0.0 };
        [0.0, (lifted - fallen).max(-CLEARANCE)]
    });
    let kinds = kinds(&notices);
    assert!(kinds.contains(&EventKind::FreeFall), "{kinds:?}");
}

#[test]
fn motion_before_arming_does_not_deafen() {
    // Brought to the centre within 0.3 s, then floating; released at 1 s.
    let notices = watched(1.02, |t| {
        let lift = 150e-6 * (smooth(t / 0.3) - 1.0);
        [lift, straight_drop(t - 1.0) - CLEARANCE]
    });
    let declared = notices.iter().find_map(|notice| match notice {
        Notice::Declared(event) if event.kind == EventKind::FreeFall => Some(event.declared),
        _ => None,
    });
    let latency = declared.expect("declared") as f64 / 20_000.0 - 1.0;
    assert!(latency > 0.0 && latency < 1.2e-3, "{latency}");
}

/// Unbalance: the rotor's centre on a circle.
fn orbit(frequency: f64, radius: f64) -> impl Fn(f64) -> [f64; 2] {
    move |t| {
        let (sin, cos) = (std::f64::consts::TAU * frequency * t).sin_cos();
        [radius * cos, radius * sin]
    }
}

#[test]
fn an_unbalance_orbit_is_no_fall() {
    for (frequency, radius) in [
        (10.0, 30e-6),
        (20.0, 2e-6),
        (50.0, 1e-6),
        (50.0, 30e-6),
        (100.0, 5e-6),
        (150.0, 30e-6),
        (500.0, 30e-6),
    ] {
        let notices = watched(10.0, orbit(frequency, radius));
        assert!(
            notices.is_empty(),
            "{frequency} Hz {radius:e} m: {notices:?}"
        );
    }
}

#[test]
fn a_fall_from_an_orbit_is_found_before_the_wall() {
    for (frequency, radius) in [(50.0, 5e-6), (150.0, 30e-6), (500.0, 30e-6)] {
        let circle = orbit(frequency, radius);
        let notices = watched(1.02, |t| {
            let [x, y] = circle(t);
            [x, y + straight_drop(t - 1.0) - CLEARANCE]
        });
        let declared = notices.iter().find_map(|notice| match notice {
            Notice::Declared(event) if event.kind == EventKind::FreeFall => Some(event.declared),
            _ => None,
        });
        let latency = declared.expect("declared") as f64 / 20_000.0 - 1.0;
        println!("{frequency} Hz {radius:e} m: {:.2} ms", latency * 1e3);
        assert!(latency > 0.0 && latency < 7e-3, "{latency}");
    }
}
