//! `trade`: the table's shape, its front, its files; and that `fidelity = "auto"` takes the cheapest.

use std::collections::BTreeSet;
use std::fs;
use std::sync::OnceLock;

use predicates::str::contains;
use serde_json::Value;
use tempfile::TempDir;
use touchdown_tests::binary::touchdown;

const KEYS: [&str; 15] = [
    "contact_error",
    "energy_drift",
    "error_impact_1",
    "error_impact_10",
    "error_impact_3",
    "math",
    "mcu_instructions_per_step",
    "ns_per_step",
    "pareto",
    "precision",
    "regime_ok",
    "rung",
    "scheme",
    "seconds_per_simulated_second",
    "step_s",
];

fn table(scene: &str) -> (TempDir, Vec<Value>) {
    let folder = TempDir::new().unwrap();
    touchdown(folder.path())
        .args(["trade", scene, "--drops", "0", "--json", "trade.json"])
        .assert()
        .success();
    let text = fs::read_to_string(folder.path().join("trade.json")).unwrap();
    let json: Value = serde_json::from_str(&text).unwrap();
    let rows = json["rows"].as_array().expect("rows").clone();
    (folder, rows)
}

/// That of the rig, measured once for all tests.
fn rig() -> &'static (TempDir, Vec<Value>) {
    static TABLE: OnceLock<(TempDir, Vec<Value>)> = OnceLock::new();
    TABLE.get_or_init(|| table("rig"))
}

fn number(row: &Value, key: &str) -> f64 {
    row[key].as_f64().unwrap_or(f64::INFINITY)
}

/// What the front is about: cost here, and the greatest error at impacts 1, 3 and 10.
fn point(row: &Value) -> [f64; 2] {
    let errors = ["error_impact_1", "error_impact_3", "error_impact_10"];
    let worst = errors.map(|key| number(row, key)).into_iter();
    [
        number(row, "seconds_per_simulated_second"),
        worst.fold(0.0, f64::max),
    ]
}

#[test]
fn every_combination_has_a_row_of_the_agreed_shape() {
    let (folder, rows) = rig();
    let mut seen = BTreeSet::new();
    for row in rows {
        let keys: Vec<&str> = row
            .as_object()
            .unwrap()
            .keys()
            .map(String::as_str)
            .collect();
        assert_eq!(keys, KEYS);
        let name: String = ["rung", "scheme", "precision", "math"]
            .map(|key| row[key].as_str().unwrap())
            .join(" ");
        assert!(
            seen.insert(format!("{name} {}", row["step_s"])),
            "{name} twice"
        );
        assert!(number(row, "ns_per_step") > 0.0 && number(row, "energy_drift").is_finite());
        let second = number(row, "ns_per_step") * 1e-9 / number(row, "step_s");
        let written = number(row, "seconds_per_simulated_second");
        assert!((second / written - 1.0).abs() < 1e-12);
    }
    for step in [1e-6, 1e-5, 1e-4, 1e-3] {
        for (precision, error) in [("f64", 1e-13), ("f32", 1e-5)] {
            let exact = rows.iter().find(|row| {
                row["rung"] == "rigid"
                    && row["math"] == "libm"
                    && row["precision"] == precision
                    && number(row, "step_s") == step
            });
            let exact = exact.expect("the rigid rung takes any step");
            assert!(
                point(exact)[1] < error && exact["regime_ok"] == true,
                "{exact}"
            );
        }
    }
    for (name, start) in [
        ("touchdown-trade.html", "<!DOCTYPE html>"),
        ("touchdown-trade.svg", "<svg "),
    ] {
        let text = fs::read_to_string(folder.path().join(name)).unwrap();
        assert!(text.starts_with(start), "{name}");
        let rest = text.replace("http://www.w3.org/2000/svg", "");
        assert!(!rest.contains("http"), "{name} loads something");
    }
}

#[test]
fn the_front_is_what_nothing_beats() {
    let (_folder, rows) = rig();
    let points: Vec<_> = rows.iter().map(point).collect();
    for (row, &at) in rows.iter().zip(&points) {
        let beaten = points
            .iter()
            .any(|other| other[0] <= at[0] && other[1] <= at[1] && *other != at);
        assert_eq!(
            row["pareto"],
            Value::Bool(at[1].is_finite() && !beaten),
            "{row}"
        );
    }
    assert!(rows.iter().any(|row| row["pareto"] == true));
}

#[test]
fn a_scene_without_impacts_has_a_table_too() {
    let (_folder, rows) = table("backward-whirl");
    assert!(rows.iter().all(|row| row["error_impact_1"].is_null()));
    assert!(
        rows.iter()
            .any(|row| row["pareto"] == true && row["regime_ok"] == true)
    );
}

/// What `soft-support`, its stop so far out, has without a part: the changes over 16 drops of 50 ms.
fn changes(part: &str, travel_mm: &str) -> Vec<Value> {
    let folder = TempDir::new().unwrap();
    let text = include_str!("../../../host-sim/scenes/soft-support.toml");
    let text = text.replace("duration_s = 0.3", "duration_s = 0.05");
    let text = text.replace("travel_mm = 0.5", &format!("travel_mm = {travel_mm}"));
    fs::write(folder.path().join("s.toml"), text).unwrap();
    touchdown(folder.path())
        .args(["scene", "explain", "s.toml", "--drops", "16", "--json", "s.json"])
        .assert()
        .success()
        .stdout(contains("16 drops with the whole machine"));
    let json = fs::read_to_string(folder.path().join("s.json")).unwrap();
    let json: Value = serde_json::from_str(&json).unwrap();
    let all = json["parts"]["without"].as_array().unwrap();
    let found = all.iter().find(|it| it["part"] == part);
    found.expect("the part")["changes"].as_array().unwrap().clone()
}

fn interval(change: &Value) -> [f64; 2] {
    [0, 1].map(|k| change["interval"][k].as_f64().unwrap())
}

#[test]
fn a_part_is_worth_what_it_changes() {
    let changes = changes("retainer's mass, spring, damper", "0.5");
    for change in &changes {
        let [low, high] = interval(change);
        let mean = number(change, "without") - number(change, "whole");
        assert!(low <= mean && mean <= high, "{change}");
    }
    let of = |quantity: &str| changes.iter().find(|it| it["quantity"] == quantity);
    // A rigid wall keeps the rotor in the gap; the load of whirl on it is much greater.
    let [_, high] = interval(of("greatest radius").expect("a radius"));
    assert!(high < 0.0);
    let [low, _] = interval(of("greatest held force").expect("a force"));
    assert!(low > 0.0);
}

/// A stop that no mount reaches.
#[test]
fn a_part_that_does_nothing_is_worth_nothing() {
    let changes = changes("hard stop of the retainer", "50.0");
    assert!(changes.len() > 5, "{changes:?}");
    for change in &changes {
        // The interval of a share is not empty with 16 drops; what was measured is the same to the last bit.
        assert_eq!(change["whole"], change["without"], "{change}");
        let [low, high] = interval(change);
        assert!(low <= 0.0 && 0.0 <= high, "{change}");
    }
}
