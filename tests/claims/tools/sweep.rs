//! Sweeps: the same bytes on any number of threads, in any number of parts, however often killed; what a
//! drop of a sweep does is what `drop` does; plans that make no sense are refused.

use std::fs;
use std::path::Path;
use std::process::{Command, Stdio};
use std::time::Duration;

use rand::{Rng, SeedableRng};
use rand_chacha::ChaCha8Rng;
use serde_json::Value;
use touchdown_tests::binary::{program, touchdown};
use touchdown_tests::sweep_runs::{PLAN, folder, results};

fn sweep(folder: &Path, arguments: &[&str]) {
    touchdown(folder)
        .arg("sweep")
        .args(arguments)
        .assert()
        .success();
}

#[test]
fn threads_and_parts_do_not_change_a_byte() {
    let folder = folder(300);
    let at = folder.path();
    sweep(at, &["plan.toml", "--out", "whole"]);
    let whole = results(at, "whole");
    let one = touchdown(at)
        .args(["sweep", "plan.toml", "--out", "one"])
        .env("RAYON_NUM_THREADS", "1")
        .assert();
    one.success();
    assert_eq!(results(at, "one"), whole);
    for (part, out) in [("2/3", "parts"), ("3/3", "more"), ("1/3", "parts")] {
        sweep(at, &["plan.toml", "--out", out, "--shard", part]);
    }
    sweep(at, &["merge", "parts", "more"]);
    assert_eq!(results(at, "parts"), whole);
}

#[test]
fn what_is_missing_is_not_merged() {
    let folder = folder(300);
    let at = folder.path();
    sweep(at, &["plan.toml", "--out", "parts", "--shard", "1/3"]);
    let merged = touchdown(at).args(["sweep", "merge", "parts"]).assert();
    let error = String::from_utf8(merged.code(2).get_output().stderr.clone()).expect("text");
    assert!(error.contains("2 of 3 parts are missing"), "{error}");
    assert!(!at.join("parts/drops.csv").exists());
}

/// Killed for good, at 20 random moments of a run of about two seconds.
#[test]
fn a_killed_sweep_goes_on_where_it_was() {
    let folder = folder(4_000);
    let at = folder.path();
    sweep(at, &["plan.toml", "--out", "whole"]);
    let mut random = ChaCha8Rng::seed_from_u64(1);
    let mut interrupted = 0;
    for _ in 0..20 {
        let mut running = Command::new(program())
            .args(["sweep", "plan.toml", "--out", "killed"])
            .current_dir(at)
            .stdout(Stdio::null())
            .stderr(Stdio::null())
            .spawn()
            .expect("the program runs");
        std::thread::sleep(Duration::from_millis(random.random_range(5..150)));
        interrupted += u32::from(running.try_wait().expect("a status").is_none());
        running.kill().expect("a kill");
        running.wait().expect("an end");
    }
    assert!(interrupted > 0, "no run was cut short");
    sweep(at, &["plan.toml", "--out", "killed"]);
    assert_eq!(results(at, "killed"), results(at, "whole"));
}

/// A part that ends anywhere is refused and not replaced.
#[test]
fn a_part_that_was_cut_off_is_refused() {
    let folder = folder(20);
    let at = folder.path();
    sweep(at, &["plan.toml", "--out", "run"]);
    let part = at.join("run/part-1-of-1.csv");
    let bytes = fs::read(&part).expect("a part");
    let head = bytes.iter().position(|it| *it == b'\n').expect("a line") + 1;
    let mut random = ChaCha8Rng::seed_from_u64(2);
    for _ in 0..16 {
        // The last row without its end would still be whole.
        let place = random.random_range(0..bytes.len() - 2);
        fs::write(&part, &bytes[..place]).expect("a part");
        let run = touchdown(at)
            .args(["sweep", "plan.toml", "--out", "run"])
            .assert();
        let error = String::from_utf8(run.code(2).get_output().stderr.clone()).expect("text");
        let rule = if place < head - 1 {
            "is not the part of a sweep"
        } else {
            "remove the file, and run the part again"
        };
        assert!(error.contains(rule), "{place}: {error}");
        assert_eq!(fs::read(&part).expect("a part"), &bytes[..place]);
    }
}

#[test]
fn a_part_of_another_version_is_refused() {
    let folder = folder(2);
    let at = folder.path();
    sweep(at, &["plan.toml", "--out", "run"]);
    let part = at.join("run/part-1-of-1.csv");
    let text = fs::read_to_string(&part).expect("a part");
    let version = format!("\"version\":\"{}\"", env!("CARGO_PKG_VERSION"));
    assert!(text.contains(&version), "{text}");
    fs::write(&part, text.replacen(&version, "\"version\":\"0.0.7\"", 1)).expect("a part");
    for arguments in [
        ["sweep", "plan.toml", "--out=run"],
        ["sweep", "merge", "run"],
    ] {
        let run = touchdown(at).args(arguments).assert();
        let error = String::from_utf8(run.code(2).get_output().stderr.clone()).expect("text");
        assert!(error.contains("version 0.0.7"), "{error}");
    }
}

#[test]
fn parts_of_two_divisions_are_not_merged() {
    let folder = folder(2);
    let at = folder.path();
    for (part, out) in [("1/2", "a"), ("2/2", "a"), ("1/3", "b"), ("1/2", "c")] {
        sweep(at, &["plan.toml", "--out", out, "--shard", part]);
    }
    for (folders, rule) in [(["a", "b"], "keep one set"), (["a", "c"], "is part 1 of 2")] {
        let run = touchdown(at)
            .args(["sweep", "merge"])
            .args(folders)
            .assert();
        let error = String::from_utf8(run.code(2).get_output().stderr.clone()).expect("text");
        assert!(error.contains(rule), "{error}");
    }
}

#[test]
fn another_plan_does_not_go_on_with_the_parts() {
    let folder = folder(300);
    let at = folder.path();
    sweep(at, &["plan.toml", "--out", "run"]);
    let changed = PLAN.replace("DROPS", "300").replace("seed = 7", "seed = 8");
    fs::write(at.join("plan.toml"), changed).expect("a plan");
    let run = touchdown(at)
        .args(["sweep", "plan.toml", "--out", "run"])
        .assert();
    let error = String::from_utf8(run.code(2).get_output().stderr.clone()).expect("text");
    assert!(error.contains("another plan"), "{error}");
}

/// Rows of a sweep against `drop` on a scene with the row's values.
#[test]
fn a_drop_of_a_sweep_is_the_drop_of_its_scene() {
    let folder = folder(2);
    let at = folder.path();
    sweep(at, &["plan.toml", "--out", "run"]);
    let mut table = csv::Reader::from_path(at.join("run/drops.csv")).expect("a table");
    let head = table.headers().expect("a header").clone();
    let mut rows = 0;
    for row in table.records() {
        let row = row.expect("a row");
        let of = |name: &str| {
            let place = head.iter().position(|it| it == name).expect(name);
            row[place].to_owned()
        };
        let number = |name: &str| of(name).parse::<f64>().unwrap_or(f64::NAN);
        let clearance = number("retainer.clearance_mm");
        let scene = format!(
            "[rotor]\nmass_kg = 3.42\nradius_mm = 24\nspeed_rpm = -30000\n\
             [retainer]\nclearance_mm = {clearance}\nfriction = {}\nrestitution = {}\n\
             [start]\nx_mm = {}\ny_mm = {}\nvx_mm_s = {}\nvy_mm_s = {}\n[run]\nduration_s = 0.1\n",
            of("retainer.friction"),
            of("retainer.restitution"),
            number("start_x_rel") * clearance,
            number("start_y_rel") * clearance,
            number("start_vx_m_s") * 1e3,
            number("start_vy_m_s") * 1e3,
        );
        fs::write(at.join("one.toml"), scene).expect("a scene");
        let run = touchdown(at)
            .args(["drop", "one.toml", "--json", "-"])
            .assert();
        let json: Value = serde_json::from_slice(&run.success().get_output().stdout).expect("JSON");
        let impacts = json["impacts"].as_array().expect("a list");
        let fastest = impacts
            .iter()
            .filter_map(|it| it["normal_speed_m_s"].as_f64());
        let fastest = fastest.fold(0.0, f64::max);
        // The start goes through millimetres and back, which rounds.
        let close = |a: f64, b: f64| (a - b).abs() <= 1e-9 * b.abs();
        assert!(close(number("impact_speed_max_m_s"), fastest), "{row:?}");
        assert_eq!(of("regime"), json["regime"], "{row:?}");
        rows += 1;
    }
    assert_eq!(rows, 12);
}

#[test]
fn plans_that_make_no_sense_are_refused() {
    let folder = folder(2);
    let at = folder.path();
    for (text, line, rule) in [
        ("scene = \"nowhere\"", 1, "no such file"),
        ("scene = \"rig\"\ndrops = 10", 2, "random"),
        (
            "scene = \"rig\"\ndrops = 1\n[[parameter]]\nkey = \"retainer.friction\"\nvalues = [-1]",
            4,
            "friction",
        ),
        (
            "scene = \"rig\"\ndrops = 1\n[[parameter]]\nkey = \"retainer.wear\"\nvalues = [1]",
            4,
            "unknown key",
        ),
        (
            "scene = \"rig\"\ndrops = 1\n[[parameter]]\nkey = \"retainer.friction\"\nuniform = [0.1, 0.2, 0.3]",
            5,
            "must have 2 numbers, has 3",
        ),
        (
            "scene = \"rig\"\ndrops = 1\n[[parameter]]\nkey = \"retainer.friction\"\nlog_uniform = [0.1]",
            5,
            "must have 2 numbers, has 1",
        ),
        (
            "scene = \"rig\"\ndrops = 1\n[[parameter]]\nkey = \"retainer.friction\"\nnormal = [0.1, 0.2, 0.3]",
            5,
            "must have 2 numbers, has 3",
        ),
        ("drops = 1", 1, "missing required key"),
        ("scene = 1", 1, "expected a string"),
    ] {
        fs::write(at.join("bad.toml"), text).expect("a plan");
        let run = touchdown(at).args(["sweep", "bad.toml"]).assert();
        let error = String::from_utf8(run.code(2).get_output().stderr.clone()).expect("text");
        assert!(
            error.contains(&format!("bad.toml:{line}")),
            "{text}: {error}"
        );
        assert!(error.contains(rule), "{text}: {error}");
    }
}

/// A plan may name any file of the machine as its scene: none of its text is shown.
#[test]
fn a_scene_that_a_plan_names_is_not_quoted() {
    let folder = folder(2);
    let at = folder.path();
    for secret in [
        "root:hunter2:0",
        "hunter2 = 1\n",
        "[rotor]\nmass_kg = \"hunter2\"\n",
    ] {
        fs::write(at.join("other"), secret).expect("a file");
        fs::write(at.join("bad.toml"), "scene = \"other\"").expect("a plan");
        let run = touchdown(at).args(["sweep", "bad.toml"]).assert();
        let error = String::from_utf8(run.code(2).get_output().stderr.clone()).expect("text");
        assert!(error.contains("other:"), "{error}");
        assert!(!error.contains("hunter2"), "{error}");
    }
}
