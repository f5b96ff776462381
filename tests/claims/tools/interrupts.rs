//! What a signal ends leaves nothing behind, and files take their names together or not at all. Over all commands that
//! write files.
#![cfg(unix)]

use std::fs;
use std::os::unix::process::ExitStatusExt;
use std::path::Path;
use std::process::{Child, Command, ExitStatus, Stdio};
use std::thread::sleep;
use std::time::{Duration, Instant};

use touchdown_tests::binary::program;
use touchdown_tests::file_options::{ROWS, Row, contents, emulator, folder};

const SIGNALS: [(&str, i32); 3] = [("HUP", 1), ("INT", 2), ("TERM", 15)];
/// Far more than anything here takes.
const LONG: Duration = Duration::from_secs(120);

/// Those that a program started here obeys: under `nohup` it ignores HUP.
fn signals() -> Vec<(&'static str, i32)> {
    let status = fs::read_to_string("/proc/self/status").unwrap_or_default();
    let ignored = status.lines().find_map(|it| it.strip_prefix("SigIgn:\t"));
    let ignored = ignored.and_then(|it| u64::from_str_radix(it, 16).ok());
    let obeyed = |number: i32| ignored.unwrap_or(0) >> (number - 1) & 1 == 0;
    (SIGNALS.into_iter().filter(|it| obeyed(it.1))).collect()
}

fn signal(process: u32, name: &str) {
    let sent = Command::new("kill")
        .args([format!("-{name}"), process.to_string()])
        .status();
    assert!(sent.expect("kill runs").success());
}

/// Names of files that have not got theirs.
fn hidden(at: &Path) -> Vec<String> {
    let names = contents(at).into_keys();
    names.filter(|it| it.contains(".touchdown-")).collect()
}

fn until(what: &str, mut holds: impl FnMut() -> bool) {
    let start = Instant::now();
    while !holds() {
        assert!(start.elapsed() < LONG, "not within {LONG:?}: {what}");
        sleep(Duration::from_millis(1));
    }
}

/// A command that has opened its outputs and is not done with its work.
struct Held {
    child: Child,
    /// What it waits for, and what should be in it.
    pipe: Option<(std::path::PathBuf, Vec<u8>)>,
}

impl Held {
    /// Starts a row with its outputs in `files`. An input is a pipe into which nobody has written yet, or the work
    /// takes long.
    fn start(at: &Path, row: &Row, files: &[String]) -> Self {
        let words = row.files().into_iter().zip(files);
        let words: Vec<_> = words.flat_map(|(option, file)| [option, file]).collect();
        let pipe = pipe(row).map(|name| {
            let path = at.join(name);
            let bytes = fs::read(&path).expect("an input");
            fs::remove_file(&path).expect("it was there");
            let made = Command::new("mkfifo").arg(&path).status();
            assert!(made.expect("mkfifo runs").success());
            (path, bytes)
        });
        let mut command = row.run(at, &words);
        command.env("TMPDIR", at.join("tmp"));
        command.stdout(Stdio::null()).stderr(Stdio::piped());
        let mut child = command.spawn().expect("it starts");
        until("its files are open", || {
            assert_eq!(child.try_wait().expect("a child"), None, "{command:?}");
            hidden(at).len() == files.len()
        });
        Self { child, pipe }
    }

    /// Gives it its input.
    fn feed(&mut self) {
        if let Some((path, bytes)) = &self.pipe {
            fs::write(path, bytes).expect("it reads");
        }
    }

    /// Its end and its errors; the input is a file again.
    fn end(self) -> (ExitStatus, String) {
        let ended = self.child.wait_with_output().expect("its end");
        if let Some((path, bytes)) = self.pipe {
            fs::remove_file(&path).expect("it was there");
            fs::write(path, bytes).expect("an input");
        }
        let told = String::from_utf8_lossy(&ended.stderr).into_owned();
        (ended.status, told)
    }
}

/// The input that can be a pipe: one that is read once, after the outputs are open.
fn pipe(row: &Row) -> Option<&'static str> {
    let of_emulator = row.words.contains("--image");
    let mut read = row.read().filter(|_| !row.command.starts_with("sweep"));
    let scene = row.read().find(|it| *it == "my.toml");
    if of_emulator {
        return None;
    }
    let first = read.next()?;
    Some(scene.unwrap_or(first))
}

/// Every command that can be held up, its work long enough to be.
fn held() -> Vec<Row> {
    let can = |row: &&Row| !row.files().is_empty() && pipe(row).is_some();
    let mut rows: Vec<_> = ROWS.iter().filter(can).copied().collect();
    for (command, words) in [
        ("paper", "paper --drops 100000"),
        ("score", "score --only quiet"),
        ("limits", "limits"),
    ] {
        let row = ROWS.iter().find(|it| it.command == command);
        let row = *row.expect("it is a command");
        rows.push(Row { words, ..row });
    }
    rows
}

fn names(row: &Row) -> Vec<String> {
    (0..row.files().len()).map(|it| format!("o{it}")).collect()
}

#[test]
fn a_signal_leaves_nothing_behind() {
    let folder = folder();
    let at = folder.path();
    fs::create_dir(at.join("tmp")).expect("a folder");
    let rows = held();
    assert!(rows.len() > 12, "{rows:?}");
    for row in &rows {
        for (name, number) in signals() {
            let before = contents(at);
            let held = Held::start(at, row, &names(row));
            signal(held.child.id(), name);
            let (status, _) = held.end();
            assert_eq!(status.signal(), Some(number), "{}: {name}", row.words);
            assert!(before == contents(at), "{}: {name}", row.words);
        }
    }
}

/// Their work is done in no time, or they leave a journal: a signal at any moment.
#[test]
fn a_signal_at_any_moment_leaves_whole_files_or_none() {
    let folder = folder();
    let at = folder.path();
    let plan = fs::read_to_string(at.join("plan.toml")).expect("a plan");
    fs::write(at.join("many.toml"), plan.replace("= 4", "= 4000")).expect("a plan");
    let mut ends = [0, 0];
    for words in [
        "",
        "scene list --json o",
        "scene explain my.toml --json o",
        "log list flash.bin --json o",
        "log export flash.bin --format comtrade --out o.cfg",
        "force --example f",
        "drop my.toml --json o --report p --stream q",
        "sweep merge run --json o",
        "sweep many.toml --json o",
    ] {
        for moment in 0..24_u64 {
            let signals = signals();
            let (name, number) = signals[moment as usize % signals.len()];
            let mut command = Command::new(program());
            command.args(words.split_whitespace()).current_dir(at);
            command.stdout(Stdio::null()).stderr(Stdio::null());
            let mut child = command.spawn().expect("it starts");
            sleep(Duration::from_micros(700 * moment));
            // It stays there until it is waited for.
            signal(child.id(), name);
            let status = child.wait().expect("its end");
            let whole = status.success();
            assert!(
                whole || status.signal() == Some(number),
                "{words}: {status}"
            );
            ends[usize::from(whole)] += 1;
            assert_eq!(hidden(at), [""; 0], "{words}: {name}");
            // All or none.
            for (one, other) in [
                ("o.cfg", "o.dat"),
                ("p", "q"),
                ("f/truth.json", "f/recording.csv"),
            ] {
                assert_eq!(at.join(one).exists(), at.join(other).exists(), "{words}");
            }
            for file in ["o", "p", "q", "o.cfg", "o.dat", "touchdown-report.html"] {
                // A page ends with a tag, all else with a line.
                let left = fs::read_to_string(at.join(file)).unwrap_or("\n".to_owned());
                let whole = left.ends_with('\n') || left.ends_with("</html>");
                assert!(whole, "{words}: {file} is cut off");
                let _ = fs::remove_file(at.join(file));
            }
            let _ = fs::remove_dir_all(at.join("f"));
        }
    }
    assert!(ends[0] > 50, "{ends:?}");
}

#[test]
fn a_signal_ends_the_emulator_and_its_folder() {
    let folder = folder();
    let at = folder.path();
    fs::create_dir(at.join("tmp")).expect("a folder");
    let process = at.join("process");
    emulator(
        at,
        &format!("echo $$ > {}; exec sleep 600", process.display()),
    );
    let rows: Vec<_> = ROWS
        .iter()
        .filter(|it| it.words.contains("--image"))
        .collect();
    assert_eq!(rows.len(), 4);
    for row in rows {
        for (name, number) in signals() {
            let before = contents(at);
            let mut command = row.run(at, &[]);
            command.env("TMPDIR", at.join("tmp")).stdin(Stdio::null());
            command.stdout(Stdio::null()).stderr(Stdio::null());
            let mut child = command.spawn().expect("it starts");
            let started = || fs::read_to_string(&process).is_ok_and(|it| it.ends_with('\n'));
            until("the emulator works", started);
            signal(child.id(), name);
            let status = child.wait().expect("its end");
            assert_eq!(status.signal(), Some(number), "{}", row.words);
            let id = fs::read_to_string(&process).expect("a number");
            fs::remove_file(&process).expect("it was there");
            until("the emulator has gone", || {
                let stat = fs::read_to_string(format!("/proc/{}/stat", id.trim()));
                stat.is_err() || stat.is_ok_and(|it| it.contains(") Z "))
            });
            assert!(before == contents(at), "{}: {name}", row.words);
        }
    }
}

#[cfg(target_os = "linux")]
#[test]
fn a_signal_that_is_to_be_ignored_is() {
    let folder = folder();
    let at = folder.path();
    let path = at.join("my.toml");
    let bytes = fs::read(&path).expect("a scene");
    fs::remove_file(&path).expect("it was there");
    assert!(
        Command::new("mkfifo")
            .arg(&path)
            .status()
            .expect("mkfifo")
            .success()
    );
    // As nohup does.
    let script = "trap '' HUP; exec \"$0\" drop my.toml --json o";
    let mut child = Command::new("sh")
        .args(["-c", script])
        .arg(program())
        .current_dir(at)
        .stdout(Stdio::null())
        .spawn()
        .expect("a shell");
    until("its file is open", || hidden(at).len() == 1);
    signal(child.id(), "HUP");
    sleep(Duration::from_millis(200));
    fs::write(&path, bytes).expect("it reads");
    assert!(child.wait().expect("its end").success());
    assert!(at.join("o").is_file());
}

#[test]
fn files_take_their_names_together_or_not_at_all() {
    let folder = folder();
    let at = folder.path();
    let mut count = 0;
    for row in held().iter().filter(|it| it.files().len() > 1) {
        let row = match row.command {
            "paper" => Row {
                words: "paper --drops 2",
                ..*row
            },
            "score" => Row {
                words: "score --quick --only quiet",
                ..*row
            },
            _ => *row,
        };
        let names = names(&row);
        for failing in &names {
            for old in [Some("what was there"), None] {
                let others: Vec<_> = names.iter().filter(|it| *it != failing).collect();
                for name in &others {
                    if let Some(old) = old {
                        fs::write(at.join(name), old).expect("a file");
                    }
                }
                let mut held = Held::start(at, &row, &names);
                signal(held.child.id(), "STOP");
                fs::create_dir(at.join(failing)).expect("a folder");
                signal(held.child.id(), "CONT");
                held.feed();
                let (status, told) = held.end();
                assert_eq!(status.code(), Some(2), "{} {failing}", row.words);
                let why = format!("{failing}: cannot be written: is a folder");
                assert!(told.contains(&why), "{}: {told}", row.words);
                assert_eq!(hidden(at), [""; 0], "{} {failing}", row.words);
                for name in others {
                    let now = fs::read_to_string(at.join(name)).ok();
                    assert_eq!(now.as_deref(), old, "{} {failing}: {name}", row.words);
                    let _ = fs::remove_file(at.join(name));
                }
                fs::remove_dir(at.join(failing)).expect("it was made");
                count += 1;
            }
        }
    }
    assert!(count >= 24, "only {count}");
}
