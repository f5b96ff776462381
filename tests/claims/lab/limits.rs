//! `touchdown limits`: every extreme is there, in both precisions, and holds.

use std::collections::{BTreeMap, BTreeSet};
use std::sync::OnceLock;

use predicates::str::contains;
use serde_json::Value;
use tempfile::TempDir;
use touchdown_lab::limits::machine_rows;
use touchdown_tests::binary::touchdown;

/// What a designer would try to break it with.
const EXTREMES: [&str; 38] = [
    "step of 1 us",
    "step of 1 ms",
    "restitution 0:",
    "restitution 0.99",
    "restitution 1:",
    "friction 0",
    "friction 1",
    "friction 2",
    "gap of 10 um",
    "gap of 20 um",
    "gap of 2 mm",
    "no spin",
    "spin reversed",
    "spin of 1 000 000 rpm",
    "no gravity",
    "start at the very centre",
    "start at rest on the wall",
    "start on the wall, moving outward",
    "start on the wall, moving inward",
    "start along the wall where it falls away",
    "whirl against the spin",
    "slip used up",
    "the worst of all at once",
    "graze",
    "no normal speed where gravity pulls off the wall",
    "no wall force at the start",
    "rolling that needs all the friction",
    "impact with just the friction",
    "whirl to rolling at 0.8 rad a step",
    "h mu v of 2",
    "whole bounce series in one step",
    "hundreds of impacts in one step",
    "denormal",
    "10^9 ticks",
    "NaN and infinity",
    "start outside the gap",
    "hertz: straight impact, restitution 0, which is 0.02",
    "hertz: straight impact, restitution 1:",
];

/// Of the scenes above, those that the rungs `moreau` and `hertz` run too.
const SCENES: usize = 23;

/// The command is run once for all tests: its exit status, what it says and its JSON.
fn answer() -> &'static (Option<i32>, String, Value) {
    static ANSWER: OnceLock<(Option<i32>, String, Value)> = OnceLock::new();
    ANSWER.get_or_init(|| {
        let folder = TempDir::new().unwrap();
        let output = touchdown(folder.path())
            .args(["limits", "--json", "limits.json"])
            .output()
            .unwrap();
        let text = std::fs::read_to_string(folder.path().join("limits.json")).unwrap();
        let said = String::from_utf8(output.stdout).unwrap();
        (
            output.status.code(),
            said,
            serde_json::from_str(&text).unwrap(),
        )
    })
}

fn rows() -> &'static [Value] {
    answer().2["rows"].as_array().unwrap()
}

#[test]
fn every_limit_holds() {
    let (status, said, _) = answer();
    println!("{said}");
    assert_eq!(*status, Some(0));
    assert!(said.contains("all hold") && said.contains("wrote limits.json"));
    for row in rows() {
        let [measured, limit] = ["measured", "limit"].map(|key| row[key].as_f64().unwrap());
        assert_eq!(row["holds"], true, "{row}");
        assert!(
            measured.is_finite() && limit.is_finite() && measured <= limit,
            "{row}"
        );
    }
}

#[test]
fn rows_have_these_keys_and_no_others() {
    assert_eq!(answer().2.as_object().unwrap().len(), 1);
    for row in rows() {
        let keys: BTreeSet<_> = row
            .as_object()
            .unwrap()
            .keys()
            .map(String::as_str)
            .collect();
        let want = ["extreme", "holds", "limit", "measured", "precision", "unit"];
        assert_eq!(keys, BTreeSet::from(want));
        assert!(!row["unit"].as_str().unwrap().is_empty(), "{row}");
    }
}

#[test]
fn every_extreme_is_measured_once_in_each_precision() {
    let mut precisions: BTreeMap<&str, Vec<&str>> = BTreeMap::new();
    for row in rows() {
        let [extreme, precision] = ["extreme", "precision"].map(|key| row[key].as_str().unwrap());
        precisions.entry(extreme).or_default().push(precision);
    }
    for (extreme, found) in &mut precisions {
        found.sort_unstable();
        assert_eq!(*found, ["f32", "f64"], "{extreme}");
    }
    for extreme in EXTREMES {
        assert!(
            precisions.keys().any(|name| name.contains(extreme)),
            "{extreme}"
        );
    }
}

/// Every scene on every rung; steps that are too long for a contact are refused in each.
#[test]
fn the_rungs_that_integrate_are_there() {
    let has = |extreme: &str, measure: &str| {
        let found = |row: &&Value| {
            let name = row["extreme"].as_str().unwrap();
            name.starts_with(extreme) && name.ends_with(measure)
        };
        assert!(rows().iter().any(|row| found(&row)), "{extreme} {measure}");
    };
    for extreme in &EXTREMES[..SCENES] {
        let [moreau, hertz] = ["moreau", "hertz"].map(|rung| format!("{rung}: {extreme}"));
        has(&moreau, "energy gained");
        has(&moreau, "farthest beyond the wall");
        has(&moreau, "steps with NaN or infinity");
        has(&hertz, "steps above 2/omega_c");
        if *extreme != "step of 1 ms" {
            has(&hertz, "energy gained at T_c/25 and below");
            has(&hertz, "deepest compression");
            has(&hertz, "steps with NaN or infinity");
        }
    }
}

#[test]
fn a_file_that_cannot_be_written_is_bad_usage() {
    let folder = TempDir::new().unwrap();
    touchdown(folder.path())
        .args(["limits", "--json", "no/such/folder/limits.json"])
        .assert()
        .code(2)
        .stderr(contains("cannot be written"));
}

/// A wall that gives way is left where it ends, and not as soon as it presses no more: else contacts make energy in this one.
#[test]
fn machine_319_holds_all_limits() {
    let rows = machine_rows(319).unwrap();
    let broken: Vec<_> = rows.iter().filter(|row| !row.holds).collect();
    assert!(broken.is_empty(), "{broken:?}");
}
