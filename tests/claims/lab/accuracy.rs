//! The errors that a run tells of itself cover its true ones.

use std::process::Command;

use serde_json::Value;
use touchdown_scene::BUILT_IN;
use touchdown_tests::accuracy_runs;
use touchdown_tests::binary::program;

/// Drops of each kind; all of it: `--example accuracy`.
const DROPS: u64 = 64;

#[test]
fn told_errors_cover_the_true_ones() {
    let kinds = accuracy_runs::run(DROPS, 1_000_001);
    for it in &kinds {
        println!("{it:?}");
        assert!(it.impacts > 300, "{it:?}");
        assert!(it.over[0] < 10.0, "{it:?}");
    }
    // Of these seeds. Over more: docs/know/accuracy.md.
    let [plane, two_ends] = &kinds[..] else {
        panic!("{kinds:?}")
    };
    assert_eq!((plane.told, plane.beyond), (plane.impacts, 0), "{plane:?}");
    // Where walls jam none is told.
    assert!(two_ends.told * 100 > two_ends.impacts * 95, "{two_ends:?}");
    assert_eq!(two_ends.beyond, 0, "{two_ends:?}");
}

fn accuracy(arguments: &[&str]) -> (String, Value) {
    let (text, json) = drop_of(arguments);
    (text, json["accuracy"].clone())
}

fn drop_of(arguments: &[&str]) -> (String, Value) {
    let said = Command::new(program())
        .arg("drop")
        .args(arguments)
        .args(["--json", "-"])
        .output()
        .expect("runs");
    assert!(said.status.success(), "{said:?}");
    let json: Value = serde_json::from_slice(&said.stdout).expect("JSON");
    let text = String::from_utf8(said.stderr).expect("text");
    (text, json)
}

#[test]
fn a_drop_tells_how_far_to_trust_it() {
    let (text, rig) = accuracy(&["rig"]);
    assert!(text.contains("accuracy: times of impacts to "), "{text}");
    let time = rig["impacts"][0]["time_s"].as_f64().expect("a time");
    assert!(time > 0.0 && time < 1e-15, "{time}");
    assert_eq!(rig["regime_is_certain"], true);
    let (text, chaotic) = accuracy(&["york-ymc2"]);
    assert!(text.contains("on not certain: read statistics"), "{text}");
    let impacts = chaotic["impacts"].as_array().expect("a list");
    let certain = chaotic["uncertain_from"].as_u64().expect("a number") as usize;
    assert!(0 < certain && certain < impacts.len() && impacts[certain].is_object());
    // The reference tells itself.
    let (text, none) = accuracy(&["rig", "--truth"]);
    assert!(text.contains("model off by") && none.is_null(), "{text}");
}

/// Friction wedges a sprung ring between rotor and stop: the model leaves it out, and all runs do so alike.
#[test]
fn no_error_is_told_from_where_walls_jam() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("jams.toml");
    let soft = BUILT_IN.iter().find(|it| it.name == "soft-support");
    let text = soft.expect("built in").text;
    let jams = text.replace("\nfriction = 0.1", "\nfriction = 2.0");
    assert_ne!(jams, text);
    std::fs::write(&path, jams).expect("written");
    let (text, json) = drop_of(&[path.to_str().expect("text")]);
    assert!(text.contains("model leaves friction out where walls jam"));
    let jammed = json["model_jammed_s"].as_f64().expect("a time");
    let impacts = json["impacts"].as_array().expect("a list");
    let errors = json["accuracy"]["impacts"].as_array().expect("a list");
    let mut told = 0;
    for (impact, error) in impacts.iter().zip(errors) {
        let at = impact["time_s"].as_f64().expect("a time");
        assert_eq!(error.is_object(), at < jammed, "{at} s of {jammed}: {error}");
        told += usize::from(error.is_object());
    }
    assert!(0 < told && told < impacts.len(), "{told}");
    assert_eq!(json["accuracy"]["regime_is_certain"], false);
}

/// Where a start that is a rounding off may be beyond the wall.
#[test]
fn a_drop_that_cannot_be_run_again_is_done_all_the_same() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("wall.toml");
    for start in ["x_mm = 0.3", "y_mm = -0.3", "x_mm = -0.3\nvx_mm_s = 5"] {
        let text = BUILT_IN[0].text.replace("x_mm = 0.02", start);
        assert!(text.contains(start) && text.contains("clearance_mm = 0.3"));
        std::fs::write(&path, text).expect("written");
        let (text, _) = accuracy(&[path.to_str().expect("text")]);
        assert!(text.contains("regime"), "{start}: {text}");
    }
}
