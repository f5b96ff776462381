//! No command replaces what it reads, or one of its outputs by another; text that cannot be written is a failure.
//! Over all commands and all their options that name files.
#![cfg(unix)]

use std::collections::BTreeMap;
use std::fs::{self, File, OpenOptions};
use std::os::unix::fs::symlink;
use std::path::Path;
use std::process::{Command, Stdio};
use std::sync::{Arc, Mutex};

use touchdown_tests::binary::{program, touchdown};
use touchdown_tests::controller::{Controller, Machine};
use touchdown_tests::file_options::Output::{self, Folder};
use touchdown_tests::file_options::{ROWS, Row, contents, folder, listed, there};

/// Other names of `file`, and a folder for a name that is given.
const LINK: &str = "link";
const HARD: &str = "hard";
const TO: &str = "to";

#[test]
fn every_option_of_every_command_is_listed() {
    assert_eq!(listed(), there());
}

fn text(bytes: &[u8]) -> String {
    String::from_utf8_lossy(bytes).into_owned()
}

/// It is status 2, all that `names` has is told, and nothing in the folder is another than before.
fn assert_refused(at: &Path, command: &mut Command, names: &[&str]) {
    let before = contents(at);
    let ended = command.output().expect("it runs");
    let told = text(&ended.stderr);
    assert_eq!(ended.status.code(), Some(2), "{command:?}: {told}");
    for name in names {
        assert!(told.contains(name), "{command:?}: no {name} in {told}");
    }
    assert_same(&before, &contents(at), command);
}

fn assert_same(
    before: &BTreeMap<String, Vec<u8>>,
    after: &BTreeMap<String, Vec<u8>>,
    command: &Command,
) {
    let names = |it: &BTreeMap<String, Vec<u8>>| it.keys().cloned().collect::<Vec<_>>();
    assert_eq!(names(before), names(after), "{command:?}");
    for (name, bytes) in before {
        assert!(bytes == &after[name], "{command:?} has changed {name}");
    }
}

/// Calls `run` for each way in which `output` can be `file`, with the words that make it so.
fn each_way(at: &Path, output: Output, file: &str, mut run: impl FnMut(&[&str])) {
    let made = |link: &Path, hard: bool| {
        if hard {
            fs::hard_link(at.join(file), link).expect("a link");
        } else {
            symlink(at.join(file), link).expect("a link");
        }
    };
    match output {
        Output::File(option) => {
            made(&at.join(LINK), false);
            made(&at.join(HARD), true);
            symlink(".", at.join("here")).expect("a link");
            let absolute = at.join(file).display().to_string();
            for name in [
                file,
                &format!("./{file}"),
                &format!("here/{file}"),
                &absolute,
                LINK,
                HARD,
            ] {
                run(&[option, name]);
            }
            for name in [LINK, HARD, "here"] {
                fs::remove_file(at.join(name)).expect("it was made");
            }
        }
        Folder(option, names) => {
            for name in names {
                for hard in [false, true] {
                    fs::create_dir(at.join(TO)).expect("a folder");
                    made(&at.join(TO).join(name), hard);
                    run(&[option, TO]);
                    fs::remove_dir_all(at.join(TO)).expect("it was made");
                }
            }
        }
    }
}

#[test]
fn no_output_replaces_an_input() {
    let folder = folder();
    let at = folder.path();
    let mut count = 0;
    for row in ROWS {
        for file in row.read() {
            for output in row.outputs {
                each_way(at, *output, file, |words| {
                    let names = ["are the same file", words[0], file];
                    assert_refused(at, &mut row.run(at, words), &names);
                    count += 1;
                });
            }
            if row.outputs.is_empty() {
                continue;
            }
            // As `touchdown ... >> FILE`.
            let mut command = row.run(at, &required(row));
            let append = OpenOptions::new().append(true).open(at.join(file));
            command.stdout(append.expect("the input"));
            assert_refused(at, &mut command, &["standard output and", file]);
        }
    }
    assert!(count > 300, "only {count}");
}

/// Outputs that a command does not run without.
fn required(row: &Row) -> Vec<&'static str> {
    match (row.command, row.inputs) {
        ("log export", _) => vec!["--out", "e.csv"],
        ("force", []) => vec!["--example", TO],
        _ => vec![],
    }
}

#[test]
fn no_output_replaces_another() {
    let folder = folder();
    let at = folder.path();
    fs::write(at.join("o"), "what was there").expect("a file");
    symlink("new", at.join("dangling")).expect("a link");
    let mut count = 0;
    for row in ROWS {
        let files = row.files();
        for (index, first) in files.iter().enumerate() {
            for second in &files[index + 1..] {
                each_way(at, Output::File(second), "o", |words| {
                    let words = [&[*first, "o"], words].concat();
                    let names = ["are the same file", first, second];
                    assert_refused(at, &mut row.run(at, &words), &names);
                    count += 1;
                });
                for [one, other] in [["new", "./new"], ["new", "dangling"]] {
                    let words = [*first, one, *second, other];
                    let names = ["are the same file", first, second];
                    assert_refused(at, &mut row.run(at, &words), &names);
                }
                let words = [*first, "-", *second, "-"];
                let names = ["two outputs go to standard output", first, second];
                assert_refused(at, &mut row.run(at, &words), &names);
            }
            // As `touchdown ... --json o > o`.
            let mut command = row.run(at, &[first, "o"]);
            let append = OpenOptions::new().append(true).open(at.join("o"));
            command.stdout(append.expect("the output"));
            assert_refused(at, &mut command, &["standard output", first]);
        }
        for output in row.outputs {
            let Folder(option, names) = *output else {
                continue;
            };
            for name in names {
                for file in &files {
                    let path = format!("{TO}/{name}");
                    let words = [option, TO, *file, &path];
                    let told = ["are the same file", option, file];
                    assert_refused(at, &mut row.run(at, &words), &told);
                }
            }
            for pair in names.windows(2) {
                fs::create_dir(at.join(TO)).expect("a folder");
                let [one, other] = [pair[0], pair[1]].map(|it| at.join(TO).join(it));
                fs::write(&one, "what was there").expect("a file");
                fs::hard_link(&one, &other).expect("a link");
                assert_refused(at, &mut row.run(at, &[option, TO]), &["same file"]);
                fs::remove_dir_all(at.join(TO)).expect("it was made");
                count += 1;
            }
        }
    }
    assert!(count > 80, "only {count}");
}

#[test]
fn files_that_no_option_names_are_outputs_too() {
    let folder = folder();
    let at = folder.path();
    symlink("n.cfg", at.join("n.dat")).expect("a link");
    fs::hard_link(at.join("flash.bin"), at.join("f.dat")).expect("a link");
    for words in [
        "log export flash.bin --format comtrade --out n.cfg",
        "log export flash.bin --format comtrade --out f.cfg",
        "sweep merge run --json run/points.csv",
        "sweep plan.toml --json plan-sweep/sweep.json",
        "sweep plan.toml --out run --json run/part-1-of-1.csv",
    ] {
        let mut command = Command::new(program());
        command.args(words.split(' ')).current_dir(at);
        assert_refused(at, &mut command, &["are the same file"]);
    }
    // The names that are taken where none is given.
    for (words, file) in [
        ("", "touchdown-report.html"),
        ("trade", "touchdown-trade.html"),
        ("trade", "touchdown-trade.svg"),
        ("paper", "touchdown-paper.html"),
    ] {
        let out = File::create(at.join(file)).expect("a file");
        let mut command = Command::new(program());
        command.args(words.split_whitespace()).current_dir(at);
        assert_refused(at, command.stdout(out), &["are the same file", file]);
        fs::rename(at.join(file), at.join("scene.html")).expect("a file");
        fs::copy(at.join("my.toml"), at.join(file)).expect("a scene");
        if words == "trade" {
            let mut command = Command::new(program());
            command.args(["trade", file]).current_dir(at);
            assert_refused(at, &mut command, &["are the same file", file]);
        }
    }
}

#[test]
fn devices_are_written_to_again_and_again() {
    let folder = folder();
    let words = ["--json", "/dev/null", "--report", "/dev/null"];
    for words in [
        &words[..],
        &[&words[..], &["--stream", "/dev/null"]].concat(),
    ] {
        let ended = ROWS[0].run(folder.path(), words).output().expect("it runs");
        assert_eq!(ended.status.code(), Some(0), "{ended:?}");
    }
    assert!(!fs::metadata("/dev/null").expect("is there").is_file());
}

/// The program without a word.
const ANY: Row = Row {
    words: "",
    ..ROWS[0]
};

/// Commands that run to their end here, with their words.
fn runs() -> Vec<String> {
    let words = ROWS.iter().filter(|it| !it.words.contains("--image"));
    let with = |row: &Row| format!("{} {}", row.words, required(row).join(" "));
    let mut runs: Vec<_> = words.map(with).collect();
    // The file of --set stands for any here.
    runs.retain(|it| !it.starts_with("config"));
    runs.extend(there().into_keys().map(|it| format!("{it} --help")));
    let more = ["config unix:rig.sock", "rig my.toml --image image", ""];
    let more = more.iter().chain(&["--help", "--version", "help drop"]);
    runs.extend(more.map(|it| (*it).to_owned()));
    runs
}

#[cfg(target_os = "linux")]
#[test]
fn text_on_a_full_disk_is_2() {
    let folder = folder();
    let at = folder.path();
    let machine = Arc::new(Mutex::new(Machine::default()));
    let _controller = Controller::at_path(&at.join("rig.sock"), machine);
    let full = || {
        OpenOptions::new()
            .write(true)
            .open("/dev/full")
            .expect("it")
    };
    for words in runs() {
        let mut command = ANY.run(at, &words.split_whitespace().collect::<Vec<_>>());
        let ended = command.stdout(full()).stdin(Stdio::null()).output();
        let ended = ended.expect("it runs");
        let told = text(&ended.stderr);
        assert_eq!(ended.status.code(), Some(2), "{command:?}: {told}");
        let why = "standard output: cannot be written";
        assert!(told.contains(why), "{command:?}: {told}");
    }
}

#[test]
fn a_record_is_not_added_to_another_file() {
    let folder = folder();
    let at = folder.path();
    fs::write(at.join("other.jsonl"), "{\"said\":\"x\",\"at\":1}\n").expect("a file");
    fs::write(at.join("words.txt"), "at_s said").expect("a file");
    for file in ["my.toml", "flash.bin", "s.csv", "other.jsonl", "words.txt"] {
        let mut command = Command::new(program());
        command.args(["live", "unix:none", "--seconds", "0.1", "--record", file]);
        command.current_dir(at);
        assert_refused(at, &mut command, &[file, "no record of touchdown live"]);
    }
    // What a record can begin in.
    fs::write(at.join("empty"), "").expect("a file");
    for _ in 0..2 {
        let words = ["live", "unix:none", "--seconds", "0.1", "--record", "empty"];
        touchdown(at).args(words).assert().code(2);
    }
    let lines = fs::read_to_string(at.join("empty")).expect("a record");
    assert_eq!(lines.matches("\"said\":\"lost\"").count(), 2, "{lines}");
}
