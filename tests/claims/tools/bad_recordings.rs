//! No recording, mapping, plan, journal or dump crashes its reader: it is read, or refused with file and rule.

use std::fs;
use std::io::Cursor;

use proptest::prelude::*;
use tempfile::TempDir;
use touchdown_files::drop_log::Dump;
use touchdown_files::recording::{Mapping, Reading, Recording};
use touchdown_scene::Scene;
use touchdown_sweep::{Plan, found};
use touchdown_tests::even_rows::even_rows;

const MAPPING: &str = "\
[time]
column = 't'
unit = 'ms'
[ax]
column = 'x'
unit = 'um'
[ay]
column = 'y'
unit = 'V'
sensitivity = '8 mV/um'
offset = -10.0
[speed]
column = 'n'
unit = 'rpm'
[levitated]
column = 5
";
const TEXT: &str = "# a logger\nt;x;y;n;on\nms;um;V;rpm;\n0,0;1,5;-9,9;30000;1\n0,1;1,5;-9,9;30000;1\n0,2;;NaN;30000;0\n0,3;1;-9;30000;0\n";
const CFG: &str = "s,d,1999\n3,2A,1D\n1,ax,,,um,0.5,0,0,-99,99\n2,ay,,,um,0.5,0,0,-99,99\n1,levitated,,,0\n50\n1\n\
    1000,3\n01/01/2024,00:00:00.5\n01/01/2024,00:00:01\nASCII\n1\n";
const DATA: &str = "1,0,1,2,0\n2,1000,1,2,0\n3,2000,1,2,0\n";

fn rig() -> Scene {
    Scene::load("rig").unwrap()
}

fn mapped(mapping: &str) -> Reading {
    Reading {
        mapping: Some(Mapping::parse("m.toml", mapping).unwrap()),
        resample: None,
    }
}

/// Rows of the text `bytes` with `mapping`, or what is wrong with it.
fn text(bytes: &[u8], reading: &Reading) -> Result<usize, String> {
    let size = bytes.len() as u64;
    let recording = Recording::of_bytes("r.csv", Cursor::new(bytes.to_vec()), size, reading, &rig());
    let mut recording = recording.map_err(|it| it.to_string())?;
    let mut rows = 0;
    for row in &mut recording {
        row.map_err(|it| it.to_string())?;
        rows += 1;
    }
    let _ = recording.warnings();
    Ok(rows)
}

fn combined(cfg: &str, kind: &str, data: &[u8]) -> Vec<u8> {
    let head = format!("--- file type: CFG ---\n{cfg}--- file type: DAT {kind} ---\n");
    [head.as_bytes(), data].concat()
}

fn cff(bytes: &[u8]) -> Result<usize, String> {
    let bytes = Cursor::new(bytes.to_vec());
    let recording = Recording::of_bytes("r.cff", bytes, 0, &Reading::default(), &rig());
    let rows = recording.map_err(|it| it.to_string())?;
    let rows: Result<Vec<_>, _> = rows.collect();
    rows.map(|it| it.len()).map_err(|it| it.to_string())
}

#[test]
fn what_is_wrong_with_a_text_is_told() {
    let reading = mapped(MAPPING);
    assert_eq!(text(TEXT.as_bytes(), &reading), Ok(4));
    let with = |from: &str, to: &str| TEXT.replace(from, to).into_bytes();
    for (bytes, message) in [
        (
            Vec::new(),
            "r.csv:1: there are no rows of two numbers or more",
        ),
        (
            with(";n;", ";rpm;"),
            "r.csv:3: speed: there is no column \"n\"; its columns are 1 \"t\" in ms, 2 \"x\" in um",
        ),
        (
            with("t;x;y", "u;x;y"),
            "r.csv:3: time: there is no column \"t\"",
        ),
        (
            with("t;x;y;n", "t;x;x;n"),
            "r.csv:3: ax: columns 2 and 3 are both named \"x\"; give the number",
        ),
        (
            with("0,1;1,5", "0,1;eins"),
            "r.csv:5: x must be a finite number, empty or NaN, is \"eins\"",
        ),
        (
            with("0,1;1,5", "0,1;1.5"),
            "r.csv:5: x must be a finite number, empty or NaN, is \"1.5\"",
        ),
        (
            with("0,1;1,5", "0,1;1e999"),
            "r.csv:5: x must be a finite number",
        ),
        (
            with("0,1;1,5", ";1,5"),
            "r.csv:5: t must be a finite number, is \"\"; without one, give rate_hz",
        ),
        (
            with("0,1;1,5;", "0,1;"),
            "r.csv:5: a row needs 5 fields, this one has 4",
        ),
        (
            with("0,3;", "0,4;"),
            "r.csv:7: the sample rate is not constant",
        ),
        (with("0,3;", "0,2;"), "r.csv:7: time_s must increase"),
        (
            b"\xff\xfet\0;\0".to_vec(),
            "r.csv:1: the text is UTF-16; save it as UTF-8",
        ),
        (with("1,5", "\0"), "r.csv:4: is no text: it has a zero byte"),
    ] {
        let error = text(&bytes, &reading).unwrap_err();
        assert!(error.starts_with(message), "{error}");
    }
    let no_unit = mapped(&MAPPING.replace("unit = 'um'\n", ""));
    let error = text(&with("ms;um;V;rpm;\n", ""), &no_unit).unwrap_err();
    assert!(
        error.contains("ax: column \"x\" does not say its unit"),
        "{error}"
    );
    // A stream is what it was, and what else it may be is told.
    let error = text(TEXT.as_bytes(), &Reading::default()).unwrap_err();
    assert!(
        error.starts_with("r.csv:1: the header must be time_s,ax_um"),
        "{error}"
    );
    assert!(
        error.contains("--columns FILE.toml says which column is what"),
        "{error}"
    );
}

/// No column is two quantities, by number or by name.
#[test]
fn each_quantity_has_a_column_of_its_own() {
    let columns = [
        ("time", "'t'"),
        ("ax", "'x'"),
        ("ay", "'y'"),
        ("speed", "'n'"),
        ("levitated", "5"),
    ];
    let all = "[bx]\ncolumn = 6\nunit = 'um'\n[by]\ncolumn = 7\nunit = 'um'\n".to_owned() + MAPPING;
    let names = ["t", "x", "y", "n", "on", "u", "v"];
    let rows = (0..9).map(|row| format!("0,{row};1;2;3;1;4;5\n"));
    let recording = format!("{}\n{}", names.join(";"), rows.collect::<String>());
    assert_eq!(text(recording.as_bytes(), &mapped(&all)), Ok(9));
    let columns: Vec<_> = columns
        .into_iter()
        .chain([("bx", "6"), ("by", "7")])
        .collect();
    for (one, column) in &columns {
        for (other, taken) in columns.iter().filter(|it| it.0 != *one) {
            let from = format!("[{other}]\ncolumn = {taken}");
            assert!(all.contains(&from), "{from}");
            let mapping = all.replace(&from, &format!("[{other}]\ncolumn = {column}"));
            let error = text(recording.as_bytes(), &mapped(&mapping)).unwrap_err();
            let told = error.contains("each needs a column of its own")
                && error.starts_with("r.csv:1: ")
                && error.contains(one)
                && error.contains(other);
            assert!(told, "{one} {other}: {error}");
        }
    }
}

#[test]
fn what_is_wrong_with_a_mapping_is_told_with_its_line() {
    let with = |from: &str, to: &str| MAPPING.replacen(from, to, 1);
    for (mapping, message) in [
        (String::new(), "m.toml:1: [ax] and [ay] say which columns"),
        (
            with("unit = 'ms'", "unit = 'h'"),
            "m.toml:3: the unit of time must be s, ms, us or ns, is \"h\"",
        ),
        (
            with("unit = 'um'", "unit = 'furlong'"),
            "m.toml:6: the unit of a displacement must be",
        ),
        (
            with("unit = 'um'", "units = 'um'"),
            "m.toml:6: unknown key `units`",
        ),
        (
            with("unit = 'um'", "unit = 'V'"),
            "m.toml:4: volts need a sensitivity",
        ),
        (
            with("'8 mV/um'", "'8'"),
            "m.toml:10: a sensitivity is a number and its unit",
        ),
        (
            with("-10.0", "nan"),
            "m.toml:7: offset must be a finite number",
        ),
        (
            with("unit = 'ms'", "rate_hz = 1000"),
            "m.toml:1: a column or a rate_hz, not both",
        ),
        (
            with("column = 't'\nunit = 'ms'", "rate_hz = 1"),
            "m.toml:1: rate_hz must be 100 to 200000",
        ),
        (
            with("column = 't'", "column = 1.5"),
            "m.toml:2: a column is its name, or its number from 1",
        ),
        (
            with(
                "[speed]\ncolumn = 'n'\nunit = 'rpm'",
                "[bx]\ncolumn = 'n'\nunit = 'um'",
            ),
            "m.toml:12: plane b needs both [bx] and [by]",
        ),
        (with("[speed]", "[spede]"), "m.toml:12: unknown key `spede`"),
        (
            "axes = 'polar'\n".to_owned() + MAPPING,
            "m.toml:1: unknown variant `polar`",
        ),
    ] {
        let error = Mapping::parse("m.toml", &mapping).unwrap_err().to_string();
        assert!(error.starts_with(message), "{error}");
    }
}

#[test]
fn what_is_wrong_with_comtrade_is_told() {
    let good = |cfg: &str, data: &str| cff(&combined(cfg, "ASCII", data.as_bytes()));
    assert_eq!(good(CFG, DATA), Ok(3));
    let cfg = |from: &str, to: &str| (CFG.replacen(from, to, 1), DATA.to_owned());
    let data = |from: &str, to: &str| (CFG.to_owned(), DATA.replacen(from, to, 1));
    for ((cfg, data), message) in [
        (
            cfg("3,2A,1D", "4,2A,1D"),
            "r.cff:3: 4 channels are not 2 and 1",
        ),
        (
            cfg("3,2A,1D", "99999999,99999998A,1D"),
            "r.cff:3: there are more than 10000 channels",
        ),
        (
            cfg("0.5,0,0", "half,0,0"),
            "r.cff:4: the factor a of a channel must be a number, is \"half\"",
        ),
        (
            cfg("0.5,0,0", "1e999,0,0"),
            "r.cff:4: the factor a of a channel must be finite",
        ),
        (cfg("1000,3", "-1,3"), "r.cff:9: a rate must be 0 or more"),
        (cfg("1000,3", "1000,0"), "r.cff:9: a rate must be 0 or more"),
        (
            cfg("1000,3", "1,3"),
            "r.cff: the sample rate must be 100 to 200000 Hz, is 1 Hz; --resample RATE",
        ),
        (
            cfg("1\n1000,3", "2\n1000,2\n2000,3"),
            "r.cff: the sample rate changes: 1000 Hz up to sample 2, 2000 Hz",
        ),
        (
            cfg("ASCII", "EBCDIC"),
            "r.cff:12: the kind of the data file must be ASCII, BINARY, BINARY32 or FLOAT32",
        ),
        (
            cfg("ASCII", "BINARY"),
            "r.cff:14: the section's data are \"ASCII\"",
        ),
        (
            cfg("1000,3", "1000,4"),
            "r.cff:3: the data end at sample 3 of 4: the file is cut off",
        ),
        (
            cfg("1000,3", "1000,2"),
            "r.cff:3: there are more than the 2 samples",
        ),
        (
            cfg("1,ax", "1,x1"),
            "r.cff: no channels are named ax and ay",
        ),
        (
            data("2,1000", "3,1000"),
            "r.cff:2: sample 2 is numbered 3: one is missing",
        ),
        (
            data("2,1000", "2,1700"),
            "r.cff:2: the stamp is 0.001700 s after the first sample, the rates",
        ),
        (
            data("2,1000,1", "2,1000,one"),
            "r.cff:2: field 3 must be a number, is \"one\"",
        ),
        (
            data("2,1000,1", "2,1000"),
            "r.cff:2: a sample needs 5 fields, this one has 4",
        ),
    ] {
        let error = good(&cfg, &data).unwrap_err();
        assert!(error.starts_with(message), "{error}");
    }
    let binary = CFG.replace("ASCII", "BINARY");
    let sample = |number: u8| [number, 0, 0, 0, 0xff, 0xff, 0xff, 0xff, 1, 0, 2, 0, 0, 0];
    let samples = [1, 2, 3].map(sample).concat();
    assert_eq!(cff(&combined(&binary, "BINARY", &samples)), Ok(3));
    let error = cff(&combined(&binary, "BINARY", &samples[..40])).unwrap_err();
    assert!(
        error.starts_with("r.cff:3: the last sample is cut off: it has 12 of 14 bytes"),
        "{error}"
    );

    let folder = TempDir::new().unwrap();
    let path = folder.path().join("lonely.cfg");
    fs::write(&path, CFG).unwrap();
    let open = |name: &str| {
        let path = folder.path().join(name);
        let opened = Recording::open(&path, &Reading::default(), &rig());
        opened.map(|_| ()).unwrap_err().to_string()
    };
    assert!(open("lonely.cfg").contains("there is no .dat beside it"));
    assert!(open("none.cff").contains("no such file"));
    assert!(open("none.csv").contains("no such file"));
}

#[test]
fn rows_that_never_end_are_refused_before_they_fill_the_memory() {
    let reading = mapped(MAPPING);
    let endless = "1".repeat(200_000);
    let quoted = format!("time_s,ax_um,ay_um\n0,\"{}", "1,2,3\n".repeat(50_000));
    let plain = format!("time_s,ax_um,ay_um\n0,1,2\n0.001,{endless}");
    for (bytes, line) in [(quoted, 10924), (plain, 3)] {
        let error = text(bytes.as_bytes(), &Reading::default()).unwrap_err();
        let wanted =
            format!("r.csv:{line}: a row of more than 65536 bytes: no recording has such rows");
        assert_eq!(error, wanted);
    }
    let late = format!("{TEXT}0,4;{endless}");
    let error = text(late.as_bytes(), &reading).unwrap_err();
    assert_eq!(
        error,
        "r.csv:8: a row of more than 65536 bytes: no recording has such rows"
    );
    // Nor does a gap make rows without end.
    let gap = TEXT.replace("0,3;", "1e300;");
    let resample = Reading {
        resample: Some(1000.0),
        ..reading
    };
    let error = text(gap.as_bytes(), &resample).unwrap_err();
    assert!(error.contains("a gap of more than a minute"), "{error}");
}

/// `bytes` with some of them changed, left out or doubled.
fn damaged(bytes: &'static [u8]) -> impl Strategy<Value = Vec<u8>> {
    let change = (0..bytes.len(), 0..3_u8, any::<u8>());
    proptest::collection::vec(change, 0..6).prop_map(move |changes| {
        let mut bytes = bytes.to_vec();
        for (at, kind, byte) in changes {
            let at = at % bytes.len().max(1);
            match kind {
                0 if !bytes.is_empty() => bytes[at] = byte,
                1 => bytes.truncate(at),
                _ => bytes.extend_from_within(at..),
            }
        }
        bytes
    })
}

fn named(file: &str, result: Result<usize, String>) {
    if let Err(error) = result {
        assert!(error.starts_with(file), "{error}");
    }
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 400, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn any_text_is_read_or_refused(bytes in damaged(TEXT.as_bytes()), resample in any::<bool>()) {
        let mut reading = mapped(MAPPING);
        reading.resample = resample.then_some(20e3);
        named("r.csv", text(&bytes, &reading));
        named("r.csv", text(&bytes, &Reading::default()));
    }

    #[test]
    fn any_bytes_are_read_or_refused(bytes in proptest::collection::vec(any::<u8>(), 0..400)) {
        named("r.csv", text(&bytes, &mapped(MAPPING)));
        named("r.cff", cff(&bytes));
        named("r.cff", cff(&combined(CFG, "ASCII", &bytes)));
        named("r.cff", cff(&combined(&CFG.replace("ASCII", "BINARY"), "BINARY", &bytes)));
        named("s.csv", even_rows("s.csv", &bytes).map(|(rows, _)| rows.count()).map_err(|it| it.to_string()));
        let _ = Dump::of(&bytes);
    }

    #[test]
    fn any_stream_is_read_or_refused(
        bytes in damaged(b"time_s,ax_um,ay_um,levitated\n0,1,2,1\n0.001,NaN,2,1\n0.002,1,2,0\n")
    ) {
        named("s.csv", even_rows("s.csv", &bytes).map(|(rows, _)| rows.count()).map_err(|it| it.to_string()));
    }

    #[test]
    fn any_configuration_is_read_or_refused(bytes in damaged(CFG.as_bytes())) {
        named("r.cff", cff(&combined(&String::from_utf8_lossy(&bytes), "ASCII", DATA.as_bytes())));
    }

    #[test]
    fn any_mapping_is_read_or_refused(bytes in damaged(MAPPING.as_bytes())) {
        let mapping = Mapping::parse("m.toml", &String::from_utf8_lossy(&bytes));
        if let Err(error) = mapping {
            prop_assert!(error.to_string().starts_with("m.toml:"), "{error}");
        }
    }

    #[test]
    fn any_plan_and_part_are_read_or_refused(
        bytes in damaged(b"scene = 'rig'\ndrops = 10\nseed = 1\n[[parameter]]\nkey = 'retainer.friction'\nvalues = [0.1, 0.2]\n")
    ) {
        let text = String::from_utf8_lossy(&bytes);
        let scene = Scene::text("rig").unwrap();
        if let Err(error) = Plan::of_texts("p.toml", &text, &scene) {
            prop_assert!(error.to_string().contains(':'), "{error}");
        }
        let folder = TempDir::new().unwrap();
        fs::write(folder.path().join("part-1-of-1.csv"), [b"# ", &bytes[..]].concat()).unwrap();
        let folders = [folder.path().display().to_string()];
        prop_assert!(found(&folders).is_err());
    }
}
