//! Every command, with each option that names a file.

use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::os::unix::fs::PermissionsExt;
use std::path::Path;
use std::process::Command;

use clap::CommandFactory;
use tempfile::TempDir;
use touchdown_files::configuration;
use touchdown_scene::BUILT_IN;
use touchdown_sim::commands::Cli;

use crate::binary::{program, touchdown};
use crate::controller::settings;
use crate::episode::{dump, episode};
use crate::led_rounds;

/// Where an output goes.
#[derive(Clone, Copy, Debug)]
pub enum Output {
    /// To the file of this option.
    File(&'static str),
    /// To these files in the folder of this option.
    Folder(&'static str, &'static [&'static str]),
}

/// A command as it is run here. Options and arguments are named as clap has them.
#[derive(Clone, Copy, Debug)]
pub struct Row {
    /// Its name, as `log list`.
    pub command: &'static str,
    /// Its words, with every input and no output.
    pub words: &'static str,
    /// Option and file of each input.
    pub inputs: &'static [(&'static str, &'static str)],
    /// Files that are read though no option names them.
    pub beside: &'static [&'static str],
    /// What it writes.
    pub outputs: &'static [Output],
    /// Its other options.
    pub others: &'static [&'static str],
}

impl Row {
    /// All files that are read.
    pub fn read(&self) -> impl Iterator<Item = &'static str> {
        let named = self.inputs.iter().map(|(_, file)| *file);
        named.chain(self.beside.iter().copied())
    }

    /// The options of the outputs that are files.
    pub fn files(&self) -> Vec<&'static str> {
        let file = |it: &Output| match *it {
            Output::File(option) => Some(option),
            Output::Folder(..) => None,
        };
        self.outputs.iter().filter_map(file).collect()
    }

    /// The command with more words, in `folder`. It finds an emulator that is none.
    pub fn run(&self, folder: &Path, more: &[&str]) -> Command {
        let path = std::env::var("PATH").unwrap_or_default();
        let bin = folder.join("bin");
        let mut command = Command::new(program());
        command
            .args(self.words.split_whitespace())
            .args(more)
            .current_dir(folder)
            .env("PATH", format!("{}:{path}", bin.display()))
            .env("NO_COLOR", "1");
        command
    }
}

use Output::{File, Folder};

const NONE: Row = Row {
    command: "",
    words: "",
    inputs: &[],
    beside: &[],
    outputs: &[],
    others: &[],
};

/// What a sweep leaves in its folder.
const SWEEP: &[&str] = &["drops.csv", "points.csv", "sweep.json", "sweep.html"];

/// All commands; one whose inputs exclude each other stands here twice.
pub const ROWS: &[Row] = &[
    Row {
        command: "drop",
        words: "drop my.toml",
        inputs: &[("scene", "my.toml")],
        outputs: &[File("--json"), File("--report"), File("--stream")],
        others: &["on"],
        ..NONE
    },
    Row {
        command: "drop",
        words: "drop my.toml --on qemu --image image",
        inputs: &[("scene", "my.toml"), ("image", "image")],
        outputs: &[File("--json"), File("--report"), File("--stream")],
        ..NONE
    },
    Row {
        command: "replay",
        words: "replay s.csv --scene my.toml --columns map.toml",
        inputs: &[
            ("stream", "s.csv"),
            ("scene", "my.toml"),
            ("columns", "map.toml"),
        ],
        outputs: &[File("--json"), File("--report")],
        others: &["clear_at", "on", "resample"],
        ..NONE
    },
    Row {
        command: "replay",
        words: "replay e.cfg --scene my.toml --on qemu --image image",
        inputs: &[
            ("stream", "e.cfg"),
            ("scene", "my.toml"),
            ("image", "image"),
        ],
        beside: &["e.dat"],
        outputs: &[File("--json"), File("--report")],
        ..NONE
    },
    Row {
        command: "compare",
        words: "compare s.csv b.csv --scene my.toml --columns map.toml --columns-b map-b.toml",
        inputs: &[
            ("first", "s.csv"),
            ("second", "b.csv"),
            ("scene", "my.toml"),
            ("columns", "map.toml"),
            ("columns_b", "map-b.toml"),
        ],
        outputs: &[File("--json"), File("--report")],
        others: &["within_ms", "within_percent", "resample"],
        ..NONE
    },
    Row {
        command: "compare",
        words: "compare s.csv e.dat --scene my.toml",
        inputs: &[
            ("first", "s.csv"),
            ("second", "e.dat"),
            ("scene", "my.toml"),
        ],
        beside: &["e.cfg"],
        outputs: &[File("--json"), File("--report")],
        ..NONE
    },
    Row {
        command: "trade",
        words: "trade short.toml --drops 0",
        inputs: &[("scene", "short.toml")],
        outputs: &[File("--json"), File("--report"), File("--svg")],
        others: &["drops"],
        ..NONE
    },
    Row {
        command: "paper",
        words: "paper --drops 2",
        outputs: &[File("--json"), File("--report")],
        others: &["drops"],
        ..NONE
    },
    Row {
        command: "limits",
        words: "limits --drops 1",
        outputs: &[File("--json")],
        others: &["machines", "machine", "drops"],
        ..NONE
    },
    Row {
        command: "score",
        words: "score --quick --only quiet",
        outputs: &[File("--json"), File("--report")],
        others: &["seeds", "first_seed", "only", "seconds", "hours", "on"],
        ..NONE
    },
    Row {
        command: "score",
        words: "score --quick --only quiet --on qemu --image image",
        inputs: &[("image", "image")],
        outputs: &[File("--json"), File("--report")],
        ..NONE
    },
    Row {
        command: "sweep",
        words: "sweep plan.toml",
        inputs: &[("plan", "plan.toml")],
        beside: &["my.toml"],
        outputs: &[File("--json"), Folder("--out", SWEEP)],
        others: &["shard"],
    },
    Row {
        command: "sweep",
        words: "sweep plan.toml --shard 1/2",
        inputs: &[("plan", "plan.toml")],
        beside: &["my.toml"],
        outputs: &[Folder("--out", &["part-1-of-2.csv"])],
        ..NONE
    },
    Row {
        command: "sweep merge",
        words: "sweep merge run",
        inputs: &[("folders", "run/part-1-of-1.csv")],
        outputs: &[File("--json")],
        ..NONE
    },
    Row {
        command: "rig",
        words: "rig my.toml --image image",
        inputs: &[("scene", "my.toml"), ("image", "image")],
        outputs: &[Folder(
            "--keep",
            &["log", "settings", "replay", "answer", "out", "err"],
        )],
        others: &["port", "noise"],
        ..NONE
    },
    Row {
        command: "log list",
        words: "log list flash.bin",
        inputs: &[("file", "flash.bin")],
        outputs: &[File("--json")],
        ..NONE
    },
    Row {
        command: "log show",
        words: "log show flash.bin",
        inputs: &[("file", "flash.bin")],
        outputs: &[File("--json")],
        others: &["number"],
        ..NONE
    },
    Row {
        command: "log export",
        words: "log export flash.bin",
        inputs: &[("file", "flash.bin")],
        outputs: &[File("--out")],
        others: &["number", "format"],
        ..NONE
    },
    Row {
        command: "log verify",
        words: "log verify flash.bin",
        inputs: &[("file", "flash.bin")],
        outputs: &[File("--json")],
        ..NONE
    },
    Row {
        command: "live",
        words: "live unix:rig.sock --seconds 1",
        outputs: &[File("--json")],
        others: &["port", "seconds"],
        ..NONE
    },
    Row {
        command: "config",
        words: "config unix:rig.sock --set c.toml --key-file k",
        inputs: &[("set", "c.toml"), ("key_file", "k")],
        outputs: &[File("--json")],
        others: &["port"],
        ..NONE
    },
    Row {
        command: "clear",
        words: "clear unix:rig.sock --key-file k",
        inputs: &[("key_file", "k")],
        outputs: &[File("--json")],
        others: &["port"],
        ..NONE
    },
    Row {
        command: "log lock",
        words: "log lock unix:rig.sock 1 --key-file k",
        inputs: &[("key_file", "k")],
        outputs: &[File("--json")],
        others: &["port", "episode"],
        ..NONE
    },
    Row {
        command: "log unlock",
        words: "log unlock unix:rig.sock 1 --key-file k",
        inputs: &[("key_file", "k")],
        outputs: &[File("--json")],
        others: &["port", "episode"],
        ..NONE
    },
    Row {
        command: "log erase",
        words: "log erase unix:rig.sock 1 --key-file k",
        inputs: &[("key_file", "k")],
        outputs: &[File("--json")],
        others: &["port", "episode"],
        ..NONE
    },
    Row {
        command: "calibrate",
        words: "calibrate led.csv --scene my.toml --columns map.toml",
        inputs: &[
            ("recording", "led.csv"),
            ("scene", "my.toml"),
            ("columns", "map.toml"),
        ],
        outputs: &[File("--json"), File("--report"), File("--write")],
        others: &["clearance", "scale", "date", "resample"],
        ..NONE
    },
    Row {
        command: "calibrate",
        words: "calibrate led.csv --config old.toml",
        inputs: &[("recording", "led.csv"), ("config", "old.toml")],
        outputs: &[File("--json"), File("--report"), File("--write")],
        ..NONE
    },
    Row {
        command: "force",
        words: "force r.csv --calibration c.csv --calibration c-y.csv",
        inputs: &[
            ("recording", "r.csv"),
            ("calibration", "c.csv"),
            ("calibration", "c-y.csv"),
        ],
        outputs: &[File("--json"), File("--report")],
        ..NONE
    },
    Row {
        command: "force",
        words: "force",
        outputs: &[Folder(
            "--example",
            &["calibration.csv", "recording.csv", "truth.json"],
        )],
        ..NONE
    },
    Row {
        command: "scene list",
        words: "scene list",
        outputs: &[File("--json")],
        ..NONE
    },
    Row {
        command: "scene explain",
        words: "scene explain my.toml",
        inputs: &[("scene", "my.toml")],
        outputs: &[File("--json")],
        others: &["drops"],
        ..NONE
    },
    Row {
        command: "completions",
        words: "completions bash",
        others: &["shell"],
        ..NONE
    },
];

/// The scene `my.toml`, for what takes seconds over all of it.
///
/// # Panics
/// If its duration has changed.
pub fn short_scene() -> String {
    let scene = BUILT_IN[0].text;
    let short = scene.replace("duration_s = 0.3", "duration_s = 0.01");
    assert_ne!(short, scene, "its duration has changed");
    short
}

/// The options and arguments with a value of each command, by the rows.
pub fn listed() -> BTreeMap<String, BTreeSet<String>> {
    let mut all = BTreeMap::<_, BTreeSet<String>>::new();
    for row in ROWS {
        let outputs = row.outputs.iter().map(|it| match it {
            File(option) | Folder(option, _) => option.trim_start_matches('-'),
        });
        let inputs = row.inputs.iter().map(|(id, _)| *id);
        let ids = inputs.chain(outputs).chain(row.others.iter().copied());
        let of_command = all.entry(row.command.to_owned()).or_default();
        of_command.extend(ids.map(str::to_owned));
    }
    all
}

/// The same by clap.
pub fn there() -> BTreeMap<String, BTreeSet<String>> {
    fn walk(command: &clap::Command, path: &str, all: &mut BTreeMap<String, BTreeSet<String>>) {
        let values = command
            .get_arguments()
            .filter(|it| it.get_action().takes_values());
        let ids: BTreeSet<_> = values.map(|it| it.get_id().to_string()).collect();
        let subcommands = command.get_subcommands();
        let subcommands: Vec<_> = subcommands.filter(|it| it.get_name() != "help").collect();
        if subcommands.is_empty() || !ids.is_empty() {
            all.insert(path.to_owned(), ids);
        }
        for subcommand in subcommands {
            let path = format!("{path} {}", subcommand.get_name());
            walk(subcommand, path.trim(), all);
        }
    }
    let mut all = BTreeMap::new();
    walk(&Cli::command(), "", &mut all);
    all
}

const PLAN: &str = "scene = \"my.toml\"\ndrops = 4\n[start]\nwithin = 0.5\n[[parameter]]\nkey = \"run.duration_s\"\nvalues = [0.1]\n";

/// The columns of a stream.
const MAP: &str =
    "[time]\ncolumn = \"time_s\"\n[ax]\ncolumn = \"ax_um\"\n[ay]\ncolumn = \"ay_um\"\n";

/// A folder with all inputs of all rows.
///
/// # Panics
/// If it cannot be made.
pub fn folder() -> TempDir {
    let folder = tempfile::tempdir().expect("a folder");
    let at = folder.path();
    let put = |name: &str, bytes: &[u8]| fs::write(at.join(name), bytes).expect(name);
    put("my.toml", BUILT_IN[0].text.as_bytes());
    put("short.toml", short_scene().as_bytes());
    put("plan.toml", PLAN.as_bytes());
    put("flash.bin", &dump(&[episode(1), episode(2)]));
    put("led.csv", led_rounds::example().as_bytes());
    put("old.toml", configuration::text(&settings()).as_bytes());
    put("image", b"no image");
    put("c.toml", b"");
    put("k", b"00112233445566778899aabbccddeeff\n");
    put("map.toml", MAP.as_bytes());
    put("map-b.toml", MAP.as_bytes());
    fs::create_dir(at.join("bin")).expect("a folder");
    emulator(at, "exit 1");
    for run in [
        "drop my.toml --stream s.csv",
        "drop my.toml --stream b.csv",
        "force --example try",
        "sweep plan.toml --out run",
        "log export flash.bin --format comtrade --out e.cfg",
    ] {
        touchdown(at).args(run.split(' ')).assert().success();
    }
    for (from, to) in [("recording.csv", "r.csv"), ("calibration.csv", "c.csv")] {
        fs::rename(at.join("try").join(from), at.join(to)).expect(to);
    }
    let along_x = fs::read_to_string(at.join("c.csv")).expect("a calibration");
    put("c-y.csv", along_x.replace("ax_m_s2", "ay_m_s2").as_bytes());
    for name in SWEEP {
        fs::remove_file(at.join("run").join(name)).expect("a result");
    }
    folder
}

/// Makes a script of the emulator that [`Row::run`] finds.
///
/// # Panics
/// If it cannot be made.
pub fn emulator(folder: &Path, script: &str) {
    let path = folder.join("bin/qemu-system-arm");
    fs::write(&path, format!("#!/bin/sh\n{script}\n")).expect("a script");
    fs::set_permissions(&path, fs::Permissions::from_mode(0o755)).expect("rights");
}

/// All files of a folder with their bytes. A folder ends with `/`, what is neither has no bytes.
///
/// # Panics
/// If one cannot be read.
pub fn contents(folder: &Path) -> BTreeMap<String, Vec<u8>> {
    let mut all = BTreeMap::new();
    for entry in fs::read_dir(folder).expect("a folder") {
        let entry = entry.expect("an entry");
        let path = entry.path();
        let name = path.file_name().expect("a name").to_string_lossy();
        // Not through a link to a folder: it may lead back here.
        if entry.file_type().expect("its kind").is_dir() {
            all.insert(format!("{name}/"), vec![]);
            let within = contents(&path);
            all.extend(
                within
                    .into_iter()
                    .map(|(it, bytes)| (format!("{name}/{it}"), bytes)),
            );
        } else {
            let bytes = fs::metadata(&path).is_ok_and(|it| it.is_file());
            let bytes = bytes.then(|| fs::read(&path).expect("bytes"));
            all.insert(name.into_owned(), bytes.unwrap_or_default());
        }
    }
    all
}
