//! Recordings as they come give what the same drop gives as a stream, to the bit; what is uneven is told,
//! resampling is open, two recordings are compared.

use std::fs;
use std::path::Path;
use std::sync::OnceLock;

use predicates::str::contains;
use serde_json::Value;
use tempfile::TempDir;
use touchdown_tests::binary::touchdown;

/// Displacement of one count of the default sensors, um.
const COUNT: f64 = 2000.0 / 4096.0;

/// The rig's drop as a stream, and its numbers: s, then um.
fn stream() -> &'static (String, Vec<Vec<f64>>) {
    static STREAM: OnceLock<(String, Vec<Vec<f64>>)> = OnceLock::new();
    STREAM.get_or_init(|| {
        let folder = TempDir::new().unwrap();
        let run = ["drop", "rig", "--stream", "s.csv"];
        touchdown(folder.path()).args(run).assert().success();
        let text = fs::read_to_string(folder.path().join("s.csv")).unwrap();
        let numbers = |line: &str| line.split(',').map(|it| it.parse().unwrap()).collect();
        let rows = text.lines().skip(1).map(numbers).collect();
        (text, rows)
    })
}

fn rows() -> &'static [Vec<f64>] {
    &stream().1
}

/// A folder with these files.
fn folder(files: &[(&str, &[u8])]) -> TempDir {
    let folder = TempDir::new().unwrap();
    for (name, bytes) in files {
        fs::write(folder.path().join(name), bytes).unwrap();
    }
    folder
}

fn replay(folder: &Path, arguments: &[&str]) -> (Value, String) {
    let run = touchdown(folder)
        .arg("replay")
        .args(arguments)
        .args(["--json", "-"])
        .assert()
        .success();
    let errors = String::from_utf8(run.get_output().stderr.clone()).unwrap();
    (
        serde_json::from_slice(&run.get_output().stdout).unwrap(),
        errors,
    )
}

/// The events of the drop as a stream.
fn expected() -> &'static Value {
    static EXPECTED: OnceLock<Value> = OnceLock::new();
    EXPECTED.get_or_init(|| {
        let folder = folder(&[("s.csv", stream().0.as_bytes())]);
        replay(folder.path(), &["s.csv", "--scene", "rig"]).0
    })
}

/// With a decimal comma.
fn comma(value: f64) -> String {
    value.to_string().replace('.', ",")
}

#[test]
fn every_style_of_text_gives_the_events_of_the_stream() {
    let latin_1 = |text: String| text.chars().map(|it| it as u32 as u8).collect::<Vec<u8>>();
    let mut german = "Messung 3;12.03.2024\r\nRate;20 kHz\r\n\r\nZeit;X1;Y1;X2;Y2\r\nms;\u{b5}m;mm;V;\u{b5}m\r\n".to_owned();
    let mut bracketed =
        "\u{feff}# a logger\n\"Time [s]\"\t\"X (mil)\"\tY / um\tBX_um\tBY, um\tspare\n".to_owned();
    let mut bare = String::new();
    let mut commented = "% by a script\n% x,y,u,v\n".to_owned();
    for row in rows() {
        let [t, ax, ay, bx, by] = row[..] else {
            panic!()
        };
        let volts = -10.0 - 7.87e-3 * bx;
        german += &format!(
            "{};{};{};{};{}\r\n",
            comma(t * 1e3),
            comma(ax),
            comma(ay * 1e-3),
            comma(volts),
            comma(-by)
        );
        bracketed += &format!("{t}\t{}\t{ay}\t{bx}\t{by}\t\n", ax / 25.4);
        bare += &format!("{ay},{ax},{by},{bx}\n");
        commented += &format!("{ax},{ay},{bx},{by}\n");
    }
    let german_map = "[time]\ncolumn = 'Zeit'\n[ax]\ncolumn = 'X1'\n[ay]\ncolumn = 'Y1'\n[bx]\ncolumn = 4\n\
        sensitivity = '-7.87 V/mm'\noffset = -10.0\n[by]\ncolumn = 'y2'\nreversed = true\n";
    let bracketed_map = "[time]\ncolumn = 'Time'\n[ax]\ncolumn = 'X'\n[ay]\ncolumn = 'Y'\n[bx]\n\
        column = 'BX_um'\n[by]\ncolumn = 'BY'\n";
    let um = |column: &str| format!("column = {column}\nunit = 'um'\n");
    let bare_map = ["ay", "ax", "by", "bx"].iter().zip(1..);
    let bare_map: String = bare_map
        .map(|(name, k)| format!("[{name}]\n{}", um(&k.to_string())))
        .collect();
    let named = ["ax", "ay", "bx", "by"].iter().zip(["x", "y", "u", "v"]);
    let named: String = named
        .map(|(name, it)| format!("[{name}]\n{}", um(&format!("'{it}'"))))
        .collect();
    let given = "[time]\nrate_hz = 20000\n";
    for (name, text, mapping, start) in [
        ("german", latin_1(german), german_map.to_owned(), 0.0),
        (
            "bracketed",
            bracketed.into_bytes(),
            bracketed_map.to_owned(),
            0.0,
        ),
        ("bare", bare.into_bytes(), given.to_owned() + &bare_map, 0.2),
        (
            "commented",
            commented.into_bytes(),
            given.to_owned() + &named,
            0.2,
        ),
    ] {
        let folder = folder(&[("r.txt", &text), ("map.toml", mapping.as_bytes())]);
        let run = ["r.txt", "--scene", "rig", "--columns", "map.toml"];
        let (found, errors) = replay(folder.path(), &run);
        assert_eq!(found["samples"], expected()["samples"], "{name}");
        assert!(!errors.contains("warning"), "{name}: {errors}");
        let events = |it: &Value| it["events"].as_array().unwrap().clone();
        let (found, wanted) = (events(&found), events(expected()));
        assert_eq!(found.len(), wanted.len(), "{name}");
        for (found, wanted) in found.iter().zip(&wanted) {
            // The same counts give the same bits; a recording without times begins at 0.
            assert_eq!(found["sample"], wanted["sample"], "{name}");
            assert_eq!(
                found["normal_speed_m_s"], wanted["normal_speed_m_s"],
                "{name}"
            );
            let late = found["onset_s"].as_f64().unwrap() - wanted["onset_s"].as_f64().unwrap();
            assert!((late - start).abs() < 1e-9, "{name}: {late}");
        }
    }
}

#[test]
fn speed_levitation_and_the_axes_of_the_sensors() {
    let scene = "[rotor]\nmass_kg = 3.42\nradius_mm = 24.0\nspeed_rpm = -30000.0\n[retainer]\nclearance_mm = 0.3\n\
        friction = 0.1\nrestitution = 0.8\n[run]\nduration_s = 0.1\n[sensors]\nmounting_deg = [45, 45]\nspeed = true\n\
        levitation_signal = true\n";
    let folder = folder(&[("m.toml", scene.as_bytes())]);
    let at = folder.path();
    touchdown(at)
        .args(["drop", "m.toml", "--stream", "s.csv"])
        .assert()
        .success();
    let (wanted, _) = replay(at, &["s.csv", "--scene", "m.toml"]);
    let text = fs::read_to_string(at.join("s.csv")).unwrap();
    let mut turned = "t_s,p_um,q_um,r_um,s_um,n,off\n".to_owned();
    for line in text.lines().skip(1) {
        let it: Vec<f64> = line.split(',').map(|it| it.parse().unwrap()).collect();
        // Sensors at 45 and 135 degrees.
        let along = |x: f64, y: f64| [(x + y) * 0.5_f64.sqrt(), (y - x) * 0.5_f64.sqrt()];
        let ([p, q], [r, s]) = (along(it[1], it[2]), along(it[3], it[4]));
        // Clockwise turns a second, and volts of a signal that is low while it floats.
        let (n, off) = (-it[5] / 60.0, 5.0 - 5.0 * it[6]);
        turned += &format!("{},{p},{q},{r},{s},{n},{off}\n", it[0]);
    }
    let mapping = "axes = 'sensors'\n[time]\ncolumn = 't'\n[ax]\ncolumn = 'p'\n[ay]\ncolumn = 'q'\n[bx]\ncolumn = 'r'\n\
        [by]\ncolumn = 's'\n[speed]\ncolumn = 'n'\nunit = 'Hz'\nreversed = true\n[levitated]\ncolumn = 'off'\nabove = 2.5\n\
        reversed = true\n";
    fs::write(at.join("r.csv"), turned).unwrap();
    fs::write(at.join("map.toml"), mapping).unwrap();
    let (found, errors) = replay(at, &["r.csv", "--scene", "m.toml", "--columns", "map.toml"]);
    assert_eq!(errors.matches("warning").count(), 0, "{errors}");
    assert_eq!(found["events"], wanted["events"]);
    assert!(found["events"].as_array().unwrap().len() > 5);
}

/// A configuration of the drop: four channels in counts of the sensors, and whether it floats.
fn cfg(kind: &str, year: &str, rates: &str) -> String {
    let channels = ["ax", "ay", "bx", "by"].iter().zip(1..);
    let channels: String = channels
        .map(|(name, k)| format!("{k},{name},,,um,{COUNT},0,0,-32767,32767,1,1,P\r\n"))
        .collect();
    let dates = "01/01/2024,23:59:59.900000\r\n02/01/2024,00:00:00.100000\r\n";
    format!(
        "station,device,{year}\r\n5,4A,1D\r\n{channels}1,on,,,0\r\n50\r\n{rates}{dates}{kind}\r\n1\r\n"
    )
}

fn rated() -> String {
    format!("1\r\n20000,{}\r\n", rows().len())
}

/// Number and stamp of a sample in us, then its counts.
fn counts() -> impl Iterator<Item = (u32, u32, [i16; 4])> {
    let whole = |it: &f64| (it / COUNT).round() as i16;
    rows().iter().zip(0_u32..).map(move |(row, k)| {
        let counts = [&row[1], &row[2], &row[3], &row[4]].map(whole);
        (k + 1, 50 * k, counts)
    })
}

fn binary(of_count: impl Fn(i16) -> Vec<u8>) -> Vec<u8> {
    let sample = |(number, stamp, counts): (u32, u32, [i16; 4])| {
        let mut bytes = [number.to_le_bytes(), stamp.to_le_bytes()].concat();
        bytes.extend(counts.into_iter().flat_map(&of_count));
        bytes.extend([0, 0]);
        bytes
    };
    counts().flat_map(sample).collect()
}

#[test]
fn comtrade_of_every_kind_gives_the_events_of_the_stream() {
    let ascii: String = counts()
        .map(|(number, stamp, [a, b, c, d])| format!("{number},{stamp},{a},{b},{c},{d},0\r\n"))
        .collect();
    let ended = [ascii.as_bytes(), &[0x1a]].concat();
    let short = binary(|it| it.to_le_bytes().to_vec());
    let long = binary(|it| i32::from(it).to_le_bytes().to_vec());
    let float = binary(|it| f32::from(it).to_le_bytes().to_vec());
    let by_stamps = cfg("ASCII", "1999", &format!("0\r\n0,{}\r\n", rows().len()));
    let combined = |kind: &str, data: &[u8]| {
        let cfg = cfg(kind, "2013", &rated());
        let head = format!(
            "--- file type: CFG ---\r\n{cfg}--- file type: INF ---\r\nx\r\n--- file type: HDR ---\r\n"
        );
        let data_head = format!("--- file type: DAT {kind}: {} ---\r\n", data.len());
        [head.as_bytes(), data_head.as_bytes(), data].concat()
    };
    let files: [(&str, Vec<u8>); 14] = [
        ("a.cfg", cfg("ASCII", "1999", &rated()).into()),
        ("a.dat", ascii.clone().into()),
        ("b.cfg", cfg("BINARY", "1999", &rated()).into()),
        ("b.dat", short),
        ("c.CFG", cfg("binary32", "2013", &rated()).into()),
        ("c.DAT", long),
        ("d.cfg", cfg("FLOAT32", "2013", &rated()).into()),
        ("d.dat", float.clone()),
        ("e.cff", combined("FLOAT32", &float)),
        ("f.CFF", combined("ASCII", ascii.as_bytes())),
        ("g.cfg", by_stamps.into()),
        ("g.dat", ascii.into()),
        ("h.cfg", cfg("ASCII", "2013", &rated()).into()),
        ("h.dat", ended),
    ];
    let files: Vec<(&str, &[u8])> = files.iter().map(|(name, it)| (*name, &it[..])).collect();
    let folder = folder(&files);
    for name in [
        "a.cfg", "a.dat", "b.cfg", "c.DAT", "d.cfg", "e.cff", "f.CFF", "g.cfg", "h.cfg",
    ] {
        let (found, errors) = replay(folder.path(), &[name, "--scene", "rig"]);
        assert!(!errors.contains("warning"), "{name}: {errors}");
        assert_eq!(found["samples"], expected()["samples"], "{name}");
        // Time 0 is the trigger, 0.2 s after the first sample, over midnight.
        assert_eq!(found["events"], expected()["events"], "{name}");
    }
}

#[test]
fn channels_of_comtrade_are_mapped_and_missing_values_are_none() {
    let names = cfg("ASCII", "1999", "1\r\n20000,2000\r\n")
        .replace(",ax,", ",X1,")
        .replace(",ay,", ",Y1,");
    let mut data = String::new();
    for (number, stamp, [a, b, ..]) in counts().take(2000) {
        let a = if number == 700 { 99_999 } else { i32::from(a) };
        data += &format!("{number},{stamp},{a},{b},0,0,1\r\n");
    }
    let mapping = "[ax]\ncolumn = 'X1'\n[ay]\ncolumn = 'Y1'\n[levitated]\ncolumn = 'on'\n";
    let folder = folder(&[
        ("r.cfg", names.as_bytes()),
        ("r.dat", data.as_bytes()),
        ("m.toml", mapping.as_bytes()),
    ]);
    touchdown(folder.path())
        .args(["replay", "r.cfg", "--scene", "rig"])
        .assert()
        .code(2)
        .stderr(contains("r.dat: no channels are named ax and ay: --columns says which they are; its columns are 1 \"X1\" in um"));
    let run = ["r.cfg", "--scene", "rig", "--columns", "m.toml"];
    let (found, errors) = replay(folder.path(), &run);
    assert_eq!(
        (found["samples"].as_u64(), found["faults"].as_u64()),
        (Some(2000), Some(1))
    );
    assert!(errors.contains("it has plane a alone"), "{errors}");
}

/// The stream with each row's time changed, or the row left out.
fn retimed(time: impl Fn(usize, f64) -> Option<f64>) -> String {
    let mut text = "time_s,ax_um,ay_um,bx_um,by_um\n".to_owned();
    for (index, row) in rows().iter().enumerate() {
        if let Some(time) = time(index, row[0]) {
            text += &format!("{time:.9},{},{},{},{}\n", row[1], row[2], row[3], row[4]);
        }
    }
    text
}

#[test]
fn uneven_rows_are_told_and_resampled_only_when_asked() {
    // Up to 7 us late in every second row, and 60 rows missing at 0.05 s before the release.
    let late = |index: usize| {
        let random = (index as f64 * 12.9898).sin() * 43_758.545;
        7e-6 * random.fract().abs() * (index % 2) as f64
    };
    let uneven =
        retimed(|index, time| (!(3000..3060).contains(&index)).then_some(time + late(index)));
    let folder = folder(&[("u.csv", uneven.as_bytes())]);
    let error = touchdown(folder.path())
        .args(["replay", "u.csv", "--scene", "rig"])
        .assert()
        .code(2);
    let error = String::from_utf8(error.get_output().stderr.clone()).unwrap();
    for part in [
        "the sample rate is not constant",
        "found in its 9941 rows",
        "1 gap (line 3002)",
        "jitter ",
        "--resample 20000 makes it even",
    ] {
        assert!(error.contains(part), "{part}: {error}");
    }
    let run = ["u.csv", "--scene", "rig", "--resample", "20000"];
    let (found, errors) = replay(folder.path(), &run);
    assert!(
        errors.contains("resampled, linear between neighbours, from 9941 rows"),
        "{errors}"
    );
    assert!(
        errors.contains("to 10001 samples at 20000 Hz, 60 of them without a value; 1 gaps"),
        "{errors}"
    );
    assert_eq!(found["samples"], 10001);
    // The gap is no data; the fall is where it was, within the jitter and what noise it makes.
    let fall = |it: &Value| {
        let mut events = it["events"].as_array().unwrap().iter();
        let fall = events.find(|it| it["event"] == "free_fall" && !it["confirmed_s"].is_null());
        fall.unwrap()["onset_s"].as_f64().unwrap()
    };
    assert!(found["faults"].as_u64() >= Some(4 * 60));
    assert!((fall(&found) - fall(expected())).abs() < 2e-4);
}

#[test]
fn resampling_to_the_rate_that_there_is_changes_nothing() {
    let folder = folder(&[("s.csv", stream().0.as_bytes())]);
    let (found, errors) = replay(
        folder.path(),
        &["s.csv", "--scene", "rig", "--resample", "20000"],
    );
    assert!(errors.contains("0 of them without a value"), "{errors}");
    assert_eq!(found["events"], expected()["events"]);
}

#[test]
fn wrong_rates_and_coarse_stamps_get_advice() {
    let slow = retimed(|_, time| Some(time * 1e3));
    let coarse = retimed(|_, time| Some((time * 1e3).floor() * 1e-3));
    let fast = retimed(|_, time| Some(time * 1e-2));
    let folder = folder(&[
        ("slow", slow.as_bytes()),
        ("coarse", coarse.as_bytes()),
        ("fast", fast.as_bytes()),
    ]);
    for (name, message) in [
        (
            "slow",
            "slow:3: the sample rate must be 100 to 200000 Hz, is 20 Hz",
        ),
        (
            "fast",
            "fast:3: the sample rate must be 100 to 200000 Hz, is 2000000 Hz",
        ),
        (
            "coarse",
            "needs the rate itself: rate_hz in the [time] of --columns",
        ),
    ] {
        let run = ["replay", name, "--scene", "rig"];
        touchdown(folder.path())
            .args(run)
            .assert()
            .code(2)
            .stderr(contains(message));
    }
}

#[test]
fn doubtful_units_signs_and_ends_are_told() {
    let mut text = "t,x,y,n\n".to_owned();
    for row in rows() {
        text += &format!("{},{},{},500\n", row[0], row[1], row[2]);
    }
    text += "0.30005,1,";
    let mapping = |unit: &str, speed: &str| {
        format!(
            "[time]\ncolumn = 't'\nunit = 's'\n[ax]\ncolumn = 'x'\nunit = '{unit}'\n[ay]\ncolumn = 'y'\nunit = '{unit}'\n\
             [speed]\ncolumn = 'n'\nunit = '{speed}'\n"
        )
    };
    let folder = folder(&[
        ("r.csv", text.as_bytes()),
        ("mm.toml", mapping("mm", "Hz").as_bytes()),
        ("nm.toml", mapping("nm", "rpm").as_bytes()),
    ]);
    let warnings = |map: &str| {
        replay(
            folder.path(),
            &["r.csv", "--scene", "rig", "--columns", map],
        )
        .1
    };
    let mm = warnings("mm.toml");
    for part in [
        "of the clearance of 300 um: are unit and offset right? (um taken for mm?)",
        "beyond the sensors' range of 1000 um",
        "is its sign right?",
        "r.csv:10003: the last line is left out",
    ] {
        assert!(mm.contains(part), "{part}: {mm}");
    }
    let nm = warnings("nm.toml");
    assert!(
        nm.contains("the speed is 0.0167 of the scene's: Hz taken for rpm?"),
        "{nm}"
    );
    assert!(nm.contains("are unit and offset right?"), "{nm}");
}

fn compare(folder: &Path, arguments: &[&str], status: i32) -> Value {
    let run = touchdown(folder)
        .args(["compare", "--scene", "rig", "--json", "-"])
        .args(arguments)
        .assert()
        .code(status);
    serde_json::from_slice(&run.get_output().stdout).unwrap()
}

#[test]
fn two_recordings_are_aligned_and_their_differences_judged() {
    let at = folder(&[("a.csv", stream().0.as_bytes())]);
    let at = at.path();
    // The same drop 1.234567 s later, a fifth of it thinned out of the grid by resampling.
    fs::write(
        at.join("late.csv"),
        retimed(|_, time| Some(time + 1.234_567)),
    )
    .unwrap();
    let late = compare(at, &["a.csv", "late.csv", "--report", "c.html"], 0);
    assert_eq!(late["aligned_by"], "free_fall");
    assert!(
        (late["shift_s"].as_f64().unwrap() - 1.234_567).abs() < 1e-6,
        "{}",
        late["shift_s"]
    );
    assert_eq!(late["beyond"], 0);
    assert!(late["waveform_rms_m"][1].as_f64().unwrap() < 1e-8);
    assert!(
        fs::read_to_string(at.join("c.html"))
            .unwrap()
            .contains("<svg")
    );

    // Other noise is no difference; other restitution is.
    let scene = |restitution: f64, seed: u64| {
        format!(
            "[rotor]\nmass_kg = 3.42\nradius_mm = 24.0\nspeed_rpm = -30000.0\n[retainer]\nclearance_mm = 0.3\nfriction = 0.1\n\
             restitution = {restitution}\n[start]\nx_mm = 0.02\n[run]\nduration_s = 0.3\nsample_rate_hz = 50000\nseed = {seed}\n"
        )
    };
    for (name, text) in [
        ("one", scene(0.8, 1)),
        ("noise", scene(0.8, 2)),
        ("dull", scene(0.7, 1)),
    ] {
        let file = format!("{name}.toml");
        fs::write(at.join(&file), text).unwrap();
        let run = ["drop", &file, "--stream", &format!("{name}.csv")];
        touchdown(at).args(run).assert().success();
    }
    let noise = compare(at, &["one.csv", "noise.csv"], 0);
    // 1 um of noise on 4 channels over the fall: a few us.
    assert!(
        noise["shift_s"].as_f64().unwrap().abs() < 50e-6,
        "{}",
        noise["shift_s"]
    );
    let dull = compare(at, &["one.csv", "dull.csv"], 1);
    let impacts = |it: &Value| -> Vec<Value> {
        let events = it["events"].as_array().unwrap().iter();
        events
            .filter(|it| it["event"] == "impact")
            .cloned()
            .collect()
    };
    let first = &impacts(&dull)[0];
    assert_eq!(first["within"], true, "the fall is the same: {first}");
    // The second flight is 7/8 as long: 1.55 ms earlier, and 12 % slower into the wall.
    let second = &impacts(&dull)[1];
    assert_eq!(second["within"], false, "{second}");
    assert!(
        (second["difference_s"].as_f64().unwrap() + 1.55e-3).abs() < 0.1e-3,
        "{second}"
    );
    // Wide enough, all but what only one of them has.
    let wide = compare(
        at,
        &[
            "one.csv",
            "dull.csv",
            "--within-ms",
            "100",
            "--within-percent",
            "50",
        ],
        1,
    );
    assert!(wide["beyond"].as_u64() < dull["beyond"].as_u64());
}

/// The blocks of docs/use/recordings.md: `text NAME` is a file, `console` what is run.
#[test]
fn the_examples_of_the_manual_run() {
    let manual = Path::new(env!("CARGO_MANIFEST_DIR")).join("../docs/use/recordings.md");
    let manual = fs::read_to_string(manual).unwrap();
    let at = TempDir::new().unwrap();
    let (mut files, mut runs) = (0, 0);
    for block in manual.split("\n```").skip(1).step_by(2) {
        let (head, text) = block.split_once('\n').unwrap();
        match head.split_once(' ') {
            Some((_, name)) => {
                files += 1;
                fs::write(at.path().join(name), format!("{text}\n")).unwrap();
            }
            None => {
                for line in text.lines().filter_map(|it| it.strip_prefix("touchdown ")) {
                    runs += 1;
                    let run = touchdown(at.path()).args(line.split_whitespace()).assert();
                    let output = run.get_output();
                    assert_ne!(output.status.code(), Some(2), "{line}: {output:?}");
                }
            }
        }
    }
    assert!(files >= 6 && runs >= 6, "{files} files, {runs} runs");
}
