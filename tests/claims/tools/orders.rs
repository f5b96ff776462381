//! `touchdown clear`, `log lock`, `log unlock`, `log erase`: what needs a right says so, what is done is told, and each
//! refusal has its reason; status 1 where the controller refuses, 2 where nobody answers.
#![cfg(unix)]

use std::fs;
use std::os::unix::fs::PermissionsExt;
use std::path::Path;
use std::sync::{Arc, Mutex};

use assert_cmd::assert::Assert;
use predicates::prelude::*;
use predicates::str::contains;
use serde_json::{Value, json};
use touchdown_core::event::{Act, Notice, Ordered};
use touchdown_protocol::config_block::Key;
use touchdown_protocol::controller::Busy;
use touchdown_protocol::link::Refusal;
use touchdown_tests::binary::touchdown;
use touchdown_tests::controller::{Controller, Machine};

const PORT: &str = "unix:rig.sock";

fn run(at: &Path, line: &str) -> Assert {
    touchdown(at).args(line.split(' ')).assert()
}

/// With episodes 1 to 4, at a standstill.
fn machine() -> Machine {
    let mut machine = Machine::default();
    machine.state.outputs.run = false;
    machine.episodes = (1..=4).map(|it| (it, vec![0; 8])).collect();
    machine
}

fn at_work(folder: &Path, machine: Machine) -> Controller {
    Controller::at_path(&folder.join("rig.sock"), Arc::new(Mutex::new(machine)))
}

#[test]
fn without_a_key_it_takes_the_service_input() {
    let folder = tempfile::tempdir().expect("a folder");
    let at = folder.path();
    let controller = at_work(at, machine());
    for order in [
        format!("clear {PORT}"),
        format!("log lock {PORT} 2"),
        format!("log unlock {PORT} 2"),
        format!("log erase {PORT} 2"),
    ] {
        run(at, &order)
            .code(1)
            .stdout(contains(": nothing is done"))
            .stderr(contains("its service input must be on"));
    }
    assert_eq!(controller.machine().episodes.len(), 4);
    controller.machine().service = true;
    run(at, &format!("clear {PORT}"))
        .success()
        .stdout(contains(": cleared"));
    run(at, &format!("log lock {PORT} 2"))
        .success()
        .stdout(contains("episode 2 is locked"));
    run(at, &format!("log erase {PORT} 2"))
        .code(1)
        .stderr(contains("refuses: the episode is locked"));
    run(at, &format!("log unlock {PORT} 2"))
        .success()
        .stdout(contains("episode 2 is no longer locked"));
    run(at, &format!("log erase {PORT} 2"))
        .success()
        .stdout(contains("episode 2 is erased"));
    run(at, &format!("log erase {PORT} 2"))
        .code(1)
        .stderr(contains("no such episode"));
    run(at, &format!("log erase {PORT} 4"))
        .code(1)
        .stderr(contains("the episode is the newest one"));
    controller.machine().state.outputs.run = true;
    run(at, &format!("log erase {PORT} 1"))
        .code(1)
        .stderr(contains("it watches, so the machine may run"));
    let left: Vec<_> = controller.machine().episodes.keys().copied().collect();
    assert_eq!(left, [1, 3, 4]);
}

#[test]
fn with_a_key_it_takes_the_file_of_the_key() {
    let folder = tempfile::tempdir().expect("a folder");
    let at = folder.path();
    let mut machine = machine();
    machine.key = Some(Key(core::array::from_fn(|it| it as u8)));
    machine.service = true;
    let _controller = at_work(at, machine);
    let key = at.join("k");
    fs::write(&key, "000102030405060708090A0B0C0D0E0F\n").expect("a file");
    fs::set_permissions(&key, fs::Permissions::from_mode(0o600)).expect("a mode");
    fs::write(at.join("wrong"), "ff0102030405060708090a0b0c0d0e0f\n").expect("a file");
    let no_right = "no right: it takes the key of its configuration (--key-file), within 5 s";
    run(at, &format!("clear {PORT}")).code(1).stderr(contains(no_right));
    run(at, &format!("clear {PORT} --key-file wrong"))
        .code(1)
        .stderr(contains(no_right));
    run(at, &format!("clear {PORT} --key-file k"))
        .success()
        .stderr("");
    run(at, &format!("log erase {PORT} 1 --key-file k")).success();
    // A key that others can read is used, and told of.
    fs::set_permissions(&key, fs::Permissions::from_mode(0o644)).expect("a mode");
    run(at, &format!("clear {PORT} --key-file k"))
        .success()
        .stderr(contains("warning: k: others can read this key"));
    run(at, &format!("clear {PORT} --key-file nothing"))
        .code(2)
        .stderr(contains("nothing: no such file"));
    run(at, &format!("clear {PORT} --key-file k --json k"))
        .code(2)
        .stderr(contains("an output must not replace an input"));
}

#[test]
fn what_came_of_an_order_is_json_done_or_not() {
    let folder = tempfile::tempdir().expect("a folder");
    let at = folder.path();
    let controller = at_work(at, machine());
    let told = |run: Assert| -> Value {
        serde_json::from_slice(&run.get_output().stdout).expect("JSON")
    };
    let erase = format!("log erase {PORT} 3 --json -");
    let why = "no right: it has no key, so its service input must be on";
    assert_eq!(
        told(run(at, &erase).code(1).stderr(contains(why))),
        json!({"port": PORT, "order": "erase", "episode": 3, "done": false, "why": why})
    );
    controller.machine().service = true;
    assert_eq!(
        told(run(at, &erase).success()),
        json!({"port": PORT, "order": "erase", "episode": 3, "done": true, "why": null})
    );
    let told = told(run(at, &format!("clear {PORT} --json -")).success());
    assert_eq!(told["order"], "clear");
    assert_eq!(told["episode"], Value::Null);
}

#[test]
fn orders_are_told_to_who_watches() {
    let folder = tempfile::tempdir().expect("a folder");
    let at = folder.path();
    let controller = at_work(at, machine());
    let refused = Refusal::from(Busy::Service).code();
    controller.machine().notices.push(Notice::Ordered(Ordered {
        act: Act::Clear,
        refused,
        sample: 7,
    }));
    let live = run(at, &format!("live {PORT} --json --seconds 2")).success();
    let text = String::from_utf8(live.get_output().stdout.clone()).expect("text");
    let lines = text.lines().map(|it| serde_json::from_str::<Value>(it).expect("JSON"));
    let orders: Vec<_> = lines.filter(|it| it["said"] == "order").collect();
    assert!(!orders.is_empty(), "{text}");
    assert_eq!(orders[0]["order"], "clear");
    assert_eq!(orders[0]["done"], false);
    assert!(orders[0]["why"].as_str().is_some_and(|it| it.contains("service input")));
}

#[test]
fn nobody_there_is_no_answer() {
    let folder = tempfile::tempdir().expect("a folder");
    for order in ["clear unix:nobody", "log lock unix:nobody 1", "log erase unix:nobody 1"] {
        run(folder.path(), order)
            .code(2)
            .stdout("")
            .stderr(contains("unix:nobody: no such file").and(contains("refuses").not()));
    }
    run(folder.path(), "log erase unix:nobody").code(2);
}
