//! The drop log's reader: what was recorded comes out, damage is counted and told, no bytes crash it.

use std::fs;

use proptest::prelude::*;
use serde_json::Value;
use touchdown_core::event::{Event, EventKind, Moment, Motion, Notice, Plane};
use touchdown_core::fault::{Fault, FaultKind, SPEED};
use touchdown_protocol::log::block::{BLOCK_BYTES, Block, Kind};
use touchdown_protocol::log::header::Header;
use touchdown_protocol::log::reader::Verdict;
use touchdown_files::drop_log::{Dump, is_sound, stream};
use touchdown_tests::binary::touchdown;
use touchdown_protocol::wire::{Record, encode_record};
use touchdown_tests::episode::{SAMPLES, TRIGGER, dump, episode, header, sealed};

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

/// A fault that was told in a drop is shown with its channel and kind.
#[test]
fn what_was_wrong_with_a_sensor_is_shown() {
    let folder = tempfile::tempdir().expect("a folder");
    let at = folder.path();
    let fault = Notice::Declared(Event {
        number: 1,
        kind: EventKind::SensorFault,
        onset: Moment::of_sample(TRIGGER),
        declared: TRIGGER,
        plane: Plane::Both,
        normal_speed: 0.0,
        motion: Motion::Cylindrical,
        fault: Some(Fault {
            channel: SPEED,
            kind: FaultKind::Missing,
        }),
    });
    let events = Block::of(Kind::Events, &encode_record(&Record::Notice(fault)));
    let header = Block::of(Kind::Header, &header().encode());
    let pages = [header.seal(1, 0), header.seal(1, 1), events.seal(1, 2)];
    fs::write(at.join("flash.bin"), dump(&[pages.to_vec()])).expect("a dump");
    let shown = json(at, &["show", "flash.bin", "--json", "-"]);
    let expected = serde_json::json!({ "channel": "speed", "kind": "missing" });
    assert_eq!(shown["events"][0]["fault"], expected);
    let run = touchdown(at).args(["log", "show", "flash.bin"]).assert();
    run.success().stdout(predicates::str::contains("speed missing"));
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
    let of = |key: &str| [0, 1, 2].map(|k| all["episodes"][k][key].clone());
    assert_eq!(of("verdict"), ["damaged", "incomplete", "whole"]);
    assert_eq!(of("damaged"), [true, false, false]);
    // It was counted at the next start, so nobody writes it still.
    assert_eq!(of("complete"), ["yes", "cut_off", "yes"]);
    assert_eq!(all["episodes"][0]["report"]["missing"], 1);
    let damage = serde_json::json!([{ "page": 5, "what": "broken" }]);
    assert_eq!(all["episodes"][0]["damage"], damage);
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

fn sound(bytes: &[u8]) -> bool {
    is_sound(&Dump::of(bytes))
}

#[test]
fn damage_is_told_from_a_cut_of_power() {
    let end = episode(1).len();
    // The page that was being written, wherever that was.
    for length in 2..end {
        let mut cut = episode(1);
        cut.truncate(length);
        cut[length - 1][200..].fill(0xff);
        assert!(sound(&dump(&[cut])), "{length}");
    }
    // Any page before it, or one more behind it.
    for page in 2..6 {
        let mut cut = episode(1);
        cut.truncate(8);
        cut[page][100] ^= 1;
        assert!(!sound(&dump(&[cut])), "{page}");
    }
    let mut both = episode(1);
    both[end - 1][100] ^= 1;
    assert!(sound(&dump(&[both.clone()])), "a copy is there");
    both[end - 2][100] ^= 1;
    assert!(!sound(&dump(&[both])), "both endings");
    let mut first = episode(1);
    first[..3].iter_mut().for_each(|page| page[9] ^= 1);
    assert!(!sound(&dump(&[first])), "all that tell whose it is");
}

#[test]
fn a_slot_that_is_given_up_is_no_damage() {
    let mut bytes = dump(&[episode(1), episode(2)]);
    let slot = 8192..8192 + 49_152;
    let marks = slot.end - BLOCK_BYTES;
    bytes[marks..marks + 8].fill(0);
    for sector in 0..=12 {
        bytes[slot.start..slot.start + sector * 4096].fill(0xff);
        let found = Dump::of(&bytes);
        let numbers: Vec<_> = found.episodes.iter().map(|it| it.sequence).collect();
        assert_eq!((numbers, is_sound(&found)), (vec![2], true), "{sector}");
    }
}

#[test]
fn headers_that_no_recorder_writes_are_damage() {
    let with = |change: &dyn Fn(&mut Header)| {
        let mut header = header();
        change(&mut header);
        dump(&[sealed(1, &header)])
    };
    assert!(sound(&with(&|_| ())));
    let changes: [&dyn Fn(&mut Header); 8] = [
        &|it| it.mounting_angle = [f32::NAN, 0.0],
        &|it| it.sample_rate = 0.0,
        &|it| it.sample_rate = f32::NAN,
        &|it| it.resolution = f32::INFINITY,
        &|it| it.zero_count = f32::NAN,
        &|it| it.decimation = 0,
        &|it| it.fitted = 0,
        &|it| it.first = it.trigger + 1,
    ];
    for (number, change) in changes.into_iter().enumerate() {
        let bytes = with(change);
        assert!(!sound(&bytes), "{number}");
        let found = &Dump::of(&bytes).episodes[0];
        assert_eq!(stream(found, Vec::new()).ok(), Some(false), "{number}");
    }
}

#[test]
fn one_number_in_two_slots_is_damage() {
    assert!(!sound(&dump(&[episode(1), episode(2), episode(1)])));
    assert!(sound(&dump(&[episode(1), episode(2), episode(3)])));
}

/// Written by the first format's firmware in a drop of the built-in rig.
#[test]
fn a_dump_of_format_1_stays_readable() {
    let bytes = include_bytes!("../../data/log-format-1.bin");
    for slots in [0, 1, 2, 41] {
        let mut bytes = bytes.to_vec();
        bytes.resize(bytes.len() + slots * 49_152, 0xff);
        let dump = Dump::of(&bytes);
        assert_eq!(dump.episodes.len(), 1);
        let episode = &dump.episodes[0];
        assert_eq!((episode.sequence, episode.damaged), (1, false));
        assert_eq!(episode.events[0].event, EventKind::FreeFall);
        assert!(episode.samples.iter().flatten().count() > 4_000);
    }
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
        // Only header and ending have a copy.
        let copied = page < 2 || page + 2 >= count;
        prop_assert_eq!(is_sound(&dump), copied);
        prop_assert_eq!(found.verdict == Verdict::Whole, copied);
    }
}
