//! `touchdown live` and the log over the link, against a controller on a socket: what it says comes out,
//! noise and other versions are named, an unplugged line is opened again.
#![cfg(unix)]

use std::fs;
use std::io::{self, BufRead, BufReader, Read};
use std::path::Path;
use std::process::{Child, Command, Stdio};
use std::sync::{Arc, Mutex};
use std::time::{Duration, Instant};

use proptest::prelude::*;
use serde_json::Value;
use touchdown_core::checksum::CRC;
use touchdown_core::event::EventKind;
use touchdown_protocol::link::{Request, Server, VERSION};
use touchdown_protocol::log::counters::Counters;
use touchdown_files::link::{Client, Line, LinkError, Told};
use touchdown_tests::binary::{program, touchdown};
use touchdown_tests::controller::{Controller, Machine, SAMPLE_RATE, event, settings};
use touchdown_tests::episode::{COUNTERS, dump, episode};

/// Far longer than anything here takes.
const LIMIT: Duration = Duration::from_secs(60);

fn machine() -> Arc<Mutex<Machine>> {
    let mut machine = Machine::default();
    machine.lifetime = Some(COUNTERS);
    for number in [2, 4] {
        let bytes = episode(number).as_flattened().to_vec();
        machine.episodes.insert(number, bytes);
    }
    Arc::new(Mutex::new(machine))
}

/// `touchdown live`, its lines one by one.
struct Live {
    child: Child,
    heard: Vec<Value>,
    lines: io::Lines<BufReader<std::process::ChildStdout>>,
}

impl Live {
    fn start(folder: &Path, arguments: &[&str]) -> Self {
        let mut child = Command::new(program())
            .arg("live")
            .args(arguments)
            .current_dir(folder)
            .stdin(Stdio::null())
            .stdout(Stdio::piped())
            .spawn()
            .expect("the program starts");
        let out = child.stdout.take().expect("its output");
        Self {
            child,
            heard: Vec::new(),
            lines: BufReader::new(out).lines(),
        }
    }

    /// The next line that says `said`.
    fn next(&mut self, said: &str) -> Value {
        let start = Instant::now();
        while start.elapsed() < LIMIT {
            let line = self.lines.next().expect("a line").expect("text");
            let line: Value = serde_json::from_str(&line).expect("JSON");
            self.heard.push(line.clone());
            if line["said"] == said {
                return line;
            }
        }
        panic!("nothing said {said}");
    }

    /// All lines so far that say `said`.
    fn so_far(&self, said: &str) -> Vec<Value> {
        let lines = self.heard.iter().filter(|it| it["said"] == said);
        lines.cloned().collect()
    }
}

impl Drop for Live {
    fn drop(&mut self) {
        let _ = self.child.kill();
        let _ = self.child.wait();
    }
}

#[test]
fn what_the_controller_says_comes_out_as_lines() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("rig.sock");
    let controller = Controller::at_path(&path, machine());
    let mut live = Live::start(folder.path(), &["unix:rig.sock"]);
    let connected = live.next("connected");
    assert_eq!(connected["firmware"], "0.1.0");
    assert_eq!(connected["sample_rate_hz"], f64::from(SAMPLE_RATE));
    let state = live.next("state");
    assert_eq!(state["phase"], "levitated");
    assert_eq!(state["mode"], "watching");
    assert_eq!(
        (&state["run"], &state["permit"]),
        (&true.into(), &false.into())
    );
    let second = live.next("state");
    let samples = [&state, &second].map(|it| it["sample"].as_u64().expect("a number"));
    assert_eq!(samples[1] - samples[0], 1_000);

    controller
        .machine()
        .notices
        .push(event(7, EventKind::Impact, 40_000));
    let told = live.next("event");
    assert_eq!(
        (&told["event"], &told["number"]),
        (&"impact".into(), &7.into())
    );
    assert_eq!(told["declared_s"], 2.0);
    assert!((told["onset_s"].as_f64().expect("a time") - (2.0 - 0.75e-3)).abs() < 1e-9);

    let positions = live.next("positions");
    let of = |plane: &str| positions[plane].as_array().expect("a list").clone();
    assert_eq!((of("a_m").len(), of("b_m").len()), (32, 32));
    for place in of("a_m") {
        let [x, y] = [0, 1].map(|axis| place[axis].as_f64().expect("a number"));
        // A circle of 400 counts of 0.5 um, rounded to a count.
        assert!((x.hypot(y) - 200e-6).abs() < 0.5e-6, "{place}");
    }
    // Where one axis has no value, there is no position.
    let missing = of("b_m").iter().filter(|it| it.is_null()).count();
    assert_eq!(missing, 8);
    while live.so_far("episode").len() < 2 {
        live.next("positions");
    }
    let episodes = live.so_far("episode");
    assert_eq!(episodes[0]["trigger"], "free fall");
    let numbers: Vec<_> = episodes.iter().map(|it| it["number"].clone()).collect();
    assert_eq!(numbers, [2, 4]);

    let told = live.so_far("lifetime").pop();
    let lifetime = told.unwrap_or_else(|| live.next("lifetime"));
    assert_eq!(lifetime["landings"], 5);
    assert_eq!(lifetime["weight"], 4.321);
    controller.machine().lifetime = Some(Counters {
        landings: 6,
        ..COUNTERS
    });
    assert_eq!(live.next("lifetime")["landings"], 6);
}

#[test]
fn an_unplugged_line_is_opened_again_and_both_are_told() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("rig.sock");
    let machine = machine();
    // Nothing is there at first.
    let mut live = Live::start(folder.path(), &["unix:rig.sock", "--json"]);
    let lost = live.next("lost");
    assert_eq!(lost["why"], "no such file");
    for _ in 0..3 {
        let controller = Controller::at_path(&path, machine.clone());
        let connected = live.next("connected");
        let state = live.next("state");
        assert!(state["at_s"].as_f64() >= connected["at_s"].as_f64());
        drop(controller);
        live.next("lost");
    }
}

#[test]
fn a_record_is_added_to_and_holds_what_was_told() {
    let folder = tempfile::tempdir().expect("a folder");
    let at = folder.path();
    let _controller = Controller::at_path(&at.join("rig.sock"), machine());
    let arguments = [
        "live",
        "unix:rig.sock",
        "--seconds",
        "3",
        "--record",
        "r.jsonl",
    ];
    let mut lines = vec![];
    for _ in 0..2 {
        let run = touchdown(at).args(arguments).assert().success();
        lines.extend_from_slice(&run.get_output().stdout);
    }
    // Into a pipe there is no view: the same lines go there.
    assert_eq!(fs::read(at.join("r.jsonl")).expect("a record"), lines);
    let text = String::from_utf8(lines).expect("text");
    let said = |what: &str| text.matches(&format!("\"said\":\"{what}\"")).count();
    assert_eq!(said("connected"), 2, "{text}");
    assert!(said("state") >= 2, "{text}");
    for line in text.lines() {
        serde_json::from_str::<Value>(line).expect("JSON");
    }
}

#[test]
fn a_controller_that_never_answers_is_a_failure() {
    let folder = tempfile::tempdir().expect("a folder");
    for port in [
        "unix:nowhere",
        "/dev/touchdown-that-is-not-there",
        "tcp:127.0.0.1:1",
    ] {
        touchdown(folder.path())
            .args(["live", port, "--seconds", "0.2"])
            .assert()
            .code(2)
            .stderr(predicates::str::contains(port));
    }
}

#[test]
fn a_signal_gives_the_terminal_back() {
    // A terminal of its own; the signal comes once the view has it.
    const SCRIPT: &str = r#"
        stty -g > before
        "$TOUCHDOWN" live unix:rig.sock < /dev/tty &
        until stty -a | grep -q -e -icanon; do sleep 0.02; done
        kill -$SIGNAL $!
        wait $!
        echo $? > status
        stty -g > after
    "#;
    for signal in ["TERM", "HUP"] {
        let folder = tempfile::tempdir().expect("a folder");
        let at = folder.path();
        let _controller = Controller::at_path(&at.join("rig.sock"), machine());
        fs::write(at.join("view.sh"), SCRIPT).expect("a script");
        let shown = Command::new("script")
            .args(["-qec", "sh view.sh", "/dev/null"])
            .current_dir(at)
            .env("TOUCHDOWN", program())
            .env("SIGNAL", signal)
            .stdin(Stdio::null())
            .output()
            .expect("script runs");
        let text = |name: &str| fs::read_to_string(at.join(name)).unwrap_or_default();
        assert_eq!(text("status"), "0\n", "{signal}: {shown:?}");
        assert_eq!(text("after"), text("before"), "{signal}");
        assert!(!text("before").is_empty());
    }
}

#[test]
fn a_reader_that_goes_away_is_no_failure() {
    let folder = tempfile::tempdir().expect("a folder");
    let _controller = Controller::at_path(&folder.path().join("rig.sock"), machine());
    let mut child = Command::new(program())
        .args(["live", "unix:rig.sock"])
        .current_dir(folder.path())
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .expect("the program starts");
    let mut first = [0; 1];
    let mut out = child.stdout.take().expect("its output");
    out.read_exact(&mut first).expect("a line");
    drop(out);
    let ended = child.wait_with_output().expect("its end");
    assert!(ended.status.success(), "{ended:?}");
    assert!(ended.stderr.is_empty(), "{ended:?}");
}

#[test]
fn the_log_over_the_link_is_that_of_a_file() {
    let folder = tempfile::tempdir().expect("a folder");
    let at = folder.path();
    let machine = machine();
    let (_controller, port) = Controller::at_tcp(machine.clone());
    let both = [episode(2), episode(4)];
    fs::write(at.join("flash.bin"), dump(&both)).expect("a dump");
    let run = |arguments: &[&str]| {
        let run = touchdown(at).arg("log").args(arguments).assert().success();
        run.get_output().stdout.clone()
    };
    for number in [&[][..], &["2"]] {
        for format in ["csv", "json"] {
            let exported = |from: &str| {
                let mut arguments = vec!["export", from];
                arguments.extend(number);
                arguments.extend(["--format", format, "--out", "-"]);
                String::from_utf8(run(&arguments)).expect("text")
            };
            let (over_link, of_file) = (exported(&port), exported("flash.bin"));
            assert!(over_link.len() > 500);
            // All but the slot, which the link does not tell, and what lies behind the episode there.
            let same = |text: &str| -> Vec<String> {
                let told = |it: &&str| !it.contains("\"slot\"") && !it.contains("\"blank\"");
                text.lines().filter(told).map(str::to_owned).collect()
            };
            assert_eq!(same(&over_link), same(&of_file));
        }
    }
    let all: Value = serde_json::from_slice(&run(&["list", &port, "--json", "-"])).expect("JSON");
    let numbers = [0, 1].map(|it| all["episodes"][it]["sequence"].clone());
    assert_eq!(numbers, [2, 4]);
    let of_file = run(&["list", "flash.bin", "--json", "-"]);
    let of_file: Value = serde_json::from_slice(&of_file).expect("JSON");
    assert_eq!(all["counters"]["landings"], 5);
    assert_eq!(all["counters"], of_file["counters"]);
    run(&["verify", &port]);
    touchdown(at)
        .args(["log", "show", &port, "3"])
        .assert()
        .code(2);

    let mut machine_now = machine.lock().expect("a machine");
    machine_now.episodes.get_mut(&4).expect("an episode")[1_000] ^= 1;
    drop(machine_now);
    touchdown(at)
        .args(["log", "verify", &port])
        .assert()
        .code(1);
}

/// The server itself at the other end, over a line that damages what passes.
struct Noisy {
    server: Server,
    machine: Machine,
    out: Vec<u8>,
    /// One of so many bytes is damaged; 0 for none.
    every: usize,
    passed: usize,
}

impl Noisy {
    fn new(every: usize) -> Self {
        Self {
            server: Server::new("0.1.0", SAMPLE_RATE, None),
            machine: Machine::default(),
            out: Vec::new(),
            every,
            passed: 0,
        }
    }

    fn pass(&mut self, byte: u8) -> u8 {
        self.passed += 1;
        let is_hit = self.every > 0 && self.passed.is_multiple_of(self.every);
        byte ^ if is_hit { 0x10 } else { 0 }
    }
}

impl Line for Noisy {
    fn read(&mut self, bytes: &mut [u8], limit: Duration) -> io::Result<usize> {
        if self.out.is_empty() {
            std::thread::sleep(limit.min(Duration::from_millis(1)));
        }
        let length = self.out.len().min(bytes.len());
        for (index, byte) in self
            .out
            .drain(..length)
            .collect::<Vec<_>>()
            .into_iter()
            .enumerate()
        {
            bytes[index] = self.pass(byte);
        }
        Ok(length)
    }

    fn write(&mut self, bytes: &[u8]) -> io::Result<()> {
        for byte in bytes {
            let byte = self.pass(*byte);
            let answer = self.server.take(byte, &mut self.machine);
            self.out.extend(answer.into_iter().flatten());
        }
        Ok(())
    }
}

#[test]
fn damaged_requests_and_answers_are_asked_again() {
    let mut line = Noisy::new(601);
    let bytes = episode(2).as_flattened().to_vec();
    line.machine.episodes.insert(2, bytes.clone());
    let mut client = Client::new(Box::new(line));
    assert_eq!(client.settings().expect("settings"), settings());
    let fetched = client.episode(2, |_, _| ()).expect("an answer");
    assert_eq!(fetched, Some(bytes));
    assert!(client.damaged > 0);
}

/// Says what it was given, whatever is asked.
struct Parrot(Vec<u8>);

impl Line for Parrot {
    fn read(&mut self, bytes: &mut [u8], _: Duration) -> io::Result<usize> {
        let length = self.0.len().min(bytes.len());
        bytes[..length].copy_from_slice(&self.0[..length]);
        self.0.drain(..length);
        Ok(length)
    }

    fn write(&mut self, _: &[u8]) -> io::Result<()> {
        Ok(())
    }
}

#[test]
fn another_version_is_named() {
    let plain = [VERSION + 1, 1];
    let body = [&plain[..], &CRC.checksum(&plain).to_le_bytes()].concat();
    // Without a zero in it, one length is all of the stuffing.
    assert!(!body.contains(&0));
    let mut frame = vec![body.len() as u8 + 1];
    frame.extend(&body);
    frame.push(0);
    let error = Client::new(Box::new(Parrot(frame))).hello().unwrap_err();
    assert!(
        matches!(error, LinkError::Version(it) if it == VERSION + 1),
        "{error}"
    );
}

#[test]
fn silence_is_an_error_and_what_came_meanwhile_is_kept() {
    let mut server = Server::new("0.1.0", SAMPLE_RATE, None);
    let mut machine = Machine::default();
    let mut bytes = server.state(&mut machine).expect("a frame").to_vec();
    bytes.extend(server.state(&mut machine).expect("a frame"));
    let mut client = Client::new(Box::new(Parrot(bytes)));
    let error = client.ask(&Request::Hello).unwrap_err();
    assert!(matches!(error, LinkError::Silent), "{error}");
    let told = Some(Told::State(machine.state));
    assert_eq!(client.listen(Duration::ZERO).expect("a line"), told);
    assert_eq!(client.listen(Duration::ZERO).expect("a line"), told);
    assert_eq!(client.listen(Duration::ZERO).expect("a line"), None);
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(200))]

    #[test]
    fn any_bytes_are_heard(bytes in prop::collection::vec(any::<u8>(), 0..2_000)) {
        let mut client = Client::new(Box::new(Parrot(bytes)));
        for _ in 0..10 {
            if client.listen(Duration::from_micros(100)).is_err() {
                break;
            }
        }
    }
}
