//! `replay` runs the whole controller: from a lift that was seen, or from power-on; orders to clear.

use std::sync::OnceLock;

use predicates::str::contains;
use serde_json::Value;
use tempfile::TempDir;
use touchdown_tests::binary::touchdown;

/// A folder with the rig's drop as `s.csv`.
fn folder() -> &'static TempDir {
    static FOLDER: OnceLock<TempDir> = OnceLock::new();
    FOLDER.get_or_init(|| {
        let folder = TempDir::new().unwrap();
        let run = ["drop", "rig", "--stream", "s.csv"];
        touchdown(folder.path()).args(run).assert().success();
        folder
    })
}

fn replay(arguments: &[&str]) -> Value {
    let run = touchdown(folder().path())
        .args(["replay", "s.csv", "--scene", "rig", "--json", "-"])
        .args(arguments)
        .assert()
        .success();
    serde_json::from_slice(&run.get_output().stdout).unwrap()
}

/// Of each entry: mode, cause and `run`.
fn outputs(json: &Value) -> Vec<(String, String, bool)> {
    let entries = json["controller"]["outputs"].as_array().unwrap().iter();
    let text = |value: &Value| value.as_str().unwrap_or("-").to_owned();
    entries
        .map(|it| (text(&it["mode"]), text(&it["cause"]), it["run"].as_bool().unwrap()))
        .collect()
}

fn events(json: &Value, touches: bool) -> Vec<&Value> {
    let events = json["events"].as_array().unwrap().iter();
    events.filter(|it| (it["event"] == "touch") == touches).collect()
}

#[test]
fn a_lift_was_seen_before_the_recording() {
    let json = replay(&[]);
    let told = outputs(&json);
    let expected = [
        ("self_test", "no_proof", false),
        ("arming", "no_proof", false),
        ("watching", "-", true),
        ("watching", "-", true),
        ("dropped", "fall", false),
    ];
    let expected = expected.map(|(mode, cause, run)| (mode.to_owned(), cause.to_owned(), run));
    assert_eq!(told[..5], expected);
    assert_eq!(json["controller"]["outputs"][0]["time_s"], -0.2);
    assert_eq!(json["controller"]["orders"], Value::Array(vec![]));
}

#[test]
fn power_on_proves_nothing_and_changes_no_event() {
    let (on, lifted) = (replay(&["--power-on"]), replay(&[]));
    assert_eq!(on["events"], lifted["events"]);
    let told = outputs(&on);
    assert!(told.iter().all(|(_, _, run)| !run), "{told:?}");
    let causes: Vec<_> = told.iter().map(|it| it.1.as_str()).collect();
    assert!(causes.iter().all(|it| *it == "no_proof"), "{causes:?}");
}

#[test]
fn each_time_at_the_wall_is_a_touch() {
    let json = replay(&[]);
    let touches = events(&json, true);
    assert_eq!(json["controller"]["touches"], touches.len());
    let impacts = events(&json, false);
    let impact = impacts.iter().find(|it| it["event"] == "impact").unwrap();
    let first = touches[0];
    assert_eq!(first["normal_speed_m_s"], impact["normal_speed_m_s"]);
    let onset = |it: &Value| it["onset_s"].as_f64().unwrap();
    assert!(onset(first) < onset(impact) && onset(impact) - onset(first) < 2e-3);
    assert!(first["peak_fraction"].as_f64().unwrap() > 0.95);
    // It lies at the end.
    assert!(touches.last().unwrap()["end_s"].is_null());
}

#[test]
fn alarms_rise_through_both_limits_in_both_planes() {
    let json = replay(&[]);
    let alarms = json["controller"]["alarms"].as_array().unwrap();
    let levels: Vec<_> = alarms.iter().take(4).map(|it| it["level"].as_str().unwrap()).collect();
    assert_eq!(levels, ["alert", "alert", "danger", "danger"]);
    let zones = &json["controller"]["zones"];
    let sum: f64 = ["a", "b", "c", "d"].iter().map(|it| zones[it].as_f64().unwrap()).sum();
    assert!((sum - 1.0).abs() < 1e-12);
}

#[test]
fn an_order_is_done_or_says_why_not() {
    let json = replay(&["--clear-at", "0.01", "--clear-at", "-0.1"]);
    let orders = json["controller"]["orders"].as_array().unwrap();
    let told: Vec<_> = orders.iter().map(|it| (it["time_s"].as_f64().unwrap(), it["done"].as_bool().unwrap())).collect();
    assert_eq!(told, [(-0.1, true), (0.01, false)]);
    assert_eq!(orders[1]["why"], "a drop runs");
    for outside in ["-0.3", "3600"] {
        touchdown(folder().path())
            .args(["replay", "s.csv", "--scene", "rig", "--clear-at", outside])
            .assert()
            .code(2)
            .stderr(contains("no sample at that time"));
    }
}

/// An orbit of 60 um at 30 000 rpm, whose speed reads double for a turn: that looked like a fall.
#[test]
fn a_speed_that_is_wrong_for_a_turn_changes_nothing() {
    let folder = TempDir::new().unwrap();
    let turn = std::f64::consts::TAU * 500.0;
    let mut stream = String::from("time_s,ax_um,ay_um,bx_um,by_um,speed_rpm\n");
    for number in 0..12_000_u32 {
        let time = f64::from(number) / 20e3;
        let (y, x) = (-turn * time).sin_cos();
        // Noise of about 1 um that repeats.
        let noise = f64::from(number.wrapping_mul(2_654_435_761) >> 16) / 19_000.0 - 1.72;
        let speed = if (8_000..8_040).contains(&number) { -60e3 } else { -30e3 };
        let (x, y) = (60.0 * x + noise, 60.0 * y - noise);
        stream += &format!("{time},{x},{y},{x},{y},{speed}\n");
    }
    std::fs::write(folder.path().join("orbit.csv"), stream).unwrap();
    let run = touchdown(folder.path())
        .args(["replay", "orbit.csv", "--scene", "rig", "--json", "-"])
        .assert()
        .success();
    let json: Value = serde_json::from_slice(&run.get_output().stdout).unwrap();
    let told = events(&json, false);
    let [fault] = told[..] else {
        panic!("{told:?}");
    };
    assert_eq!(fault["event"], "sensor_fault");
    assert_eq!(fault["fault"]["channel"], "speed");
    assert_eq!(json["faults"], 40, "the readings are told");
}
