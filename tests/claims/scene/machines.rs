//! The built-in machines beyond the rigid plane, by the commands that a user types.

use std::fs;

use predicates::str::contains;
use serde_json::Value;
use tempfile::TempDir;
use touchdown_tests::binary::{touchdown, trade};

fn drop_json(scene: &str) -> (Value, String) {
    let folder = TempDir::new().unwrap();
    touchdown(folder.path())
        .args(["drop", scene, "--json", "a.json", "--report", "a.html"])
        .assert()
        .success();
    let read = |name: &str| fs::read_to_string(folder.path().join(name)).unwrap();
    (
        serde_json::from_str(&read("a.json")).unwrap(),
        read("a.html"),
    )
}

/// What is stored and gone is what there was, to rounding of the spin's energy.
fn assert_balanced(json: &Value) {
    let energy = &json["energy"];
    let start = energy["start_j"].as_f64().unwrap();
    assert!(start > 0.0);
    assert!(energy["imbalance_j"].as_f64().unwrap().abs() <= 1e-12 * start);
}

#[test]
fn a_rotor_with_two_ends_tells_of_each_ring() {
    let (json, page) = drop_json("two-plane");
    assert_eq!(json["model"]["rung"], "two-plane");
    let rings = json["rings"].as_array().unwrap();
    assert_eq!(rings.len(), 3);
    assert_eq!(rings[0]["name"], "left");
    let of_rings: usize = rings
        .iter()
        .map(|it| it["impacts"].as_array().unwrap().len())
        .sum();
    assert_eq!(json["impacts"].as_array().unwrap().len(), of_rings);
    // 1520 Hz is inside the band of a 0.2 ms pulse.
    assert_eq!(json["validity"]["verdict"], "bends");
    assert_balanced(&json);
    for words in [
        "Orbit in ring left",
        "Orbit in ring right",
        "Energy of the model",
        "first elastic mode",
    ] {
        assert!(page.contains(words), "{words}");
    }
}

#[test]
fn a_vertical_rotor_is_pulled_to_the_wall() {
    let (json, _) = drop_json("vertical");
    assert!(!json["impacts"].as_array().unwrap().is_empty());
    assert_balanced(&json);
}

#[test]
fn a_soft_support_tells_of_its_ring() {
    let (json, page) = drop_json("soft-support");
    assert_eq!(json["model"]["rung"], "support");
    assert_eq!(json["regime"], "backward_whirl");
    assert!(json["ring"]["held_peak_force_n"].as_f64().unwrap() > 34.0);
    assert!(json["ring"].get("cage_rad_s").is_none());
    assert_balanced(&json);
    assert!(page.contains("Orbit in the retainer ring"));
}

#[test]
fn a_ball_bearing_tells_of_its_inner_ring() {
    let (json, page) = drop_json("ball-bearing");
    let ring = &json["ring"];
    let speed = |key: &str| ring[key].as_f64().unwrap();
    assert!((speed("cage_rad_s") / speed("inner_ring_rad_s") - 0.44).abs() < 1e-9);
    assert!(speed("temperature_rise_k") > 0.0);
    assert_balanced(&json);
    assert!(page.contains("Speed of rotor, inner ring and cage"));
    let folder = TempDir::new().unwrap();
    touchdown(folder.path())
        .args(["drop", "ball-bearing", "--stream", "a.csv"])
        .assert()
        .success();
    let stream = fs::read_to_string(folder.path().join("a.csv")).unwrap();
    let head = stream.lines().next().unwrap();
    assert!(
        head.contains("inner_ring_edges") && head.contains("cage_edges"),
        "{head}"
    );
    touchdown(folder.path())
        .args(["replay", "a.csv", "--scene", "ball-bearing"])
        .assert()
        .success();
}

/// Parts that the rung lacks are named, on standard error and in the explanation.
#[test]
fn what_a_rung_leaves_out_of_a_scene_is_said() {
    let folder = TempDir::new().unwrap();
    let scene = include_str!("../../../host-sim/scenes/soft-support.toml");
    let scene = format!("{scene}\n[model]\nrung = \"rigid\"\n");
    fs::write(folder.path().join("s.toml"), scene).unwrap();
    touchdown(folder.path())
        .args(["scene", "explain", "s.toml"])
        .assert()
        .success()
        .stderr(contains(
            "retainer's mass, spring, damper: given, but only rung support has it",
        ))
        .stdout(contains("3: x, y, spin"));
    touchdown(folder.path())
        .args(["scene", "explain", "soft-support"])
        .assert()
        .success()
        .stdout(contains("5: x, y, spin; ring x, y"))
        .stdout(contains("instructions a step in contact"))
        .stdout(contains("bytes"));
}

/// The table takes the rung of the scene's parts in, and the others without them.
#[test]
fn the_trade_has_the_new_rungs() {
    for (scene, rung) in [("soft-support", "support"), ("two-plane", "two-plane")] {
        let text = match scene {
            "two-plane" => include_str!("../../../host-sim/scenes/two-plane.toml"),
            _ => include_str!("../../../host-sim/scenes/soft-support.toml"),
        };
        let json = trade(&text.replace("duration_s = 0.3", "duration_s = 0.012"));
        let rows = json["rows"].as_array().unwrap();
        let best = |rung: &str| {
            let of_rung = rows.iter().filter(|row| row["rung"] == rung);
            of_rung
                .filter_map(|row| row["error_impact_1"].as_f64())
                .fold(f64::INFINITY, f64::min)
        };
        assert!(best(rung) < 1e-6, "{rung}: {}", best(rung));
        assert!(best("rigid") > 1e3 * best(rung), "{}", best("rigid"));
        assert!(
            rows.iter()
                .any(|row| row["rung"] == rung && row["mcu_instructions_per_step"].is_number())
        );
    }
}
