//! `touchdown config`: what is shown can be saved, edited and sent back; what is wrong is refused on the desktop or
//! by the controller, with its reason; what is taken is in force after the restart, and after a cut of the power.
#![cfg(unix)]

use std::fs;
use std::path::Path;
use std::sync::{Arc, Mutex};
use std::time::{Duration, Instant};

use assert_cmd::assert::Assert;
use predicates::str::contains;
use proptest::prelude::*;
use serde_json::Value;
use touchdown_protocol::config_block::{Key, Settings};
use touchdown_protocol::controller::Mode;
use touchdown_core::sensing::{AxialPlaces, Calibration, PlaneCalibration};
use touchdown_core::tachometer::TachometersConfig;
use touchdown_files::configuration::{differences, parse, text};
use touchdown_files::link::Client;
use touchdown_run::emulator::Emulator;
use touchdown_scene::{BUILT_IN, Scene};
use touchdown_sim::rig::{Options, Order, Rig};
use touchdown_tests::binary::touchdown;
use touchdown_tests::controller::{Controller, Machine, settings};

/// Far more than anything here takes.
const LONG: Duration = Duration::from_secs(120);

/// A machine whose rotor whirls backward for a minute once it is dropped.
fn whirling() -> Scene {
    let scene = BUILT_IN.iter().find(|it| it.name == "backward-whirl");
    let text = scene.expect("built in").text;
    let text = text.replace("duration_s = 0.045", "duration_s = 60.0");
    Scene::parse("whirl", &text).expect("a scene")
}

fn config(folder: &Path, port: &str, arguments: &[&str]) -> Assert {
    touchdown(folder)
        .args(["config", port])
        .args(arguments)
        .assert()
}

/// The configuration that a controller shows.
fn shown(folder: &Path, port: &str) -> (String, Settings) {
    let run = config(folder, port, &[]).success();
    let text = String::from_utf8(run.get_output().stdout.clone()).expect("text");
    let settings = parse("shown", &text).expect("can be read back");
    (text, settings)
}

fn until(what: &str, mut holds: impl FnMut() -> bool) {
    let start = Instant::now();
    while !holds() {
        assert!(start.elapsed() < LONG, "not within {LONG:?}: {what}");
        std::thread::sleep(Duration::from_millis(20));
    }
}

/// Waits for a mode, with a line of its own: the rig has one desktop at a time.
fn until_mode(rig: &Rig, mode: Mode) {
    let line = std::net::TcpStream::connect(rig.address).expect("the rig listens");
    line.set_nodelay(true).expect("a socket");
    let mut talk = Client::patient(Box::new(line));
    until(&format!("{mode:?}"), || {
        talk.state().expect("answers").mode == mode
    });
}

#[test]
fn a_configuration_is_saved_edited_sent_back_and_kept_and_refused_in_a_drop() {
    let folder = tempfile::tempdir().expect("a folder");
    let at = folder.path();
    let options = Options {
        folder: at.to_owned(),
        port: 0,
        noise: 0.0,
        fast: true,
    };
    let emulator = Emulator::find(None).unwrap_or_else(|error| panic!("{error}"));
    let rig = Rig::start(whirling(), emulator, options).expect("starts");
    let port = format!("tcp:{}", rig.address);

    let (saved, before) = shown(at, &port);
    assert!(saved.contains("clearance_mm = 0.3\n"), "{saved}");
    rig.order(Order::Service(true));
    until("the service input is seen", || {
        touchdown(at).args(["clear", &port]).ok().is_ok()
    });
    fs::write(at.join("same.toml"), &saved).expect("a file");
    config(at, &port, &["--set", "same.toml"])
        .success()
        .stdout(contains("nothing to change"));
    assert_eq!(rig.starts(), 1);

    let edited = saved.replace("clearance_mm = 0.3\n", "clearance_mm = 0.31\n");
    fs::write(at.join("c.toml"), &edited).expect("a file");
    let run = config(at, &port, &["--set", "c.toml", "--json", "-"])
        .success()
        .stderr(contains("retainer.clearance_mm: 0.3 -> 0.31"))
        .stderr(contains("restarted"));
    let told: Value = serde_json::from_slice(&run.get_output().stdout).expect("JSON");
    assert_eq!(told["changed"].as_array().map(Vec::len), Some(1));
    assert_eq!(told["changed"][0]["key"], "retainer.clearance_mm");
    assert_eq!(told["config"]["retainer"]["clearance_mm"], 0.31);
    assert_eq!(rig.starts(), 2);
    let (_, now) = shown(at, &port);
    assert_eq!(now.monitor.detector.machine.clearance, 0.31e-3);

    // The same flash, another start.
    rig.order(Order::Cut);
    until("power", || rig.starts() == 3);
    assert_eq!(shown(at, &port).1, now);

    // This board converts at one rate: no whole number of conversions, and two without their bit.
    for (hz, why) in [("15000.0", "sample_rate"), ("10000.0", "full_scale")] {
        let rate = edited.replace("sample_rate_hz = 20000.0", &format!("sample_rate_hz = {hz}"));
        fs::write(at.join("rate.toml"), rate).expect("a file");
        config(at, &port, &["--set", "rate.toml"])
            .code(1)
            .stderr(contains(format!("refuses: {why}")));
    }

    rig.order(Order::Lift);
    until_mode(&rig, Mode::Watching);
    config(at, &port, &["--set", "same.toml"])
        .code(1)
        .stderr(contains("refuses: it watches"));
    rig.order(Order::Drop);
    until_mode(&rig, Mode::Dropped);
    config(at, &port, &["--set", "same.toml"])
        .code(1)
        .stderr(contains("refuses: a drop runs"));
    assert_eq!(shown(at, &port).1, now);
    assert_ne!(now, before);
    assert_eq!(rig.starts(), 3);
    rig.stop().expect("no failure");
}

#[test]
fn what_is_wrong_is_said_with_its_line_before_anything_is_sent() {
    let folder = tempfile::tempdir().expect("a folder");
    let at = folder.path();
    let good = text(&settings());
    // Nobody is at that port: the file alone is at fault.
    for (from, to, why) in [
        ("friction = 0.1", "friction = -0.1", "c.toml:9: friction"),
        (
            "clearance_mm = 0.3",
            "clearance_mm = 300.0",
            "c.toml:8: clearance_mm must be 0.001 to 100",
        ),
        ("restitution = 0.8\n", "", "missing required key"),
        (
            "restitution = 0.8",
            "restitutoin = 0.8",
            "unknown key `restitutoin`",
        ),
        (
            "friction = 0.1",
            "friction = nan",
            "friction must be a finite number",
        ),
        (
            "zero_count = 2048.0",
            "zero_count = 5000.0",
            "c.toml:19: zero_count must be between",
        ),
        (
            "mounting_deg = [",
            "mounting_deg = [0.0, ",
            "the list must have 2 numbers, has 3",
        ),
        ("full_scale = 4095", "full_scale = 70000", "full_scale"),
        (
            "full_scale = 4095",
            "full_scale = 4095\nsensor_z_mm = [-241.0, 119.0]",
            "ring_z_mm must be given where sensor_z_mm is",
        ),
        (
            "full_scale = 4095",
            "full_scale = 4095\nsensor_z_mm = [-241.0, 119.0]\nring_z_mm = [-241.0, -139.0]",
            "c.toml:22: ring_z_mm must be -0.45 to 10",
        ),
        ("\"ay\", ", "", "channels must be"),
        (
            "impact_instants = 16",
            "impact_instants = 3",
            "impact_instants must be 4 to 32",
        ),
        ("[run]", "[run", "c.toml:12"),
    ] {
        assert!(good.contains(from), "{from} is not in\n{good}");
        fs::write(at.join("c.toml"), good.replacen(from, to, 1)).expect("a file");
        config(at, "unix:nobody", &["--set", "c.toml"])
            .code(2)
            .stderr(contains(why));
    }
    config(at, "unix:nobody", &["--set", "nothing.toml"])
        .code(2)
        .stderr(contains("nothing.toml: no such file"));
    config(at, "unix:nobody", &[])
        .code(2)
        .stderr(contains("unix:nobody: no such file"));
}

/// Bytes, not only lines: the end of a number is a number.
#[test]
fn no_part_of_a_file_is_taken_for_all_of_it() {
    let plain = text(&settings());
    let keyed = plain.replace(
        "[guard]",
        "[link]\nkey = \"000102030405060708090a0b0c0d0e0f\"\n\n[guard]",
    );
    let parsed = parse("c.toml", &keyed).expect("a configuration");
    assert_eq!(parsed.key, Some(Key(core::array::from_fn(|it| it as u8))));
    let mut bearing = settings();
    bearing.monitor.tachometers = Some(TachometersConfig {
        marks: [Some(3), Some(7)],
        cage_ratio: 0.4,
        bore_radius: 12e-3,
        edge_error: 1e-3,
        window: 0.01,
    });
    let mut apart = settings();
    apart.monitor.sensing.places = Some(AxialPlaces {
        sensors: [-0.241, 0.119],
        rings: [-0.241, 0.139],
    });
    let apart = text(&apart);
    assert!(apart.contains("ring_z_mm = [-241.0, 139.0]"), "{apart}");
    for whole in [plain, keyed, text(&bearing), apart] {
        assert!(parse("c.toml", &whole).is_ok(), "{whole}");
        for length in 0..whole.len() {
            let cut = parse("c.toml", &whole[..length]);
            let error = cut.expect_err(&whole[..length]);
            assert!(error.line().is_some(), "{length}: {error}");
        }
    }
}

#[test]
fn a_key_is_read_and_never_shown() {
    let folder = tempfile::tempdir().expect("a folder");
    let at = folder.path();
    let (unkeyed, mut keyed) = (settings(), settings());
    keyed.key = Some(Key([0x5a; 16]));
    let mut held = settings();
    held.key = Some(Key::HELD);
    let (shown, read_back) = (text(&keyed), text(&held));
    assert!(!shown.contains("5a5a"), "{shown}");
    assert!(read_back.contains("[link]\n# key = set\n"), "{read_back}");
    let changed = |from, to| differences(from, to).into_iter().map(|it| (it.from, it.to));
    let some = |text: &str| Some(text.to_owned());
    let none_to_new: Vec<_> = changed(&unkeyed, &keyed).collect();
    assert_eq!(none_to_new, [(None, some("another"))]);
    let old_to_new: Vec<_> = changed(&held, &keyed).collect();
    assert_eq!(old_to_new, [(some("set"), some("another"))]);
    for wrong in ["5a5a", "00000000000000000000000000000000", "+a5a5a5a5a5a5a5a5a5a5a5a5a5a5a5a"] {
        let file = text(&settings()).replace("[guard]", &format!("[link]\nkey = \"{wrong}\"\n\n[guard]"));
        fs::write(at.join("c.toml"), file).expect("a file");
        let run = config(at, "unix:nobody", &["--set", "c.toml"])
            .code(2)
            .stderr(contains("the key must be 32 hexadecimal digits"));
        assert!(!String::from_utf8_lossy(&run.get_output().stderr).contains(wrong));
        fs::write(at.join("k"), wrong).expect("a file");
        touchdown(at)
            .args(["clear", "unix:nobody", "--key-file", "k"])
            .assert()
            .code(2)
            .stderr(contains("k:1: the key must be 32 hexadecimal digits"));
    }
}

#[test]
fn a_controller_that_keeps_nothing_says_so() {
    let folder = tempfile::tempdir().expect("a folder");
    let at = folder.path();
    let machine = Arc::new(Mutex::new(Machine::default()));
    let controller = Controller::at_path(&at.join("rig.sock"), machine);
    assert_eq!(shown(at, "unix:rig.sock").1, settings());
    config(at, "unix:rig.sock", &["--json", "c.json"]).success();
    let told = fs::read(at.join("c.json")).expect("a file");
    let told: Value = serde_json::from_slice(&told).expect("JSON");
    assert_eq!(told["firmware"], "0.1.0");
    assert_eq!(told["config"]["rotor"]["mass_kg"], 3.42);
    assert_eq!(told["changed"], Value::Array(vec![]));
    let other = text(&settings()).replace("friction = 0.1", "friction = 0.2");
    fs::write(at.join("c.toml"), other).expect("a file");
    config(at, "unix:rig.sock", &["--set", "c.toml"])
        .code(1)
        .stderr(contains("its service input must be on"));
    controller.machine().service = true;
    config(at, "unix:rig.sock", &["--set", "c.toml"])
        .code(1)
        .stderr(contains("refuses: this board cannot keep it"));
}

/// Any f32 between two bounds, evenly in its logarithm.
fn any_between(low: f32, high: f32) -> impl Strategy<Value = f32> {
    (low.ln()..high.ln()).prop_map(f32::exp)
}

fn any_settings() -> impl Strategy<Value = Settings> {
    let machine = (
        any_between(1e-3, 1e5),
        any_between(1e-4, 50.0),
        any_between(0.01, 10.0),
        -1e5_f32..1e5,
        any_between(1e-5, 0.05),
        0.0_f32..10.0,
        0.0_f32..1.0,
        any_between(1e-3, 900.0),
    );
    let sensing = (
        any_between(1e-9, 1e-4),
        1.0_f32..4_000.0,
        [-7.0_f32..7.0, -7.0_f32..7.0],
        prop_oneof![Just(3_u8), Just(12), Just(15)],
        any_between(100.0, 190_000.0),
    );
    let wired = (proptest::option::of(1_u16..), any::<bool>());
    let bearing = (
        [
            proptest::option::of(1_u16..300),
            proptest::option::of(1_u16..300),
        ],
        0.05_f32..0.49,
        any_between(1e-3, 10.0),
        0.0_f32..5e-3,
        any_between(1e-4, 0.09),
    );
    let bearing = proptest::option::of(bearing.prop_filter("fitted", |it| it.0 != [None; 2]));
    let tuning = (any_between(1e-15, 0.009), 4_u8..=32, any_between(1e-3, 9.0));
    let checked = (any_between(0.2, 5.0), -0.4_f32..0.4, -1e-3_f32..1e-3);
    let checked = proptest::option::of(checked);
    let all = (machine, sensing, wired, bearing, tuning, checked);
    all.prop_map(|(m, s, wired, bearing, tuning, checked)| {
        let mut it = settings();
        let machine = &mut it.monitor.detector.machine;
        machine.mass = m.0;
        machine.rotor_radius = m.1;
        machine.inertia_ratio = m.2;
        machine.spin = m.3;
        machine.clearance = m.4;
        machine.friction = m.5;
        machine.restitution = m.6;
        machine.gravity = m.7;
        it.monitor.sensing.resolution = s.0;
        it.monitor.sensing.zero_count = s.1;
        it.monitor.sensing.mounting_angle = s.2;
        it.monitor.fitted = s.3;
        it.monitor.detector.sample_rate = s.4;
        (it.wiring.pulses_per_turn, it.wiring.levitation) = wired;
        it.monitor.tachometers = bearing.map(|b| TachometersConfig {
            marks: b.0,
            cage_ratio: b.1,
            bore_radius: b.2,
            edge_error: b.3,
            window: b.4,
        });
        it.monitor.sensing.calibration = checked.map(|(gain, skew, zero)| Calibration {
            date: 20_261_231,
            planes: [
                PlaneCalibration {
                    zero: [zero, -zero],
                    gain: [gain, 1.0],
                    skew,
                },
                PlaneCalibration::default(),
            ],
        });
        it.monitor.commissioned = it.monitor.sensing.calibration.is_some();
        let it_tuning = &mut it.monitor.detector.tuning;
        it_tuning.false_alarm = tuning.0;
        it_tuning.release_instants = tuning.1;
        it_tuning.still_time = tuning.2;
        it
    })
}

proptest! {
    /// To the last bit: what is shown and sent back unchanged changes nothing.
    #[test]
    fn any_configuration_reads_back_from_its_text(settings in any_settings()) {
        prop_assume!(settings.validate().is_ok());
        let text = text(&settings);
        let back = parse("c.toml", &text);
        prop_assert!(back.is_ok(), "{text}\n{}", back.unwrap_err());
        prop_assert_eq!(back.expect("checked"), settings);
        prop_assert!(differences(&settings, &settings).is_empty());
    }
}
