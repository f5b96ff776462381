//! The commissioning check: found within its errors, refused where it cannot be known, kept by a configuration.

use std::fs;
use std::path::Path;

use assert_cmd::assert::Assert;
use predicates::str::contains;
use serde_json::Value;
use touchdown_files::configuration::{parse, text};
use touchdown_tests::binary::touchdown;
use touchdown_tests::controller::settings;
use touchdown_tests::led_rounds::{RESOLUTION, Truth, example, readings, run, stream};
use touchdown_tests::plant::Rng;

/// A fixed slice of what the example measures; the errors of some hundred numbers hold the truth 19 times in 20.
#[test]
fn zero_gain_skew_and_radius_are_found_within_their_errors() {
    let summary = run(40, 1);
    assert!(summary.refused.is_empty(), "{:?}", summary.refused);
    let (mut covered, mut count) = (0.0, 0.0);
    for row in &summary.rows {
        assert!(row.count >= 20 && row.within == 1.0, "{row:?}");
        covered += row.covered * row.count as f64;
        count += row.count as f64;
    }
    assert!((0.92..=0.99).contains(&(covered / count)), "{summary:?}");
}

/// What no wall bounds, or too little of it, is refused with its reason.
#[test]
fn what_cannot_be_known_is_refused() {
    let mut rng = Rng(3);
    let truth = Truth::wrong(&mut rng, 0.3e-3);
    let scale = None;
    let mut refusal = |arc: f64, noise: f64| {
        let readings = readings(&mut rng, &truth, arc, noise);
        match touchdown_calibrate::plane(&readings, RESOLUTION, scale) {
            Ok(plane) => plane.why_not().unwrap_or_default(),
            Err(why) => why,
        }
    };
    assert_eq!(refusal(6.2, 1e-6), "");
    assert!(refusal(2.6, 1e-6).contains("degrees of the wall were touched"));
    assert!(refusal(6.2, 12e-6).contains("the residual is"));
    assert_ne!(refusal(6.2, 30e-6), "");
    let still = vec![[1e-6, 2e-6]; 2_000];
    assert!(touchdown_calibrate::plane(&still, RESOLUTION, scale).is_err());
    assert!(touchdown_calibrate::plane(&[], RESOLUTION, scale).is_err());
}

fn calibrate(at: &Path, words: &str) -> Assert {
    touchdown(at).arg("calibrate").args(words.split(' ')).assert()
}

#[test]
fn a_record_is_a_configuration() {
    let folder = tempfile::tempdir().expect("a folder");
    let at = folder.path();
    fs::write(at.join("led.csv"), example()).expect("a recording");
    fs::write(at.join("old.toml"), text(&settings())).expect("a file");
    calibrate(at, "led.csv --config old.toml --date 2026-11-23 --write new.toml --json j.json --report r.html")
        .success();
    let new = fs::read_to_string(at.join("new.toml")).expect("a file");
    assert!(new.contains("[calibration]\ndate = \"2026-11-23\"\nmachine = \"old.toml\""), "{new}");
    let found = parse("new.toml", &new).expect("a configuration");
    assert!(found.monitor.commissioned);
    let calibration = found.monitor.sensing.calibration.expect("a record");
    assert_eq!(calibration.date, 20_261_123);
    let told: Value = serde_json::from_slice(&fs::read(at.join("j.json")).expect("it")).expect("JSON");
    for (plane, found) in ["a", "b"].iter().zip(calibration.planes) {
        let value = &told["planes"][plane]["gain"][1]["value"];
        assert_eq!(value.as_f64().expect("a number") as f32, found.gain[1]);
    }
    // All else is as it was.
    let mut rest = found;
    rest.monitor.sensing.calibration = None;
    rest.monitor.commissioned = false;
    assert_eq!(rest, settings());
    // A scene takes the same table.
    let table = &new[new.find("[calibration]").expect("it")..];
    let scene = touchdown_scene::BUILT_IN[0].text.to_owned() + "\n" + table;
    fs::write(at.join("my.toml"), scene).expect("a scene");
    calibrate(at, "led.csv --scene my.toml --scale sensor --write sensor.toml").success();
    let sensor = fs::read_to_string(at.join("sensor.toml")).expect("a file");
    let sensor = parse("sensor.toml", &sensor).expect("a configuration");
    let gains = sensor.monitor.sensing.calibration.expect("a record").planes.map(|it| it.gain[0]);
    assert_eq!(gains, [1.0; 2]);
    assert!((sensor.monitor.detector.machine.clearance - 0.3e-3).abs() > 1e-6);
}

#[test]
fn refusals_and_bad_input_have_their_status() {
    let folder = tempfile::tempdir().expect("a folder");
    let at = folder.path();
    let truth = Truth::wrong(&mut Rng(5), 0.3e-3);
    fs::write(at.join("part.csv"), stream(5, &[truth], 2.0)).expect("a recording");
    calibrate(at, "part.csv --scene rig --write c.toml --json j.json")
        .code(1)
        .stderr(contains("part.csv: plane a: "));
    assert!(!at.join("c.toml").exists());
    assert!(at.join("j.json").exists());
    calibrate(at, "nothing.csv --scene rig").code(2).stderr(contains("nothing.csv: no such file"));
    calibrate(at, "part.csv").code(2).stderr(contains("--scene"));
    calibrate(at, "part.csv --scene rig --clearance -1").code(2);
    calibrate(at, "part.csv --scene rig --date yesterday").code(2);
    let good = text(&settings());
    for (table, why) in [
        ("date = \"2026-13-01\"", "date must be a day as \"2026-12-31\""),
        ("date = \"2026-12-01\"\n[calibration.a]\nzero_um = [0.0, 0.0]\ngain = [7.0, 1.0]\nskew_deg = 0.0", "gain of plane a must be 0.2 to 5, is 7"),
        ("date = \"2026-12-01\"\n[calibration.b]\nzero_um = [0.0, 0.0]\ngain = [1.0, 1.0]\nskew_deg = 50.0", "skew_deg of plane b must be"),
    ] {
        // `[guard]` stays the last table.
        let file = good.replace("[guard]", &format!("[calibration]\n{table}\n\n[guard]"));
        fs::write(at.join("c.toml"), file).expect("a file");
        calibrate(at, "part.csv --config c.toml").code(2).stderr(contains(why));
    }
}
