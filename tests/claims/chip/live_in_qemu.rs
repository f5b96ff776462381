//! `touchdown live` on the serial socket of the emulated firmware: it connects, sees the rotor float and fall, and
//! the log over the link has that drop.
#![cfg(unix)]

use std::fs::{self, File};
use std::io::{self, BufRead, BufReader, Write};
use std::path::Path;
use std::process::{Child, Command, Stdio};
use std::time::{Duration, Instant};

use serde_json::Value;
use touchdown_core::sample::{Sample, TACHOMETERS};
use touchdown_protocol::wire::{ReplayHead, encode_sample};
use touchdown_run::emulator::{built, replay_head};
use touchdown_tests::binary::{program, touchdown};
use touchdown_tests::controller::settings;

const LIMIT: Duration = Duration::from_secs(120);
/// Samples that the image takes at a time.
const BLOCK: u64 = 256;

/// SplitMix64.
fn noise(seed: u64) -> u64 {
    let mut z = seed.wrapping_mul(0x9e37_79b9_7f4a_7c15);
    z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    z ^ (z >> 31)
}

/// Levitated in the centre; from `falls` on 9.81 m/s^2 downwards, until the wall stops it.
fn sample(number: u64, falls: u64) -> Sample {
    let fallen = number.saturating_sub(falls) as f64 / 20_000.0;
    let fall = (0.5 * 9.81 * fallen * fallen).min(0.3e-3) / 0.5e-6;
    let bits = noise(number);
    // The sum of two even ones: 0 to 6 counts, 3 on average.
    let count = |channel: u32| {
        let bits = (bits >> (8 * channel)) as u16;
        2_045 + (bits & 3) + (bits >> 2 & 3)
    };
    Sample {
        counts: [
            count(0),
            count(1) - fall as u16,
            count(2),
            count(3) - fall as u16,
        ],
        valid: 0x0f,
        spin: None,
        levitated: None,
        edges: [None; TACHOMETERS],
    }
}

/// A process that is ended with the test.
struct Process(Child);

impl Drop for Process {
    fn drop(&mut self) {
        let _ = self.0.kill();
        let _ = self.0.wait();
    }
}

/// The image with its samples from a pipe, so that it goes on as long as the test wants, and with a place for
/// settings, so that it expects somebody on its line.
fn qemu(folder: &Path) -> (Process, File) {
    let image = built("touchdown-qemu");
    assert!(image.is_file(), "{}: cargo xtask firmware", image.display());
    let pipe = folder.join("replay");
    let made = Command::new("mkfifo").arg(&pipe).status().expect("mkfifo");
    assert!(made.success());
    let child = Command::new("qemu-system-arm")
        .args(["-M", "netduinoplus2", "-nographic", "-monitor", "none"])
        .args(["-icount", "shift=3,sleep=off"])
        .args([
            "-chardev",
            "socket,id=link,path=rig.sock,server=on,wait=off",
        ])
        .args(["-serial", "chardev:link", "-semihosting-config"])
        .arg("enable=on,target=native,arg=replay,arg=answer,arg=log,arg=settings")
        .arg("-kernel")
        .arg(image)
        .current_dir(folder)
        .stdin(Stdio::null())
        .stdout(Stdio::null())
        .spawn()
        .expect("QEMU");
    let process = Process(child);
    let mut samples = File::options().write(true).open(pipe).expect("a pipe");
    // A lift was seen before the first sample.
    let head = replay_head(&ReplayHead::new(settings().monitor, false)).expect("a head");
    samples.write_all(&head).expect("a reader");
    (process, samples)
}

struct Feed {
    samples: File,
    fed: u64,
    falls: u64,
}

impl Feed {
    fn feed(&mut self, blocks: u64) {
        let block = self.fed..self.fed + blocks * BLOCK;
        let bytes: Vec<u8> = block
            .clone()
            .flat_map(|it| encode_sample(&sample(it, self.falls).into(), None))
            .collect();
        self.samples.write_all(&bytes).expect("a reader");
        self.fed = block.end;
    }
}

#[test]
fn a_drop_on_the_emulated_target_is_seen_live_and_fetched() {
    let folder = tempfile::tempdir().expect("a folder");
    let at = folder.path();
    let (_qemu, samples) = qemu(at);
    let mut live = Process(
        Command::new(program())
            .args(["live", "unix:rig.sock"])
            .current_dir(at)
            .stdin(Stdio::null())
            .stdout(Stdio::piped())
            .spawn()
            .expect("the program starts"),
    );
    let lines = live.0.stdout.take().expect("its output");
    let (to, told) = std::sync::mpsc::channel();
    let reader = std::thread::spawn(move || {
        for line in BufReader::new(lines).lines().map_while(io::Result::ok) {
            let line: Value = serde_json::from_str(&line).expect("JSON");
            if to.send(line).is_err() {
                return;
            }
        }
    });
    let mut feed = Feed {
        samples,
        fed: 0,
        falls: u64::MAX,
    };
    // Feeds until something is told: the image serves its link between blocks.
    let until = |feed: &mut Feed, wanted: &dyn Fn(&Value) -> bool| {
        let start = Instant::now();
        while start.elapsed() < LIMIT {
            feed.feed(1);
            if let Some(line) = told.try_iter().find(|it| wanted(it)) {
                return line;
            }
            std::thread::sleep(Duration::from_millis(1));
        }
        panic!("not told after {} samples", feed.fed);
    };
    let connected = until(&mut feed, &|it| it["said"] == "connected");
    assert_eq!(connected["sample_rate_hz"], 20_000.0);
    // The first ones may come before so many samples were taken.
    let positions = until(&mut feed, &|it| {
        it["said"] == "positions" && it["a_m"][31][1].is_number()
    });
    let last = &positions["a_m"][31];
    // The noise is within 3 counts of 0.5 um, in f32.
    assert!(last[1].as_f64().expect("a number").abs() < 1.501e-6);
    until(&mut feed, &|it| {
        it["said"] == "state" && it["mode"] == "watching" && it["ready"] == true
    });

    feed.falls = feed.fed;
    let fall = until(&mut feed, &|it| {
        it["said"] == "event" && it["event"] == "free_fall"
    });
    let late = fall["onset_s"].as_f64().expect("a time") - feed.falls as f64 / 20e3;
    assert!(late.abs() < 1e-3, "{fall}");
    let dropped = until(&mut feed, &|it| {
        it["said"] == "state" && it["mode"] == "dropped"
    });
    assert_eq!(
        (&dropped["run"], &dropped["ready"]),
        (&false.into(), &false.into())
    );
    let episode = until(&mut feed, &|it| it["said"] == "episode");
    assert_eq!(episode["trigger"], "free fall");
    drop(live);
    reader.join().expect("the reader");

    // The same plug for the next in turn. The image goes on only with samples.
    let out = at.join("e.json");
    let mut export = Command::new(program())
        .args([
            "log",
            "export",
            "unix:rig.sock",
            "--format",
            "json",
            "--out",
            "e.json",
        ])
        .current_dir(at)
        .spawn()
        .expect("the program starts");
    let start = Instant::now();
    let status = loop {
        if let Some(status) = export.try_wait().expect("a process") {
            break status;
        }
        assert!(start.elapsed() < LIMIT);
        feed.feed(1);
    };
    assert!(status.success());
    let exported: Value = serde_json::from_slice(&fs::read(out).expect("a file")).expect("JSON");
    assert_eq!(exported["header"]["trigger_kind"], "free_fall");
    assert_eq!(exported["verdict"], "whole");
    // What came over the link is what lies in the flash.
    drop(feed);
    // On a busy machine the rotor may have been recorded again by now.
    let sequence = exported["sequence"].to_string();
    let run = touchdown(at)
        .args(["log", "export", "log", &sequence])
        .args(["--format", "json", "--out", "-"])
        .assert()
        .success();
    let of_flash: Value = serde_json::from_slice(&run.get_output().stdout).expect("JSON");
    for part in ["sequence", "header", "ending", "events", "severity"] {
        assert_eq!(exported[part], of_flash[part], "{part}");
    }
}
