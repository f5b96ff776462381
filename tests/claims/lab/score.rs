//! `touchdown score`: shape and reproducibility of its answer, and that it can fail.

use std::collections::BTreeSet;
use std::sync::OnceLock;

use predicates::str::contains;
use serde_json::Value;
use tempfile::TempDir;
use touchdown_core::detect::Tuning;
use touchdown_lab::score::{GROUPS, Plan, Row, Score, run};
use touchdown_run::target::Target;
use touchdown_tests::binary::touchdown;

/// Exit status, what it says, JSON and page.
struct MonitorOutput {
    status: Option<i32>,
    said: String,
    json: String,
    page: String,
}

impl MonitorOutput {
    fn value(&self) -> Value {
        serde_json::from_str(&self.json).unwrap()
    }
}

fn asked(threads: &str, seed: &str) -> MonitorOutput {
    let folder = TempDir::new().unwrap();
    let output = touchdown(folder.path())
        .env("RAYON_NUM_THREADS", threads)
        .args(["score", "--quick", "--first-seed", seed])
        .args(["--json", "s.json", "--report", "s.html"])
        .output()
        .unwrap();
    let read = |name| std::fs::read_to_string(folder.path().join(name)).unwrap();
    MonitorOutput {
        status: output.status.code(),
        said: String::from_utf8(output.stdout).unwrap(),
        json: read("s.json"),
        page: read("s.html"),
    }
}

/// Run once for all tests.
fn answer() -> &'static MonitorOutput {
    static ANSWER: OnceLock<MonitorOutput> = OnceLock::new();
    ANSWER.get_or_init(|| asked("2", "7"))
}

#[test]
fn every_group_has_rows_with_case_target_and_verdict() {
    let json = answer().value();
    assert_eq!(json["seeds"], 2);
    assert_eq!(json["first_seed"], 7);
    let groups = json["groups"].as_object().unwrap();
    let names: BTreeSet<_> = groups.keys().map(String::as_str).collect();
    assert_eq!(names, GROUPS.iter().map(|group| group.name).collect());
    for (group, rows) in groups {
        let mut seen = BTreeSet::new();
        for row in rows.as_array().unwrap() {
            let quantity = row["quantity"].as_str().unwrap();
            let target = row["target"].as_f64().unwrap();
            let holds = row["holds"].as_bool().unwrap();
            assert!(
                seen.insert((row["case"].as_str().unwrap(), quantity)),
                "{row}"
            );
            let measured = row.get(quantity).expect("the quantity has its key");
            let within = measured.as_f64().is_some_and(|measured| {
                if row["at_least"].as_bool().unwrap() {
                    measured >= target
                } else {
                    measured <= target
                }
            });
            assert!(!holds || within, "{row}");
            assert!(!holds || row["undecided"] == false, "{row}");
        }
        assert!(seen.len() >= 4, "{group}: {}", seen.len());
    }
    for row in groups["fall"].as_array().unwrap() {
        for key in ["latency_median_s", "latency_p99_s", "bound_s", "ratio"] {
            assert!(row[key].is_number() || row[key].is_null(), "{key} {row}");
        }
        assert!(row["drops"] == 2 && row["bound_s"].as_f64().unwrap() > 0.0);
    }
}

#[test]
fn the_status_is_the_verdict() {
    let answer = answer();
    let json = answer.value();
    let groups = json["groups"].as_object().unwrap();
    let mut rows = groups.values().flat_map(|rows| rows.as_array().unwrap());
    assert!(rows.clone().any(|row| row["holds"] == true));
    let failed = rows.any(|row| row["holds"] == false && row["undecided"] == false);
    assert_eq!(answer.status, Some(i32::from(failed)));
    assert_eq!(answer.said.contains("do not hold"), failed);
    assert!(answer.said.contains("wrote s.json") && answer.said.contains("wrote s.html"));
}

/// Two drops of each case, of which some miss a target by chance and some have nothing to judge.
#[test]
fn a_quick_look_ends_well_where_nothing_fails() {
    let answer = asked("2", "1");
    let json = answer.value();
    let groups = json["groups"].as_object().unwrap();
    let rows = || groups.values().flat_map(|rows| rows.as_array().unwrap());
    let undecided = rows().filter(|row| row["undecided"] == true);
    assert!(undecided.count() > 0);
    for row in rows().filter(|row| row["undecided"] == true) {
        assert_eq!(row["holds"], false, "{row}");
    }
    assert_eq!(answer.status, Some(0), "{}", answer.said);
    assert!(
        answer.said.contains("none fails") && answer.said.contains("undecided with so few trials")
    );
    assert!(answer.page.contains("<td>undecided</td>"));
}

#[test]
fn the_page_has_a_picture_of_each_kind_and_loads_nothing() {
    let page = &answer().page;
    for title in [
        "Latency of a fall against noise",
        "Latency of a fall over its bound",
        "Latency of an impact over the bound",
        "Phases over time",
        "Regime at the end",
    ] {
        assert!(page.contains(title), "{title}");
    }
    for from_outside in ["http", "src=", "<link", "<img", "@import", "url("] {
        assert!(!page.contains(from_outside), "{from_outside}");
    }
}

#[test]
fn a_seed_gives_the_same_answer_on_any_number_of_threads() {
    let first = answer();
    let again = asked("1", "7");
    assert_eq!(first.json, again.json);
    assert_eq!(first.said, again.said);
    assert_ne!(first.json, asked("2", "8").json);
}

fn of(groups: &[&'static str], tuning: Tuning) -> Score {
    let plan = Plan {
        groups: groups.to_vec(),
        seeds: 4,
        first_seed: 1,
        seconds: 2.0,
        tuning,
    };
    run(&plan, &Target::Host).unwrap()
}

fn case<'a>(score: &'a Score, name: &str) -> &'a Row {
    score.rows().find(|row| row.case == name).expect("measured")
}

const FALL: &str = "white noise 1 um, 20 kHz, two planes";
const QUIET: &str = "white noise 1 um";

#[test]
fn a_nervous_detector_does_not_hold() {
    let nervous = Tuning {
        false_alarm: 1e-2,
        ..Tuning::default()
    };
    let score = of(&["fall", "quiet"], nervous);
    let fall = case(&score, FALL);
    assert!(
        fall.fails() && fall.values["false_falls"].as_u64() > Some(0),
        "{fall:?}"
    );
    let quiet = case(&score, QUIET);
    assert!(quiet.fails() && quiet.measured() > Some(0.0), "{quiet:?}");
}

/// It finds a fall by the last 4 ms alone, which is late.
#[test]
fn a_detector_that_never_arms_does_not_hold() {
    let unarmed = Tuning {
        arming_time: 10.0,
        ..Tuning::default()
    };
    let score = of(&["fall", "quiet"], unarmed);
    let fall = case(&score, FALL);
    assert!(fall.fails() && fall.measured() > Some(3.0), "{fall:?}");
    let quiet = case(&score, QUIET);
    assert!(quiet.fails() && quiet.measured() == Some(0.0), "{quiet:?}");
}

#[test]
fn a_slow_detector_does_not_hold() {
    let slow = Tuning {
        false_alarm: 1e-15,
        release_horizon: 40e-3,
        ..Tuning::default()
    };
    let score = of(&["fall"], slow);
    let fall = case(&score, FALL);
    assert!(!fall.holds && fall.values["false_falls"] == 0, "{fall:?}");
    // Four drops of one case may be late by chance, not those of several.
    let late = score
        .rows()
        .filter(|row| row.case.starts_with("white noise"));
    let late: Vec<_> = late.filter(|row| row.fails()).collect();
    assert!(late.len() > 1, "{late:?}");
}

/// Rotors that go round with the spin once, are driven back and whirl against it: both whirls are told, both rightly. The second
/// one has just left the wall when the first whirl is told.
#[test]
fn a_whirl_that_is_driven_back_has_the_sign_that_it_had() {
    for first_seed in [500_001, 700_526] {
        let plan = Plan {
            groups: vec!["regime"],
            seeds: 1,
            first_seed,
            seconds: 1.0,
            tuning: Tuning::default(),
        };
        let score = run(&plan, &Target::Host).unwrap();
        let row = case(&score, "sign of a whirl");
        assert!(
            row.holds && row.values["told"].as_u64() >= Some(2),
            "{row:?}"
        );
    }
}

#[test]
fn only_what_is_asked_for() {
    let folder = TempDir::new().unwrap();
    let output = touchdown(folder.path())
        .args(["score", "--only", "regime,quiet", "--quick", "--json", "-"])
        .output()
        .unwrap();
    let json: Value = serde_json::from_slice(&output.stdout).unwrap();
    let groups: Vec<_> = json["groups"].as_object().unwrap().keys().collect();
    assert_eq!(groups, ["quiet", "regime"]);
}

#[test]
fn the_target_says_the_same() {
    let folder = TempDir::new().unwrap();
    let output = touchdown(folder.path())
        .args(["score", "--on", "qemu", "--seeds", "1", "--seconds", "1", "--json", "-"])
        .output()
        .unwrap();
    let said = String::from_utf8_lossy(&output.stderr);
    assert!(output.status.success(), "{said}");
    let json: Value = serde_json::from_slice(&output.stdout).unwrap();
    for group in GROUPS {
        let rows = json["groups"][group.name].as_array().unwrap();
        assert!(!rows.is_empty(), "{}", group.name);
        for row in rows {
            assert_eq!(
                (&row["drops"], &row["differences"]),
                (&1.into(), &0.0.into()),
                "{row}"
            );
            assert!(
                row["samples"].as_u64() > Some(1000) && row["notices"].as_u64() > Some(0),
                "{row}"
            );
        }
    }
}

#[test]
fn bad_usage() {
    let folder = TempDir::new().unwrap();
    for (arguments, complaint) in [
        (&["--only", "luck"][..], "possible values"),
        (&["--seeds", "0"], "1..="),
        (&["--seconds", "0"], "levitation of 1 to"),
        (&["--hours", "-1"], ""),
        (&["--quick", "--seeds", "3"], "cannot be used with"),
        (&["--json", "-", "--report", "-"], "two outputs"),
        (&["--image", "x"], "--image needs --on qemu"),
    ] {
        touchdown(folder.path())
            .arg("score")
            .args(arguments)
            .assert()
            .code(2)
            .stderr(contains(complaint));
    }
}
