//! Scenes that are valid, and what `drop` and `replay` write for them.

use std::fs;
use std::path::Path;

use predicates::str::contains;
use serde_json::Value;
use tempfile::TempDir;
use touchdown_core::sensing::AxialPlaces;
use touchdown_run::explain::explain;
use touchdown_scene::{BUILT_IN, Precision, Scene};
use touchdown_tests::binary::touchdown;

const MINIMAL: &str = "\
[rotor]
mass_kg = 3.42
radius_mm = 24
speed_rpm = 3000
[retainer]
clearance_mm = 0.3
friction = 0.1
restitution = 0.8
[run]
duration_s = 0.02
";

fn drop_json(folder: &Path, scene: &str) -> Value {
    let output = touchdown(folder)
        .args(["drop", scene, "--json", "-"])
        .output()
        .unwrap();
    assert!(
        output.status.success(),
        "{}",
        String::from_utf8_lossy(&output.stderr)
    );
    serde_json::from_slice(&output.stdout).unwrap()
}

fn keys(value: &Value) -> Vec<&str> {
    let mut keys: Vec<_> = value
        .as_object()
        .unwrap()
        .keys()
        .map(String::as_str)
        .collect();
    keys.sort_unstable();
    keys
}

#[test]
fn required_keys_are_enough() {
    let scene = Scene::parse("minimal", MINIMAL).unwrap();
    assert_eq!(scene.rotor.polar_inertia, 0.5 * 3.42 * 0.024 * 0.024);
    assert_eq!(scene.run.gravity, 9.81);
    assert_eq!(scene.run.sample_rate, 20_000.0);
    assert_eq!(scene.model.precision, Precision::F64);
    assert_eq!(scene.model.step, 1.0 / 20_000.0);
    assert_eq!(scene.sensors.bits, 12);
    assert!((scene.sensors.range - 1e-3).abs() < 1e-15);
    assert_eq!(scene.sensors.noise, 1e-6);
    let folder = TempDir::new().unwrap();
    fs::write(folder.path().join("m.toml"), MINIMAL).unwrap();
    let json = drop_json(folder.path(), "m.toml");
    assert_eq!(json["impacts"][0]["index"], 0);
}

#[test]
fn the_edges_of_every_range_are_valid() {
    for edge in [
        "gravity_m_s2 = 0",
        "sample_rate_hz = 100",
        "sample_rate_hz = 200000",
        "[model]\nstep_us = 1",
        "[model]\nstep_us = 1000",
        "[model]\nprecision = \"f32\"\nrung = \"rigid\"",
        "[model]\nrung = \"moreau\"\nstep_us = 1000",
        "[model]\nrung = \"hertz\"\nscheme = \"verlet\"\nstep_us = 128",
        "[model]\nrung = \"hertz\"\n[materials]\ncontact = \"line\"\nlength_mm = 20",
        "[model]\nrung = \"hertz\"\n[materials]\ncontact = \"line-power\"\nlength_mm = 20",
        "[materials]\nrotor_modulus_gpa = 70\nrotor_poisson = 0\nretainer_poisson = 0.5",
        "[sensors]\nbits = 16\nnoise_um = 0\nplanes = 1",
        "[start]\nx_mm = 0.18\ny_mm = -0.24",
        "[start]\nangle_deg = 400",
        "[start]\ntangential_mm_s = -5",
        "[start]",
    ] {
        Scene::parse("edge", &format!("{MINIMAL}{edge}\n")).unwrap();
    }
    for (from, to) in [
        ("friction = 0.1", "friction = 0"),
        ("friction = 0.1", "friction = 1.5"),
        ("restitution = 0.8", "restitution = 0"),
        ("restitution = 0.8", "restitution = 1"),
        ("speed_rpm = 3000", "speed_rpm = 0"),
        ("duration_s = 0.02", "duration_s = 86400"),
    ] {
        Scene::parse("edge", &MINIMAL.replacen(from, to, 1)).unwrap();
    }
}

#[test]
fn a_step_is_one_sample_where_that_is_allowed() {
    for (rate, step) in [(100.0, 1e-3), (20_000.0, 5e-5), (200_000.0, 5e-6)] {
        let scene = Scene::parse("s", &format!("{MINIMAL}sample_rate_hz = {rate}\n")).unwrap();
        assert!((scene.model.step - step).abs() < 1e-12, "{rate}");
    }
}

#[test]
fn built_in_scenes_have_title_and_source() {
    for built_in in BUILT_IN {
        let scene = Scene::parse(built_in.name, built_in.text).unwrap();
        assert!(
            scene.title.is_some() && scene.source.is_some(),
            "{}",
            built_in.name
        );
        assert!(scene.warnings().is_empty());
    }
}

#[test]
fn built_in_scenes_end_as_their_titles_say() {
    let folder = TempDir::new().unwrap();
    for (scene, regime) in [
        ("rig", "pendulum"),
        ("rig-wide-gap", "pendulum"),
        ("backward-whirl", "backward_whirl"),
        ("rolling", "pendulum"),
    ] {
        assert_eq!(drop_json(folder.path(), scene)["regime"], regime, "{scene}");
    }
    let rolling = drop_json(folder.path(), "rolling");
    assert_eq!(rolling["rolling_starts_s"].as_array().unwrap().len(), 1);
    let lift_off = drop_json(folder.path(), "lift-off");
    assert!(!lift_off["lift_offs_s"].as_array().unwrap().is_empty());
}

#[test]
fn drop_json_has_the_documented_shape() {
    let folder = TempDir::new().unwrap();
    let json = drop_json(folder.path(), "rig");
    assert_eq!(
        keys(&json),
        [
            "accuracy",
            "contact_starts_s",
            "controller",
            "detector",
            "final",
            "forecasts",
            "impacts",
            "lift_offs_s",
            "model",
            "phases",
            "regime",
            "rolling_starts_s",
            "severity"
        ]
    );
    assert_eq!(keys(&json["model"]), ["precision", "rung", "step_s"]);
    assert_eq!(json["model"]["rung"], "rigid");
    assert_eq!(json["model"]["precision"], "f64");
    assert_eq!(
        keys(&json["impacts"][0]),
        [
            "index",
            "normal_impulse_n_s",
            "normal_speed_m_s",
            "spin_rad_s",
            "time_s",
            "vx_m_s",
            "vy_m_s",
            "x_m",
            "y_m"
        ]
    );
    assert_eq!(keys(&json["phases"][0]), ["end_s", "phase", "start_s"]);
    let phases: Vec<_> = json["phases"]
        .as_array()
        .unwrap()
        .iter()
        .map(|p| &p["phase"])
        .collect();
    assert_eq!(phases, ["levitated", "free_fall", "impact", "sliding"]);
    assert_eq!(json["phases"][0]["start_s"], -0.2);
    assert_eq!(
        keys(&json["final"]),
        [
            "energy_j",
            "spin_rad_s",
            "time_s",
            "vx_m_s",
            "vy_m_s",
            "x_m",
            "y_m"
        ]
    );
    assert_eq!(json["final"]["time_s"], 0.3);
    assert!(json["detector"]["events"].is_array());
}

#[test]
fn a_start_on_the_wall_has_no_levitated_samples() {
    let folder = TempDir::new().unwrap();
    let json = drop_json(folder.path(), "backward-whirl");
    assert_eq!(json["contact_starts_s"][0], 0.0);
    assert_eq!(json["phases"][0]["phase"], "sliding");
    touchdown(folder.path())
        .args(["drop", "backward-whirl", "--stream", "-"])
        .assert()
        .success()
        .stdout(predicates::str::starts_with(
            "time_s,ax_um,ay_um,bx_um,by_um\n0,",
        ));
}

#[test]
fn a_stream_replays_to_the_same_events() {
    let folder = TempDir::new().unwrap();
    let scene = format!(
        "{MINIMAL}[sensors]\nmounting_deg = [45, -30]\nspeed = true\nlevitation_signal = true\n"
    );
    fs::write(folder.path().join("m.toml"), scene).unwrap();
    let drop = touchdown(folder.path())
        .args(["drop", "m.toml", "--json", "-", "--stream", "s.csv"])
        .output()
        .unwrap();
    let drop: Value = serde_json::from_slice(&drop.stdout).unwrap();
    let replay = touchdown(folder.path())
        .args(["replay", "s.csv", "--scene", "m.toml", "--json", "-"])
        .output()
        .unwrap();
    let replay: Value = serde_json::from_slice(&replay.stdout).unwrap();
    let documented = [
        "controller",
        "events",
        "faults",
        "forecasts",
        "health",
        "samples",
        "severity",
    ];
    assert_eq!(keys(&replay), documented);
    assert_eq!(replay["samples"], 4401);
    assert_eq!(replay["faults"], 0);
    assert_eq!(replay["events"], drop["detector"]["events"]);
    assert_eq!(replay["controller"], drop["controller"]);
}

#[test]
fn a_missing_value_is_a_fault_of_its_channel() {
    let folder = TempDir::new().unwrap();
    let stream = "time_s,ax_um,ay_um\n0,1,2\n0.00005,NaN,2\n0.0001,5000,nan\n0.00015,1,2\n";
    fs::write(folder.path().join("s.csv"), stream).unwrap();
    let replay = touchdown(folder.path())
        .args(["replay", "s.csv", "--scene", "rig", "--json", "-"])
        .output()
        .unwrap();
    let replay: Value = serde_json::from_slice(&replay.stdout).unwrap();
    assert_eq!(replay["samples"], 4);
    assert_eq!(replay["faults"], 3);
}

#[test]
fn a_gap_beyond_the_sensors_is_a_warning() {
    let folder = TempDir::new().unwrap();
    let scene = MINIMAL.replacen("clearance_mm = 0.3", "clearance_mm = 1.5", 1);
    fs::write(folder.path().join("m.toml"), scene).unwrap();
    touchdown(folder.path())
        .args(["drop", "m.toml"])
        .assert()
        .success()
        .stderr(contains(
            "warning: m.toml: clearance_mm is 1.5, beyond the sensors' range",
        ));
}

#[test]
fn a_step_of_a_contact_is_a_whole_part_of_a_sample() {
    let hertz = "[model]\nrung = \"hertz\"\n";
    let scene = Scene::parse("h", &format!("{MINIMAL}{hertz}")).unwrap();
    // T_c/25 is 10.32 us, a sample 50 us.
    assert!((scene.model.step - 1e-5).abs() < 1e-15);
    assert!(scene.warnings().is_empty());
    let coarse = Scene::parse("h", &format!("{MINIMAL}{hertz}step_us = 11\n")).unwrap();
    let warnings = coarse.warnings();
    assert!(
        warnings[0].contains("step_us is 11, above T_c/25 = 10.3207 us"),
        "{warnings:?}"
    );
}

#[test]
fn impacts_that_take_time_say_how_hard_and_how_long() {
    let folder = TempDir::new().unwrap();
    let scene = format!("{MINIMAL}[model]\nrung = \"hertz\"\n");
    fs::write(folder.path().join("h.toml"), scene).unwrap();
    let json = drop_json(folder.path(), "h.toml");
    assert_eq!(json["model"]["rung"], "hertz");
    let impact = &json["impacts"][0];
    let number = |key: &str| impact[key].as_f64().unwrap();
    let momentum = 3.42 * number("normal_speed_m_s");
    let product = number("peak_force_n") * number("contact_time_s") / momentum;
    assert!((3.3..3.6).contains(&product), "{product}");
    // Gravity's share of the impulse is g T_c/v = 0.034.
    let impulse = number("normal_impulse_n_s") / momentum;
    assert!((1.8..1.84).contains(&impulse), "{impulse}");
    let shown = |scene: &str| {
        let output = touchdown(folder.path())
            .args(["drop", scene, "--report", "report.html"])
            .output()
            .unwrap();
        let page = fs::read_to_string(folder.path().join("report.html")).unwrap();
        (String::from_utf8(output.stdout).unwrap(), page)
    };
    let line = format!(
        "contact force up to {:.0} N, within {:.4} ms",
        number("peak_force_n"),
        number("contact_time_s") * 1e3
    );
    let (timeline, page) = shown("h.toml");
    assert!(timeline.contains(&line), "{line} in\n{timeline}");
    assert!(page.contains("Peak force") && !page.contains("contact durations are not"));
    let moreau = format!("{MINIMAL}[model]\nrung = \"moreau\"\n");
    fs::write(folder.path().join("m.toml"), moreau).unwrap();
    let (timeline, page) = shown("m.toml");
    assert!(!timeline.contains("contact force") && !page.contains("Peak force"));
    let json = drop_json(folder.path(), "m.toml");
    assert_eq!(json["model"]["rung"], "moreau");
    assert!(json["impacts"][0].get("peak_force_n").is_none());
}

#[test]
fn an_explanation_says_what_the_rung_models() {
    let explained = |rung: &str| {
        let scene = format!("{MINIMAL}[model]\nrung = \"{rung}\"\n");
        explain(&Scene::parse("s", &scene).unwrap())
    };
    let hertz = explained("hertz");
    for number in [
        "2.145037e11 N/m^1.5",
        "15620.0 rad/s",
        "258.0176 us",
        "128.0407 us",
    ] {
        assert!(hertz.contains(number), "{number} in\n{hertz}");
    }
    assert!(hertz.contains("contact force and its duration       rung hertz is asked for"));
    assert!(explained("moreau").contains("middle of a step"));
    assert!(
        explained("rigid").contains("contact force and its duration       rung hertz has them")
    );
}

#[test]
fn without_arguments_the_rig_is_dropped_and_reported() {
    let folder = TempDir::new().unwrap();
    let output = touchdown(folder.path()).output().unwrap();
    assert!(output.status.success());
    let text = String::from_utf8(output.stdout).unwrap();
    assert!(
        text.contains("free fall") && text.contains("touchdown-report.html"),
        "{text}"
    );
    assert!(
        text.lines().all(|line| line.chars().count() <= 80),
        "{text}"
    );
    let page = fs::read_to_string(folder.path().join("touchdown-report.html")).unwrap();
    assert!(page.starts_with("<!DOCTYPE html>"));
}

#[test]
fn a_path_wins_over_a_built_in_name() {
    let folder = TempDir::new().unwrap();
    fs::write(folder.path().join("rig"), MINIMAL).unwrap();
    assert_eq!(drop_json(folder.path(), "rig")["final"]["time_s"], 0.02);
}

#[test]
fn the_rig_is_explained_by_its_known_numbers() {
    let text = explain(&Scene::load("rig").unwrap());
    for number in [
        "334.",
        "7.8206 ms",
        "5.5300 ms",
        "54.2494 mm/s",
        "-1389.84",
        "28.780 Hz",
    ] {
        assert!(text.contains(number), "{number} in\n{text}");
    }
}

#[test]
fn a_scene_without_gravity_is_explained_too() {
    let text = touchdown_scene::BUILT_IN[0]
        .text
        .replace("duration_s", "gravity_m_s2 = 0\nduration_s");
    assert!(explain(&Scene::parse("s", &text).unwrap()).contains("no gravity"));
}

#[test]
fn the_monitor_knows_where_its_sensors_are() {
    let places = |name: &str, from: &str, to: &str| {
        let text = BUILT_IN.iter().find(|it| it.name == name).unwrap().text;
        assert!(text.contains(from), "{from} is not in {name}");
        let scene = Scene::parse(name, &text.replacen(from, to, 1)).unwrap();
        scene.monitor_config().sensing.places
    };
    let told = |sensors: [f32; 2], rings: [f32; 2]| Some(AxialPlaces { sensors, rings });
    let line = "sensor_z_mm = [-241.0, 119.0]";
    for (planes, expected) in [
        ("[-241.0, 119.0]", told([-0.241, 0.119], [-0.241, 0.139])),
        ("[119.0, -241.0]", told([0.119, -0.241], [0.139, -0.241])),
        // At the rings, and where they show nothing of them.
        ("[-241.0, 139.0]", None),
        ("[100.0, 100.0]", None),
    ] {
        let to = format!("sensor_z_mm = {planes}");
        assert_eq!(places("mse-rig", line, &to), expected, "{planes}");
    }
    assert_eq!(places("rig", "[rotor]", "[rotor]"), None);
}
