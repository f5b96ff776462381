//! The command line as docs/use/commands.md has it: `--json -` is JSON and nothing else, exit statuses, no colour and no
//! progress into a pipe, a pipe that closes, help whose examples run.

use std::collections::BTreeSet;
use std::fs;
use std::path::Path;
use std::process::{Command, Stdio};

use clap::CommandFactory;
use serde_json::Value;
use tempfile::TempDir;
use touchdown_files::configuration::text;
use touchdown_scene::BUILT_IN;
use touchdown_sim::commands::Cli;
use touchdown_tests::binary::{program, touchdown};
use touchdown_tests::controller::settings;
use touchdown_tests::episode::{dump, episode};
use touchdown_tests::file_options::short_scene;
use touchdown_tests::led_rounds::example;

const PLAN: &str = r#"
scene = "rig"
drops = 20
[start]
within = 0.5
[[parameter]]
key = "retainer.friction"
values = [0.05, 0.1]
[[parameter]]
key = "run.duration_s"
values = [0.1]
"#;

/// The columns of a stream.
const MAP: &str =
    "[time]\ncolumn = \"time_s\"\n[ax]\ncolumn = \"ax_um\"\n[ay]\ncolumn = \"ay_um\"\n";

/// A folder with all that the examples name.
fn folder() -> TempDir {
    let folder = tempfile::tempdir().expect("a folder");
    let at = folder.path();
    let scene = BUILT_IN[0].text;
    fs::write(at.join("my.toml"), scene).expect("a scene");
    fs::write(at.join("short.toml"), short_scene()).expect("a scene");
    fs::write(at.join("led.csv"), example()).expect("a recording");
    fs::write(at.join("old.toml"), text(&settings())).expect("a configuration");
    fs::write(at.join("plan.toml"), PLAN).expect("a plan");
    fs::write(at.join("flash.bin"), dump(&[episode(1), episode(2)])).expect("a dump");
    for run in [
        "drop my.toml --stream s.csv",
        "force --example try",
        "sweep plan.toml --out run --shard 1/2",
        "sweep plan.toml --out run --shard 2/2",
        "sweep plan.toml --out a --shard 1/2",
        "sweep plan.toml --out b --shard 2/2",
    ] {
        touchdown(at).args(run.split(' ')).assert().success();
    }
    fs::copy(at.join("try/recording.csv"), at.join("r.csv")).expect("a recording");
    fs::copy(at.join("try/calibration.csv"), at.join("c.csv")).expect("a calibration");
    for name in [
        "before.csv",
        "after.csv",
        "a.csv",
        "b.csv",
        "model.csv",
        "rig.csv",
        "rec.csv",
    ] {
        fs::copy(at.join("s.csv"), at.join(name)).expect("a recording");
    }
    fs::write(at.join("map.toml"), MAP).expect("a mapping");
    fs::write(at.join("stream.toml"), MAP).expect("a mapping");
    fs::create_dir(at.join("other")).expect("a folder");
    folder
}

/// Every command that gives numbers, and a run of it that lasts seconds at most. `limits` stands for those whose
/// check can fail.
const JSON: [&str; 16] = [
    "drop my.toml",
    "replay s.csv --scene my.toml",
    "compare a.csv b.csv --scene my.toml",
    "trade short.toml --drops 0",
    "limits --drops 1",
    "paper --drops 2",
    "score --quick --only quiet",
    "sweep plan.toml",
    "sweep merge run",
    "log list flash.bin",
    "log show flash.bin",
    "log verify flash.bin",
    "force r.csv --calibration c.csv",
    "calibrate led.csv --scene my.toml",
    "scene list",
    "scene explain my.toml",
];

/// Those that give no numbers, or lines of them, or need a controller.
const OTHERS: [&str; 9] = [
    "rig",
    "live",
    "config",
    "clear",
    "log export",
    "log lock",
    "log unlock",
    "log erase",
    "completions",
];

/// Names of all commands that do something, as `log list`.
fn commands() -> Vec<String> {
    fn walk(command: &clap::Command, path: &str, all: &mut Vec<String>) {
        let subcommands: Vec<_> = command
            .get_subcommands()
            .filter(|it| it.get_name() != "help")
            .collect();
        if subcommands.is_empty() || (!path.is_empty() && !command.is_subcommand_required_set()) {
            all.push(path.to_owned());
        }
        for subcommand in subcommands {
            let path = format!("{path} {}", subcommand.get_name());
            walk(subcommand, path.trim(), all);
        }
    }
    let mut all = vec![];
    walk(&Cli::command(), "", &mut all);
    all
}

#[test]
fn every_command_is_in_the_lists_and_in_the_document() {
    let told: BTreeSet<String> = commands().into_iter().collect();
    let is_name = |word: &&str| !word.starts_with('-') && !word.contains('.');
    let of = |run: &str| {
        let words: Vec<_> = run.split(' ').take_while(is_name).collect();
        let two = words.iter().take(2).copied().collect::<Vec<_>>().join(" ");
        if told.contains(&two) {
            two
        } else {
            words[0].to_owned()
        }
    };
    let listed: BTreeSet<String> = JSON.iter().chain(&OTHERS).map(|it| of(it)).collect();
    assert_eq!(listed, told);
    let document = include_str!("../../../docs/use/commands.md");
    for name in told {
        assert!(
            document.contains(&format!("| `{name}` |")),
            "{name} is not in docs/use/commands.md"
        );
    }
}

#[test]
fn json_on_standard_output_is_alone_there() {
    let folder = folder();
    for run in JSON {
        let run = touchdown(folder.path())
            .args(run.split(' '))
            .args(["--json", "-"])
            .env_remove("NO_COLOR")
            .assert();
        let output = run.success().get_output().clone();
        let json = serde_json::from_slice::<Value>(&output.stdout);
        assert!(
            json.is_ok_and(|it| it.is_object() || it.is_array()),
            "{output:?}"
        );
        // Text for people goes to standard error then; that is a pipe here.
        assert!(!output.stderr.contains(&0x1b), "{output:?}");
        assert!(!output.stderr.contains(&b'\r'), "{output:?}");
    }
}

#[test]
fn a_pipe_gets_neither_colour_nor_progress() {
    let folder = folder();
    for run in JSON {
        let run = touchdown(folder.path())
            .args(run.split(' '))
            .env_remove("NO_COLOR")
            .env("CLICOLOR_FORCE", "0")
            .assert();
        let output = run.success().get_output().clone();
        assert!(!output.stdout.is_empty());
        for bytes in [&output.stdout, &output.stderr] {
            assert!(
                !bytes.contains(&0x1b) && !bytes.contains(&b'\r'),
                "{output:?}"
            );
        }
    }
}

#[test]
fn bad_usage_is_2_and_says_why() {
    let folder = folder();
    let at = folder.path();
    for name in commands() {
        let run = touchdown(at)
            .args(name.split(' '))
            .arg("--no-such-option")
            .assert()
            .code(2);
        assert!(run.get_output().stdout.is_empty(), "{name}");
        assert!(!run.get_output().stderr.is_empty(), "{name}");
    }
    for run in [
        "nothing",
        "log",
        "scene",
        "completions basic",
        "drop nowhere.toml",
        "drop my.toml --json - --report -",
        "replay s.csv",
        "replay nowhere.csv --scene my.toml",
        "trade nowhere.toml",
        "paper --drops 0",
        "score --only nothing",
        "sweep nowhere.toml",
        "sweep plan.toml --shard 3/2",
        "sweep merge other",
        "log list plan.toml",
        "log show flash.bin 9",
        "log verify nowhere.bin",
        "force r.csv --calibration nowhere.csv",
        "scene explain nowhere.toml",
        "live",
        "live unix:nowhere --seconds 0",
        "drop my.toml --report no/such/folder.html",
    ] {
        let run = touchdown(at).args(run.split(' ')).assert().code(2);
        assert!(run.get_output().stdout.is_empty(), "{run}");
        assert!(!run.get_output().stderr.is_empty(), "{run}");
    }
}

/// As `touchdown rig --keep rig` leaves behind.
#[test]
fn a_folder_does_not_hide_a_built_in_scene() {
    let folder = folder();
    fs::create_dir(folder.path().join("rig")).expect("a folder");
    touchdown(folder.path())
        .args(["scene", "explain", "rig"])
        .assert()
        .success();
}

#[test]
fn a_check_that_does_not_hold_is_1() {
    let folder = folder();
    let at = folder.path();
    let mut torn = episode(1);
    torn[5][100] ^= 1;
    fs::write(at.join("torn.bin"), dump(&[torn])).expect("a dump");
    touchdown(at)
        .args(["log", "verify", "torn.bin"])
        .assert()
        .code(1);
    // JSON is there all the same.
    let run = touchdown(at)
        .args(["log", "verify", "torn.bin", "--json", "-"])
        .assert()
        .code(1);
    assert!(serde_json::from_slice::<Value>(&run.get_output().stdout).is_ok());
}

#[cfg(unix)]
#[test]
fn a_closed_pipe_is_no_failure() {
    let folder = folder();
    let runs = [
        "drop my.toml",
        "drop my.toml --json - --report kept.html",
        "drop my.toml --stream -",
        "log list flash.bin",
        "log export flash.bin --out -",
        "scene list",
        "completions bash",
        "drop --help",
    ];
    for run in runs {
        let mut child = Command::new(program())
            .args(run.split(' '))
            .current_dir(folder.path())
            .stdout(Stdio::piped())
            .stderr(Stdio::piped())
            .spawn()
            .expect("the program starts");
        // Closed before anything is read.
        drop(child.stdout.take());
        let ended = child.wait_with_output().expect("its end");
        assert_eq!(ended.status.code(), Some(0), "{run}: {ended:?}");
        assert!(
            !String::from_utf8_lossy(&ended.stderr).contains("panic"),
            "{run}: {ended:?}"
        );
    }
    // What else was asked for is done.
    assert!(folder.path().join("kept.html").is_file());
}

#[test]
fn completions_know_every_command() {
    let folder = tempfile::tempdir().expect("a folder");
    for shell in ["bash", "zsh", "fish", "powershell", "elvish"] {
        let run = touchdown(folder.path())
            .args(["completions", shell])
            .assert()
            .success();
        let script = String::from_utf8(run.get_output().stdout.clone()).expect("text");
        for name in commands() {
            let last = name.split(' ').next_back().expect("a name");
            assert!(script.contains(last), "{shell}: {name}");
        }
    }
}

/// The commands among a help's lines.
fn examples(help: &str) -> Vec<String> {
    let lines = help.lines().filter_map(|it| it.strip_prefix("  "));
    let commands = lines.filter(|it| *it == "touchdown" || it.starts_with("touchdown "));
    // Two blanks, and what it is for.
    let bare = commands.map(|it| it.split("  ").next().unwrap_or(it).trim().to_owned());
    bare.collect()
}

/// Why an example is not run here but only read.
fn only_read(example: &str) -> Option<&'static str> {
    let reasons = [
        ("--on qemu", "needs the image"),
        ("/dev/", "needs a controller"),
        ("touchdown live", "needs a controller"),
        ("touchdown config", "needs a controller"),
        ("touchdown rig", "runs until it is told to quit"),
        ("rig/log", "needs a run of the rig"),
        (".cfg", "read in recordings.rs"),
        ("--hours 24", "24 hours"),
        ("> ~", "writes to the home folder"),
        ("touchdown limits", "runs in lab/limits.rs"),
        ("touchdown trade", "runs in lab/trade.rs"),
        ("soft-support --drops", "runs there with fewer"),
        ("touchdown paper --json", "runs as touchdown paper"),
    ];
    let found = reasons.iter().find(|(part, _)| example.contains(part));
    found.map(|(_, reason)| *reason)
}

/// Read as the program would, up to what is the shell's.
fn assert_usage(example: &str) {
    let words = example.split(' ').take_while(|it| *it != "|" && *it != ">");
    let read = <Cli as clap::Parser>::try_parse_from(words);
    assert!(
        read.is_ok(),
        "{example}: {}",
        read.err().map_or(String::new(), |it| it.to_string())
    );
}

fn run(at: &Path, example: &str) {
    let words = example.split(' ').skip(1);
    let status = touchdown(at)
        .args(words)
        .assert()
        .get_output()
        .status
        .code();
    // Whether all targets are reached is not the question here.
    let may_miss = example.starts_with("touchdown score");
    assert!(
        status == Some(0) || (may_miss && status == Some(1)),
        "{example}: {status:?}"
    );
}

#[test]
fn the_examples_of_every_help_run() {
    let folder = folder();
    let at = folder.path();
    let mut done = BTreeSet::new();
    let mut names = commands();
    names.extend(["".to_owned(), "log".to_owned(), "scene".to_owned()]);
    for name in names {
        let words = name.split(' ').filter(|it| !it.is_empty());
        let help = touchdown(at).args(words).arg("--help").assert().success();
        let help = String::from_utf8(help.get_output().stdout.clone()).expect("text");
        let examples = examples(&help);
        assert!(help.contains("Examples"), "{name} teaches nothing:\n{help}");
        assert!(!examples.is_empty(), "{name} has no example:\n{help}");
        for example in examples {
            assert_usage(&example);
            if only_read(&example).is_none() && done.insert(example.clone()) {
                run(at, &example);
            }
        }
    }
    assert!(done.len() > 30, "{done:?}");
}

/// A support so stiff against its damping that the reference takes tens of steps a millisecond.
#[test]
fn a_truth_that_would_take_too_long_is_given_up_and_the_drop_ends() {
    let folder = tempfile::tempdir().expect("a folder");
    // A random machine whose light rings chatter; its model comes to the end.
    let scene = touchdown(folder.path()).args(["limits", "--machine", "11"]).assert().success();
    fs::write(folder.path().join("stiff.toml"), &scene.get_output().stdout).expect("a file");
    let run = touchdown(folder.path()).args(["drop", "stiff.toml", "--truth", "--json", "-"]).assert().success();
    let json: Value = serde_json::from_slice(&run.get_output().stdout).expect("JSON");
    let given_up = json["truth_given_up_s"].as_f64().expect("a time");
    assert!(given_up > 0.01 && given_up < 0.05, "{given_up}");
    // What came so far is there, and the model went on.
    assert!(!json["detector"]["events"].as_array().expect("events").is_empty());
    assert_eq!(json["final"]["time_s"], 0.05);
    // A scene whose truth ends says nothing of it.
    let run = touchdown(folder.path()).args(["drop", "rig", "--truth", "--json", "-"]).assert().success();
    let json: Value = serde_json::from_slice(&run.get_output().stdout).expect("JSON");
    assert!(json.get("truth_given_up_s").is_none());
}
