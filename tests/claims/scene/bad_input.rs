//! Every bad input ends with status 2, a message with file, line and rule, and nothing half-written.

use std::fs;

use predicates::prelude::*;
use predicates::str::contains;
use tempfile::TempDir;
use touchdown_tests::binary::touchdown;
use touchdown_tests::minimal_scene::SCENE;

/// No number is shown as a row of zeros.
fn is_short(said: &[u8]) -> bool {
    let mut runs = said.split(|it| !it.is_ascii_digit());
    runs.all(|digits| digits.len() < 25)
}

/// Drops the scene `text`, which must fail with `message` and leave nothing but the scene.
fn refuse(text: impl AsRef<[u8]>, message: &str) {
    let folder = TempDir::new().unwrap();
    fs::write(folder.path().join("scene.toml"), text).unwrap();
    let refused = touchdown(folder.path())
        .args([
            "drop",
            "scene.toml",
            "--json",
            "a.json",
            "--report",
            "a.html",
            "--stream",
            "a.csv",
        ])
        .assert()
        .code(2)
        .stdout("")
        .stderr(contains(message));
    assert!(is_short(&refused.get_output().stderr), "{refused}");
    assert_eq!(names(&folder), ["scene.toml"], "{message}");
}

fn names(folder: &TempDir) -> Vec<String> {
    let mut names: Vec<_> = fs::read_dir(folder.path())
        .unwrap()
        .map(|entry| entry.unwrap().file_name().into_string().unwrap())
        .collect();
    names.sort();
    names
}

#[test]
fn impossible_values_name_line_and_rule() {
    for (line, with, message) in [
        (
            2,
            "mass_kg = 0",
            "scene.toml:2: mass_kg must be above 0, is 0",
        ),
        (
            2,
            "mass_kg = -1",
            "scene.toml:2: mass_kg must be above 0, is -1",
        ),
        (
            3,
            "radius_mm = -24",
            "scene.toml:3: radius_mm must be above 0",
        ),
        (
            6,
            "clearance_mm = 0",
            "scene.toml:6: clearance_mm must be above 0",
        ),
        (
            7,
            "friction = -0.1",
            "scene.toml:7: friction must be 0 or more, is -0.1",
        ),
        (
            8,
            "restitution = 1.1",
            "scene.toml:8: restitution must be 0 to 1, is 1.1",
        ),
        (
            8,
            "restitution = -0.1",
            "scene.toml:8: restitution must be 0 to 1",
        ),
        (
            10,
            "duration_s = 0",
            "scene.toml:10: duration_s must be above 0",
        ),
        (
            10,
            "duration_s = -1",
            "scene.toml:10: duration_s must be above 0",
        ),
        (
            10,
            "duration_s = 86401",
            "scene.toml:10: duration_s must be no more than 86400",
        ),
        (
            2,
            "mass_kg = nan",
            "scene.toml:2: mass_kg must be a finite number",
        ),
        (
            4,
            "speed_rpm = inf",
            "scene.toml:4: speed_rpm must be a finite number",
        ),
        (
            4,
            "speed_rpm = -inf",
            "scene.toml:4: speed_rpm must be a finite number",
        ),
        (4, "speed_rpm = 1e999", "scene.toml:4: "),
        (2, "mass_kg = 1e-300", "scene.toml:2: mass_kg must be"),
        (
            3,
            "radius_mm = 1e300",
            "scene.toml:3: radius_mm must be 0.01 to 100000, is 1e300\n",
        ),
        (4, "speed_rpm = -1e300", "scene.toml:4: speed_rpm must be"),
        (
            8,
            "restitution = 1e300",
            "scene.toml:8: restitution must be 0 to 1, is 1e300\n",
        ),
        (
            10,
            "duration_s = 1e300",
            "scene.toml:10: duration_s must be no more than 86400, is 1e300\n",
        ),
        (
            6,
            "clearance_mm = 1e-300",
            "scene.toml:6: clearance_mm must be",
        ),
        (7, "friction = 1e300", "scene.toml:7: friction must be"),
    ] {
        refuse(replaced(line, with), message);
    }
}

/// Every list of a scene takes as many numbers as it has to, no fewer and no more.
#[test]
fn lists_have_a_length() {
    for (table, key, length) in [
        ("[sensors]", "mounting_deg", 2),
        ("[sensors]", "offset_um", 4),
        ("[sensors]", "gain_error_percent", 4),
        ("[two_plane]", "tilt_mrad", 2),
        ("[two_plane]", "tilt_rate_rad_s", 2),
        ("[two_plane]", "sensor_z_mm", 2),
        ("[[magnet]]\nz_mm = 0", "force_n", 2),
    ] {
        let line = SCENE.lines().count() + table.lines().count() + 1;
        for there in (0..length + 3).filter(|it| *it != length) {
            let list = vec!["0.5"; there].join(", ");
            refuse(
                format!("{SCENE}{table}\n{key} = [{list}]\n"),
                &format!("scene.toml:{line}: the list must have {length} numbers, has {there}"),
            );
        }
    }
}

/// The scene with line `line`, counted from 1, replaced.
fn replaced(line: usize, with: &str) -> String {
    let mut lines: Vec<_> = SCENE.lines().collect();
    lines[line - 1] = with;
    lines.join("\n")
}

#[test]
fn optional_keys_are_checked_too() {
    for (table, message) in [
        (
            "gravity_m_s2 = -1",
            "scene.toml:11: gravity_m_s2 must be 0 or more, is -1",
        ),
        (
            "gravity_m_s2 = 5e-324",
            "scene.toml:11: gravity_m_s2 must be 0, or 0.000001 or more",
        ),
        (
            "sample_rate_hz = 99",
            "scene.toml:11: sample_rate_hz must be 100 to 200000, is 99",
        ),
        (
            "sample_rate_hz = 200001",
            "scene.toml:11: sample_rate_hz must be 100 to 200000",
        ),
        (
            "sample_rate_hz = 0",
            "scene.toml:11: sample_rate_hz must be 100 to 200000",
        ),
        ("seed = -1", "scene.toml:11: "),
        (
            "[model]\nstep_us = 0.5",
            "scene.toml:12: step_us must be 1 to 1000, is 0.5",
        ),
        (
            "[model]\nstep_us = 1001",
            "scene.toml:12: step_us must be 1 to 1000",
        ),
        (
            "[model]\nstep_us = 0",
            "scene.toml:12: step_us must be 1 to 1000",
        ),
        (
            "[model]\nrung = \"soft\"",
            "scene.toml:12: rung must be \"rigid\" or \"moreau\" or \"hertz\" or \"support\" or \"two-plane\" or \"coupled\", is \"soft\"",
        ),
        (
            "[model]\nrung = \"moreau\"\nscheme = \"verlet\"",
            "scene.toml:13: scheme must be \"midpoint\", is \"verlet\"",
        ),
        (
            "[model]\nrung = \"hertz\"\nstep_us = 200",
            "scene.toml:13: step_us must be no more than 128.0407, the limit of stability 2/omega_c",
        ),
        (
            "[model]\ncutoff_mm_s = -0.1",
            "scene.toml:12: cutoff_mm_s must be 0 to 1, is -0.1",
        ),
        (
            "[model]\nrung = \"moreau\"\ncutoff_mm_s = 0.1",
            "scene.toml:13: cutoff_mm_s is that of rung = \"rigid\"",
        ),
        (
            "[materials]\ncontact = \"line\"",
            "scene.toml:12: contact = \"line\" needs length_mm",
        ),
        (
            "[materials]\nlength_mm = 20",
            "scene.toml:12: length_mm is that of contact = \"line\"",
        ),
        (
            "[materials]\ncontact = \"plane\"",
            "scene.toml:12: contact must be \"point\" or \"line\" or \"line-power\", is \"plane\"",
        ),
        (
            "[materials]\nrotor_modulus_gpa = 0",
            "scene.toml:12: rotor_modulus_gpa must be above 0",
        ),
        (
            "[materials]\nretainer_poisson = 0.6",
            "scene.toml:12: retainer_poisson must be 0 to 0.5",
        ),
        (
            "[model]\nrung = \"hertz\"\n[materials]\ncontact = \"line\"\nlength_mm = 0.01\nrotor_modulus_gpa = 0.001",
            "scene.toml:15: length_mm must be long enough",
        ),
        (
            "[model]\nprecision = \"f16\"",
            "scene.toml:12: precision must be \"f32\" or \"f64\"",
        ),
        (
            "[model]\nmath = \"cordic\"",
            "scene.toml:12: math must be \"libm\" or \"polynomial\" or \"micromath\", is \"cordic\"",
        ),
        (
            "[model]\nmath = \"polynomial\"",
            "scene.toml:12: math = \"polynomial\" is not in rung = \"rigid\" in f64",
        ),
        ("[sensors]\nbits = 3", "scene.toml:12: bits must be 4 to 16"),
        (
            "[sensors]\nbits = 17",
            "scene.toml:12: bits must be 4 to 16",
        ),
        (
            "[sensors]\nrange_um = 0",
            "scene.toml:12: range_um must be above 0",
        ),
        (
            "[sensors]\nnoise_um = -1",
            "scene.toml:12: noise_um must be 0 or more",
        ),
        (
            "[sensors]\nplanes = 3",
            "scene.toml:12: planes must be 1 or 2",
        ),
        (
            "[sensors]\nbandwidth_hz = 0",
            "scene.toml:12: bandwidth_hz must be above 0",
        ),
        (
            "[sensors]\noffset_um = [0, 0, nan, 0]",
            "scene.toml:12: offset_um must be a finite",
        ),
        (
            "[detector]\nfalse_alarm = nan",
            "scene.toml:12: false_alarm must be a finite number",
        ),
        (
            "[start]\nx_mm = 0.2\ny_mm = -0.25",
            "scene.toml:13: the start is outside the gap",
        ),
        ("[start]\nvx_mm_s = 1e300", "scene.toml:12: vx_mm_s must be"),
        (
            "[start]\ntangential_mm_s = 1e300",
            "scene.toml:12: tangential_mm_s must be",
        ),
        (
            "[start]\nx_mm = 0.31",
            "scene.toml:12: the start is outside the gap: 0.31 mm",
        ),
        (
            "[start]\nangle_deg = 0\nvx_mm_s = 1",
            "scene.toml:12: angle_deg starts the rotor on",
        ),
    ] {
        refuse(format!("{SCENE}{table}\n"), message);
    }
    let inertia = SCENE.replacen("[retainer]", "polar_inertia_kg_m2 = 0\n[retainer]", 1);
    refuse(inertia, "scene.toml:5: polar_inertia_kg_m2 must be above 0");
}

#[test]
fn the_form_of_the_file_is_checked() {
    refuse(
        replaced(7, "friktion = 0.1"),
        "scene.toml:7: unknown key `friktion`",
    );
    refuse(
        replaced(4, ""),
        "scene.toml:1: missing required key `speed_rpm`",
    );
    refuse(
        replaced(10, ""),
        "scene.toml:9: missing required key `duration_s`",
    );
    refuse(
        replaced(7, "friction = \"low\""),
        "scene.toml:7: invalid type: string \"low\"",
    );
    refuse(replaced(7, "friction = 0.1 0.2"), "scene.toml:7: ");
    refuse(
        replaced(7, "mass_kg = 1\nmass_kg = 2"),
        "scene.toml:8: duplicate key",
    );
    refuse(
        format!("{SCENE}[detektor]\n"),
        "scene.toml:11: unknown key `detektor`",
    );
    refuse(
        format!("{SCENE}[detector]\nfast = true\n"),
        "scene.toml:12: unknown key `fast`",
    );
    refuse("", "scene.toml:1: missing required key `rotor`");
    let mut latin1 = format!("{SCENE}# gr").into_bytes();
    latin1.extend(b"\xf6sser\n");
    refuse(latin1, "scene.toml:11: the text is not UTF-8");
}

#[test]
fn files_that_cannot_be_read() {
    let folder = TempDir::new().unwrap();
    for (scene, message) in [
        (
            "none.toml",
            "none.toml: no such file, and no built-in scene of this name; built in: rig,",
        ),
        (".", ".: is a folder, not a file"),
    ] {
        touchdown(folder.path())
            .args(["drop", scene])
            .assert()
            .code(2)
            .stderr(contains(message));
    }
    for (stream, message) in [
        ("none.csv", "none.csv: no such file"),
        (".", ".: is a folder, not a file"),
    ] {
        touchdown(folder.path())
            .args(["replay", stream, "--scene", "rig"])
            .assert()
            .code(2)
            .stderr(contains(message));
    }
}

#[test]
fn outputs_that_cannot_be_written() {
    let folder = TempDir::new().unwrap();
    fs::write(folder.path().join("old.json"), "old").unwrap();
    for (arguments, message) in [
        (
            &["--json", "none/a.json"][..],
            "none/a.json: cannot be written: no such file",
        ),
        (
            &["--json", "."],
            ".: cannot be written: is a folder, not a file",
        ),
        (
            &["--json", "-", "--stream", "-"],
            "two outputs go to standard output",
        ),
        (
            &["--json", "a", "--stream", "a"],
            "each output needs a file of its own",
        ),
        (
            &["--json", "old.json", "--report", "none/a.html"],
            "none/a.html: cannot be written",
        ),
        (&["--image", "x"], "--image needs --on qemu"),
        (
            &["--on", "qemu", "--image", "x"],
            "x: no firmware image here; `cargo xtask firmware`",
        ),
        (&["--on", "moon"], "invalid value 'moon'"),
        (&["--fast"], "unexpected argument '--fast'"),
    ] {
        touchdown(folder.path())
            .args(["drop", "rig"])
            .args(arguments)
            .assert()
            .code(2)
            .stderr(contains(message));
        assert_eq!(names(&folder), ["old.json"], "{arguments:?}");
    }
    assert_eq!(
        fs::read_to_string(folder.path().join("old.json")).unwrap(),
        "old"
    );
}

/// Replays the stream `text`, which must fail with `message`.
fn refuse_stream(text: impl AsRef<[u8]>, message: &str) {
    let folder = TempDir::new().unwrap();
    fs::write(folder.path().join("s.csv"), text).unwrap();
    touchdown(folder.path())
        .args([
            "replay", "s.csv", "--scene", "rig", "--json", "a.json", "--report", "a.html",
        ])
        .assert()
        .code(2)
        .stdout("")
        .stderr(contains(message));
    assert_eq!(names(&folder), ["s.csv"], "{message}");
}

fn rows(stamps: &[&str]) -> String {
    let rows = stamps.iter().map(|stamp| format!("{stamp},1,2\n"));
    format!("time_s,ax_um,ay_um\n{}", rows.collect::<String>())
}

#[test]
fn streams_name_line_and_rule() {
    let header = "time_s,ax_um,ay_um\n";
    let row = "0,1,2\n0.001,1,2\n";
    refuse_stream("", "s.csv:1: the header must be time_s,ax_um,ay_um");
    refuse_stream("t,x,y\n0,1,2\n", "s.csv:1: the header must be time_s,ax_um");
    refuse_stream("time_s,ax_um\n0,1\n", "s.csv:1: the header must be");
    refuse_stream("time_s,ay_um,ax_um\n0,1,2\n", "s.csv:1: the header must be");
    refuse_stream(
        "time_s,ax_um,ay_um,bx_um\n0,1,2,3\n",
        "s.csv:1: the header must be",
    );
    refuse_stream(header, "s.csv:1: there are no rows after the header");
    refuse_stream(rows(&["0"]), "s.csv:2: one row alone has no sample rate");
    refuse_stream(
        format!("{header}{row}0.002,one,2\n"),
        "s.csv:4: ax_um must be a finite number",
    );
    refuse_stream(
        format!("{header}{row}0.002,1,inf\n"),
        "s.csv:4: ay_um must be a finite number",
    );
    refuse_stream(
        format!("{header}{row}nan,1,2\n"),
        "s.csv:4: time_s must be a finite number",
    );
    refuse_stream(
        format!("{header}{row},1,2\n"),
        "s.csv:4: time_s must be a finite number, is \"\"",
    );
    refuse_stream(
        format!("{header}{row}0.002,1\n"),
        "s.csv:4: a row needs 3 fields, this one has 2",
    );
    refuse_stream(
        format!("{header}{row}0.002,1,2,3\n"),
        "s.csv:4: a row needs 3 fields, this",
    );
    refuse_stream(
        format!("{header}{row}0.002,1"),
        "s.csv:4: a row needs 3 fields, this one has 2",
    );
    refuse_stream(
        format!("{header}{row}0.002,1,2"),
        "s.csv:4: the last line is cut off",
    );
    refuse_stream(
        rows(&["0", "0.001", "0.0015"]),
        "s.csv:4: the sample rate is not constant",
    );
    refuse_stream(
        rows(&["0", "0.001", "0.003"]),
        "s.csv:4: the sample rate is not constant",
    );
    refuse_stream(
        rows(&["0", "0.001", "0.0005"]),
        "s.csv:4: time_s must increase",
    );
    refuse_stream(
        rows(&["0", "0.001", "0.001"]),
        "s.csv:4: time_s must increase",
    );
    refuse_stream(
        rows(&["0", "1", "2"]),
        "s.csv:3: the sample rate must be 100 to 200000 Hz",
    );
    refuse_stream(
        b"time_s,ax_um,ay_um\n0,\xff,1\n",
        "s.csv:2: the text is not UTF-8",
    );
    let levitated = "time_s,ax_um,ay_um,levitated\n0,1,2,yes\n";
    refuse_stream(
        levitated,
        "s.csv:2: levitated must be 0, 1, empty or NaN, is \"yes\"",
    );
    let mut late: String = (0..10_000)
        .map(|k| format!("{},1,2\n", f64::from(k) / 1e3))
        .collect();
    late += "10,one,2\n";
    refuse_stream(
        format!("{header}{late}"),
        "s.csv:10002: ax_um must be a finite number",
    );
}

/// What a recording leaves empty is missing, as NaN is, in every column but that of time.
#[test]
fn empty_cells_are_missing_values() {
    let folder = TempDir::new().unwrap();
    let header = "time_s,ax_um,ay_um,bx_um,by_um,speed_rpm,levitated,inner_ring_edges,inner_ring_edge_age_us";
    let width = header.split(',').count();
    for column in 1..width {
        let stream = |missing: &str| {
            let rows = (0..400).map(|row| {
                let mut cells = vec!["1"; width];
                let time = f64::from(row) / 1e3;
                let time = time.to_string();
                cells[0] = &time;
                if row % 7 == 3 {
                    cells[column] = missing;
                }
                cells.join(",") + "\n"
            });
            format!("{header}\n{}", rows.collect::<String>())
        };
        let answers = ["", "NaN"].map(|missing| {
            fs::write(folder.path().join("s.csv"), stream(missing)).unwrap();
            let replayed = touchdown(folder.path())
                .args(["replay", "s.csv", "--scene", "rig", "--json", "-"])
                .assert()
                .code(0);
            replayed.get_output().stdout.clone()
        });
        assert_eq!(answers[0], answers[1], "column {column}");
    }
}

#[test]
fn a_recording_of_immense_numbers_is_told_in_short_ones() {
    let folder = TempDir::new().unwrap();
    let rows = (0..400).map(|row| format!("{},1e300,-1e300,1e300\n", f64::from(row) / 1e3));
    let stream = format!("time_s,ax_um,ay_um,speed_rpm\n{}", rows.collect::<String>());
    fs::write(folder.path().join("s.csv"), stream).unwrap();
    let replayed = touchdown(folder.path())
        .args(["replay", "s.csv", "--scene", "rig"])
        .assert()
        .code(0)
        .stderr(contains("are unit and offset right?"));
    let said = replayed.get_output();
    assert!(
        is_short(&said.stderr) && is_short(&said.stdout),
        "{replayed}"
    );
    refuse_stream(
        "time_s,ax_um,ay_um\n0,1,2\n1e300,1,2\n",
        "s.csv:3: the sample rate must be 100 to 200000 Hz, is 1e-300 Hz",
    );
}

#[test]
fn bad_usage_is_status_2() {
    let folder = TempDir::new().unwrap();
    for arguments in [
        &["fly"][..],
        &["replay"],
        &["replay", "s.csv"],
        &["scene"],
        &["drop", "a", "b"],
    ] {
        touchdown(folder.path())
            .args(arguments)
            .assert()
            .code(2)
            .stderr(contains("Usage").or(contains("usage")));
    }
}
