//! A recording of any size takes the same memory. Alone in its program, which is measured as a whole.

#![cfg(target_os = "linux")]

use std::fmt::Write;
use std::fs;
use std::io::Write as _;

use touchdown_files::recording::{Mapping, Reading};
use touchdown_page::json;
use touchdown_run::replay::{self, Orders};
use touchdown_run::target::Target;
use touchdown_scene::Scene;

const MAPPING: &str =
    "[time]\nrate_hz = 20000\n[ax]\ncolumn = 1\nunit = 'um'\n[ay]\ncolumn = 2\nunit = 'um'\n";

/// Most that the process has had in memory, KiB.
fn peak() -> u64 {
    let status = fs::read_to_string("/proc/self/status").unwrap();
    let line = status.lines().find_map(|it| it.strip_prefix("VmHWM:"));
    line.unwrap()
        .trim()
        .split(' ')
        .next()
        .unwrap()
        .parse()
        .unwrap()
}

#[test]
fn memory_does_not_grow_with_the_recording() {
    // An orbit; twice a second the rotor falls at 1.9 g and is caught again: events without end.
    let mut block = String::new();
    for k in 0..20_000 {
        let t = f64::from(k) / 20e3;
        let (x, y) = (20.0 * (600.0 * t).sin(), 20.0 * (600.0 * t).cos());
        let fallen = (t % 0.5).min(0.0125);
        let dip = (2.0 * std::f64::consts::PI * 40.0 * fallen).sin() * 290.0;
        writeln!(block, "{:.3},{:.3}", x, y - dip).unwrap();
    }
    let reading = Reading {
        mapping: Some(Mapping::parse("m.toml", MAPPING).unwrap()),
        resample: None,
    };
    let scene = Scene::load("rig").unwrap();
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("r.csv");
    let run = |blocks: u64| {
        let mut file = fs::File::create(&path).unwrap();
        (0..blocks).for_each(|_| file.write_all(block.as_bytes()).unwrap());
        let replay = replay::recording(&path, &reading, &scene, &Target::Host, &Orders::default()).unwrap();
        assert_eq!(replay.detection.summary.samples, 20_000 * blocks);
        let json = json::replay(&replay).unwrap();
        (peak(), replay.detection.events.len(), json.len())
    };
    let (small, few, _) = run(5);
    let (large, many, json) = run(40);
    assert!(few > 0, "no events: the bound on them is not tried");
    // Eight times the rows: what grows is the list of events, 1 KiB each with its JSON.
    let events = (many - few) as u64;
    assert!(
        large - small < 2048 + events,
        "{small} to {large} KiB for {events} events, {json} bytes"
    );
}
