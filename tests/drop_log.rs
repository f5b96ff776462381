//! The drop log's reader: what was recorded comes out, damage is counted and told, no bytes crash it.

use std::fs;

use proptest::prelude::*;
use serde_json::Value;
use touchdown_core::log::block::BLOCK_BYTES;
use touchdown_core::log::reader::Verdict;
use touchdown_sim::drop_log::{Dump, is_sound};
use touchdown_tests::binary::touchdown;
use touchdown_tests::episode::{SAMPLES, dump, episode};

fn json(folder: &std::path::Path, arguments: &[&str]) -> Value {
    let run = touchdown(folder).arg("log").args(arguments).assert();
    serde_json::from_slice(&run.success().get_output().stdout).expect("JSON")
}

#[test]
fn what_was_recorded_comes_out() {
    let folder = tempfile::tempdir().expect("a folder");
    let at = folder.path();
    fs::write(at.join("flash.bin"), dump(&[episode(2), episode(1)])).expect("a dump");
    let all = json(at, &["list", "flash.bin", "--json", "-"]);
    assert_eq!(all["counters"]["boots"], 7);
    let numbers: Vec<_> = (all["episodes"].as_array().expect("a list").iter())
        .map(|it| (it["sequence"].as_u64(), it["verdict"].as_str()))
        .collect();
    assert_eq!(
        numbers,
        [(Some(1), Some("whole")), (Some(2), Some("whole"))]
    );

    let shown = json(at, &["show", "flash.bin", "1", "--json", "-"]);
    let event = &shown["events"][0];
    assert_eq!(event["declared_s"], 0.0);
    assert!((event["onset_s"].as_f64().expect("a time") + 0.75e-3).abs() < 1e-9);

    let run = ["log", "export", "flash.bin", "1", "--out", "s.csv"];
    touchdown(at).args(run).assert().success();
    let mut rows = csv::Reader::from_path(at.join("s.csv")).expect("a stream");
    let rows: Vec<csv::StringRecord> = rows.records().map(|it| it.expect("a row")).collect();
    assert_eq!(rows.len(), SAMPLES);
    let number = |row: usize, column: usize| rows[row][column].parse::<f64>().expect("a number");
    for k in [0, 100, SAMPLES - 1] {
        assert!((number(k, 0) - (k as f64 - 100.0) / 20e3).abs() < 1e-12);
        assert!((number(k, 1) - 0.5 * (k as f64 + 0.5)).abs() < 1e-4, "{k}");
        assert!((number(k, 4) + 0.5 * 47.5).abs() < 1e-4, "{k}");
    }
    // A stream like any other.
    let run = ["replay", "s.csv", "--scene", "rig", "--json", "-"];
    touchdown(at).args(run).assert().success();

    let run = [
        "log",
        "export",
        "flash.bin",
        "--format",
        "comtrade",
        "--out",
        "e",
    ];
    touchdown(at).args(run).assert().success();
    let cfg = fs::read_to_string(at.join("e.cfg")).expect("a configuration");
    let lines: Vec<_> = cfg.lines().collect();
    assert_eq!(lines[1], "4,4A,0D");
    assert_eq!(lines[8], "20000,300");
    assert_eq!(lines[9], "01/01/1970,00:00:04.995000");
    let dat = fs::read_to_string(at.join("e.dat")).expect("data");
    assert_eq!(dat.lines().next(), Some("1,0,2048,2047,2048,2000"));
    assert_eq!(dat.lines().count(), SAMPLES);
    // Which `replay` reads as well: time 0 is the trigger there too.
    let events = |name: &str| {
        let run = ["replay", name, "--scene", "rig", "--json", "-"];
        let run = touchdown(at).args(run).assert().success();
        serde_json::from_slice::<Value>(&run.get_output().stdout).expect("JSON")
    };
    assert_eq!(events("e.cfg"), events("s.csv"));
}

#[test]
fn damage_is_counted_and_told() {
    let folder = tempfile::tempdir().expect("a folder");
    let at = folder.path();
    let (mut torn, mut cut) = (episode(1), episode(2));
    torn[5][100] ^= 1;
    cut.truncate(7);
    fs::write(at.join("flash.bin"), dump(&[torn, cut, episode(3)])).expect("a dump");
    let all = json(at, &["list", "flash.bin", "--json", "-"]);
    let verdicts = [0, 1, 2].map(|k| all["episodes"][k]["verdict"].clone());
    assert_eq!(verdicts, ["damaged", "incomplete", "whole"]);
    assert_eq!(all["episodes"][0]["report"]["missing"], 1);
    touchdown(at)
        .args(["log", "verify", "flash.bin"])
        .assert()
        .code(1);
    // What the damaged block held is missing, not made up.
    let run = ["log", "export", "flash.bin", "1", "--out", "s.csv"];
    touchdown(at).args(run).assert().success();
    let stream = fs::read_to_string(at.join("s.csv")).expect("a stream");
    assert_eq!(stream.matches("NaN,NaN,NaN,NaN").count(), 30);
}

#[test]
fn what_is_no_log_is_refused() {
    let folder = tempfile::tempdir().expect("a folder");
    let at = folder.path();
    for (name, bytes) in [("empty", vec![]), ("text", b"time_s,ax_um\n".repeat(2000))] {
        fs::write(at.join(name), bytes).expect("a file");
        touchdown(at).args(["log", "list", name]).assert().code(2);
    }
    touchdown(at).args(["log", "list", "."]).assert().code(2);
    touchdown(at)
        .args(["log", "list", "nowhere"])
        .assert()
        .code(2);
    fs::write(at.join("one.bin"), episode(4).as_flattened()).expect("a file");
    let shown = json(at, &["show", "one.bin", "--json", "-"]);
    assert_eq!(shown["sequence"], 4);
    touchdown(at)
        .args(["log", "show", "one.bin", "5"])
        .assert()
        .code(2);
}

proptest! {
    #[test]
    fn any_bytes_are_read(bytes in prop::collection::vec(any::<u8>(), 0..20_000)) {
        let dump = Dump::of(&bytes);
        prop_assert!(dump.episodes.len() <= 1);
    }

    #[test]
    fn a_wrong_bit_costs_one_block_at_most(place in 0..14 * BLOCK_BYTES * 8) {
        let mut pages = episode(1);
        let count = pages.len();
        let (page, bit) = ((place / 8 / BLOCK_BYTES) % count, place % (8 * BLOCK_BYTES));
        pages[page][bit / 8] ^= 1 << (bit % 8);
        let dump = Dump::of(&dump(&[pages]));
        let found = &dump.episodes[0];
        prop_assert_eq!(found.report.broken, 1);
        prop_assert!(found.samples.iter().flatten().count() + 30 >= SAMPLES);
        prop_assert_eq!(is_sound(&dump), found.verdict == Verdict::Whole);
    }
}
