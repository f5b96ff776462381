//! What a terminal or a browser would obey is shown to people, wherever the text comes from.

use std::fs;
use std::io::Cursor;
use std::path::Path;

use tempfile::TempDir;
use touchdown_base::input_error::InputError;
use touchdown_protocol::link::Refusal;
use touchdown_files::link::LinkError;
use touchdown_files::recording::{Mapping, Reading, Recording};
use touchdown_scene::Scene;
use touchdown_tests::binary::touchdown;
use touchdown_tests::minimal_scene::SCENE;

/// Clears the screen, sets the window's title, changes the colour, turns the text round.
const OBEYED: &str = "\u{1b}[2J\u{1b}]0;x\u{7}\u{9b}31m\u{202e}tac\u{2066}";
/// The same in a string of TOML, which has no controls.
const IN_TOML: &str = "\\u001b[2J\\u001b]0;x\\u0007\u{9b}31m\u{202e}tac\u{2066}";
/// As it is shown.
const SHOWN: &str = r"\u{1b}[2J\u{1b}]0;x\u{7}\u{9b}31m\u{202e}tac\u{2066}";

const RINGS: &str =
    "[two_plane]\nrotor_length_mm = 326\n[[ring]]\nz_mm = -120\n[[ring]]\nz_mm = 120\n";

/// Nothing to be obeyed is left.
fn is_plain(text: &str) -> bool {
    let obeyed = |letter: char| {
        let turns = matches!(letter, '\u{202a}'..='\u{202e}' | '\u{2066}'..='\u{2069}');
        turns || letter.is_control() && !matches!(letter, '\n' | '\t')
    };
    !text.chars().any(obeyed)
}

/// What the program says and, in `page`, writes.
fn said(folder: &Path, arguments: &[&str], page: Option<&str>) -> String {
    let output = touchdown(folder).args(arguments).output().unwrap();
    let page = page.map(|name| fs::read(folder.join(name)).expect("a page"));
    let all = [output.stdout, output.stderr, page.unwrap_or_default()].concat();
    String::from_utf8(all).expect("text")
}

fn check(said: &str) {
    assert!(said.contains(SHOWN), "not shown:\n{said}");
    assert!(is_plain(said), "obeyed:\n{said:?}");
}

#[test]
fn titles_sources_and_names_of_a_scene() {
    let heads = [
        format!("title = \"{IN_TOML}\"\n{SCENE}"),
        format!("source = \"{IN_TOML}\"\n{SCENE}"),
        format!("{SCENE}{RINGS}name = \"{IN_TOML}\"\n"),
    ];
    for (index, scene) in heads.iter().enumerate() {
        let folder = TempDir::new().unwrap();
        fs::write(folder.path().join("s.toml"), scene).unwrap();
        let report = ["drop", "s.toml", "--report", "a.html"];
        check(&said(folder.path(), &report, Some("a.html")));
        if index < 2 {
            check(&said(folder.path(), &["scene", "explain", "s.toml"], None));
        }
    }
}

#[test]
fn keys_values_and_lines_of_a_scene() {
    let folder = TempDir::new().unwrap();
    for line in [
        format!("\"{IN_TOML}\" = 1"),
        format!("seed = \"{IN_TOML}\""),
        format!("{OBEYED} = 1"),
        format!("[model]\nrung = \"{IN_TOML}\""),
        format!("[outputs]\nregime = true # \u{9b}31m\n[{OBEYED}"),
    ] {
        fs::write(folder.path().join("s.toml"), format!("{SCENE}{line}\n")).unwrap();
        let said = said(folder.path(), &["drop", "s.toml"], None);
        assert!(said.contains("s.toml:1") && is_plain(&said), "{said:?}");
    }
}

/// The names of files, good and bad.
#[cfg(unix)]
#[test]
fn names_of_files() {
    let folder = TempDir::new().unwrap();
    let write = |name: &str, text: &str| fs::write(folder.path().join(name), text).unwrap();
    let [scene, bad, stream, mapping] =
        ["toml", "bad", "csv", "map"].map(|ending| format!("{OBEYED}.{ending}"));
    let rows = (0..400).map(|row| format!("{},1,2\n", f64::from(row) / 1e3));
    let rows: String = rows.collect();
    write(&scene, SCENE);
    write(&bad, "[rotor]\nmass_kg = 0\n");
    write(&stream, &format!("time_s,ax_um,ay_um\n{rows}"));
    write(&mapping, "[ax]\n");
    for (arguments, page) in [
        (&["drop", &scene, "--report", "a.html"][..], Some("a.html")),
        (&["drop", &bad], None),
        (&["drop", "rig", "--json", &format!("{OBEYED}/a")], None),
        (
            &["replay", &stream, "--scene", "rig", "--report", "b.html"],
            Some("b.html"),
        ),
        (
            &["replay", &stream, "--scene", "rig", "--columns", &mapping],
            None,
        ),
        (&["replay", &bad, "--scene", "rig"], None),
        (
            &[
                "compare", &stream, &stream, "--scene", "rig", "--report", "c.html",
            ],
            Some("c.html"),
        ),
        (&["force", &stream, "--calibration", &stream], None),
    ] {
        check(&said(folder.path(), arguments, page));
    }
}

#[test]
fn names_of_columns() {
    let rig = Scene::load("rig").unwrap();
    let read = |text: &str, mapping: Option<&str>| {
        let reading = Reading {
            mapping: mapping.map(|it| Mapping::parse("m.toml", it).unwrap()),
            resample: None,
        };
        let bytes = Cursor::new(text.as_bytes().to_vec());
        let recording = Recording::of_bytes("r.csv", bytes, text.len() as u64, &reading, &rig);
        let rows: Result<Vec<_>, _> = recording.and_then(Iterator::collect);
        rows.map(|_| ()).unwrap_err().to_string()
    };
    let rows = "0;1;2\n1;eins;2\n2;1;2\n3;1;2\n";
    let text = format!("t;{OBEYED};y\n{rows}");
    let mapping = "[time]\ncolumn = 1\nunit = 'ms'\n[ax]\ncolumn = 2\nunit = 'um'\n[ay]\ncolumn = 3\nunit = 'um'\n";
    for error in [
        read(&text, Some(mapping)),
        read(&text, Some(&mapping.replace("column = 3", "column = 'z'"))),
        read(&text, Some(&mapping.replace("column = 3", "column = 2"))),
        read(&text, None),
        read(&text, Some(&mapping.replace("unit = 'ms'", ""))),
    ] {
        assert!(is_plain(&error), "{error:?}");
    }
}

#[test]
fn what_a_device_says() {
    let refused = LinkError::Refused(Refusal::parameter(OBEYED)).to_string();
    check(&refused);
}

#[cfg(unix)]
#[test]
fn what_a_device_calls_its_firmware() {
    use std::sync::{Arc, Mutex};
    use touchdown_tests::controller::{Controller, Machine};

    let mut machine = Machine::default();
    machine.firmware = OBEYED;
    let (_controller, port) = Controller::at_tcp(Arc::new(Mutex::new(machine)));
    let folder = TempDir::new().unwrap();
    check(&said(folder.path(), &["config", &port], None));
}

/// A file that another one names may be anybody's: what is wrong with it is told, not what stands in it.
#[test]
fn a_file_that_is_named_in_another_one_is_not_quoted() {
    for (text, line) in [
        (
            "root:$6$secret:19000:0:99999:7:::\ndaemon:*:19000:0:99999:7:::\n",
            1,
        ),
        ("secret = 1\n", 1),
        ("[rotor]\nmass_kg = \"a \\\"secret\\\" word\"\n", 2),
        ("[rotor]\n\"a`secret`b\" = 1\n", 2),
        ("title = \"x\"\nsecret", 2),
    ] {
        let Err(error) = Scene::parse("shadow", text) else {
            panic!("{text} is a scene");
        };
        let shown = format!("{:?}", miette::Report::new(error.of_named_file()));
        assert!(shown.contains(&format!("shadow:{line}: ")), "{shown}");
        assert!(!shown.contains("secret"), "{shown}");
    }
    let kept = InputError::at_line("a", 3, "mass_kg must be above 0").of_named_file();
    assert_eq!(kept.to_string(), "a:3: mass_kg must be above 0");
}
