//! Every bad value of a machine's parts (support, ball bearing, rings, magnets) is an error with file, line and rule.

use std::fs;

use predicates::str::contains;
use tempfile::TempDir;
use touchdown_tests::binary::touchdown;
use touchdown_tests::minimal_scene::SCENE as MACHINE;

const GIVES_WAY: &str = "\
[support]
mass_kg = 0.5
stiffness_n_m = 1e6
damping_n_s_m = 100
travel_mm = 0.2
stop_stiffness_n_m = 1e7
vertical_stiffness_n_m = 2e6
vertical_damping_n_s_m = 50
dry_friction_n = 5
[ball_bearing]
inner_ring_inertia_kg_m2 = 3e-5
dry_drag_n_m = 0.01
viscous_drag_n_m_s = 1e-5
cage_ratio = 0.4
heat_capacity_j_k = 50
heat_loss_w_k = 0.5
inner_ring_marks = 4
cage_marks = 12
";

const TILTS: &str = "\
[two_plane]
transverse_inertia_kg_m2 = 0.03
unbalance_g_mm = 2.7
unbalance_deg = 10
skew_mrad = 0.01
skew_deg = 20
elastic_mode_hz = 1520
tilt_mrad = [0.1, 0.1]
tilt_rate_rad_s = [0, 0]
gravity_deg = 30
sensor_z_mm = [-100, 100]
[[ring]]
z_mm = -120
[[ring]]
name = \"right\"
z_mm = 120
radius_mm = 20
clearance_mm = 0.4
friction = 0.2
restitution = 0.5
[[magnet]]
z_mm = 80
stiffness_n_m = 1e5
force_n = [1, 2]
";

/// What `touchdown scene explain` says to `text`: status and standard error.
fn explain(text: &str) -> assert_cmd::assert::Assert {
    let folder = TempDir::new().unwrap();
    fs::write(folder.path().join("scene.toml"), text).unwrap();
    touchdown(folder.path())
        .args(["scene", "explain", "scene.toml"])
        .assert()
}

/// `parts` with the value of `key` in its table `table` replaced: refused at that line with `rule`.
fn refuse(parts: &str, table: &str, key: &str, value: &str, rule: &str) {
    let whole = format!("{MACHINE}{parts}");
    let head = whole.find(&format!("[{table}]")).expect(table);
    let place = head + 1 + whole[head..].find(&format!("\n{key} =")).expect(key);
    let end = place + whole[place..].find('\n').unwrap();
    let text = format!("{}{key} = {value}{}", &whole[..place], &whole[end..]);
    let line = 1 + whole[..place].matches('\n').count();
    explain(&text)
        .code(2)
        .stdout("")
        .stderr(contains(format!("scene.toml:{line}: {rule}")));
}

#[test]
fn the_good_values_are_taken() {
    explain(&format!("{MACHINE}{GIVES_WAY}"))
        .success()
        .stdout(contains("6: x, y, spin; ring x, y; inner ring's spin"));
    explain(&format!("{MACHINE}{TILTS}"))
        .success()
        .stdout(contains("5: x, y, two tilts, spin"));
}

#[test]
fn the_coarsest_functions_are_those_of_the_plane() {
    let parts = format!("[model]\nprecision = \"f32\"\nmath = \"libm\"\n{GIVES_WAY}");
    let rule = "math = \"micromath\" is not in rung = \"support\" in f32";
    refuse(&parts, "model", "math", "\"micromath\"", rule);
}

#[test]
fn a_support_is_checked() {
    for (key, value, rule) in [
        ("mass_kg", "0", "mass_kg must be above 0, is 0"),
        ("mass_kg", "1e9", "mass_kg must be 0.000001 to 1000000"),
        ("stiffness_n_m", "-1", "stiffness_n_m must be above 0"),
        ("stiffness_n_m", "1e13", "stiffness_n_m must be 1 to"),
        (
            "stiffness_n_m",
            "nan",
            "stiffness_n_m must be a finite number",
        ),
        ("damping_n_s_m", "-1", "damping_n_s_m must be 0 or more"),
        ("damping_n_s_m", "1e10", "damping_n_s_m must be 0 to"),
        ("travel_mm", "0", "travel_mm must be above 0"),
        ("travel_mm", "1e3", "travel_mm must be 0.001 to 100"),
        ("stop_stiffness_n_m", "0", "stop_stiffness_n_m must be above 0"),
        ("stop_stiffness_n_m", "1e13", "stop_stiffness_n_m must be 1 to"),
        ("vertical_stiffness_n_m", "0", "vertical_stiffness_n_m must be above 0"),
        ("vertical_damping_n_s_m", "1e10", "vertical_damping_n_s_m must be 0 to"),
        ("dry_friction_n", "-1", "dry_friction_n must be 0 to"),
    ] {
        refuse(GIVES_WAY, "support", key, value, rule);
        // A key along y that is not given is not named.
        let along_x = GIVES_WAY.replace("vertical_stiffness_n_m = 2e6\nvertical_damping_n_s_m = 50\n", "");
        if !key.starts_with("vertical") {
            refuse(&along_x, "support", key, value, rule);
        }
    }
}

#[test]
fn a_stop_that_gives_way_needs_a_place() {
    let text = GIVES_WAY.replace("travel_mm = 0.2\n", "");
    refuse(&text, "support", "stop_stiffness_n_m", "1e7", "stop_stiffness_n_m needs travel_mm");
}

#[test]
fn a_ball_bearing_is_checked() {
    for (key, value, rule) in [
        (
            "inner_ring_inertia_kg_m2",
            "0",
            "inner_ring_inertia_kg_m2 must be above 0",
        ),
        (
            "inner_ring_inertia_kg_m2",
            "1e9",
            "inner_ring_inertia_kg_m2 must be",
        ),
        ("dry_drag_n_m", "-1", "dry_drag_n_m must be 0 or more"),
        (
            "viscous_drag_n_m_s",
            "-1",
            "viscous_drag_n_m_s must be 0 or more",
        ),
        (
            "viscous_drag_n_m_s",
            "inf",
            "viscous_drag_n_m_s must be a finite number",
        ),
        (
            "cage_ratio",
            "0.6",
            "cage_ratio must be 0.05 to 0.49, is 0.6",
        ),
        (
            "heat_capacity_j_k",
            "0",
            "heat_capacity_j_k must be above 0",
        ),
        ("heat_loss_w_k", "-0.1", "heat_loss_w_k must be 0 or more"),
        (
            "inner_ring_marks",
            "0",
            "inner_ring_marks must be 1 to 1000, is 0",
        ),
        ("cage_marks", "1001", "cage_marks must be 1 to 1000"),
        ("cage_marks", "-1", "invalid value"),
    ] {
        refuse(GIVES_WAY, "ball_bearing", key, value, rule);
    }
}

#[test]
fn two_planes_are_checked() {
    for (table, key, value, rule) in [
        (
            "two_plane",
            "transverse_inertia_kg_m2",
            "0",
            "transverse_inertia_kg_m2 must be above 0",
        ),
        (
            "two_plane",
            "transverse_inertia_kg_m2",
            "1e-4",
            "polar over transverse inertia must be",
        ),
        (
            "two_plane",
            "unbalance_g_mm",
            "-1",
            "unbalance_g_mm must be 0 to",
        ),
        (
            "two_plane",
            "unbalance_deg",
            "1e9",
            "unbalance_deg must be -36000 to 36000",
        ),
        ("two_plane", "skew_mrad", "-1", "skew_mrad must be 0 to"),
        (
            "two_plane",
            "skew_deg",
            "nan",
            "skew_deg must be a finite number",
        ),
        (
            "two_plane",
            "elastic_mode_hz",
            "0",
            "elastic_mode_hz must be 1 to",
        ),
        (
            "two_plane",
            "tilt_mrad",
            "[0, 1e5]",
            "tilt_mrad must be -10000 to 10000",
        ),
        (
            "two_plane",
            "tilt_rate_rad_s",
            "[1e5, 0]",
            "tilt_rate_rad_s must be",
        ),
        (
            "two_plane",
            "tilt_rate_rad_s",
            "[0]",
            "the list must have 2 numbers, has 1",
        ),
        ("two_plane", "gravity_deg", "1e6", "gravity_deg must be"),
        (
            "two_plane",
            "sensor_z_mm",
            "[0, 1e9]",
            "sensor_z_mm must be",
        ),
        ("[ring]", "z_mm", "1e9", "z_mm must be -100000 to 100000"),
        ("[magnet]", "z_mm", "-1e9", "z_mm must be"),
        (
            "[magnet]",
            "stiffness_n_m",
            "0.1",
            "stiffness_n_m must be 1 to",
        ),
        ("[magnet]", "force_n", "[0, 1e10]", "force_n must be"),
    ] {
        refuse(TILTS, table, key, value, rule);
    }
}

/// The second ring is named by its own line.
#[test]
fn rows_are_told_apart() {
    for (key, value, rule) in [
        ("radius_mm", "0", "radius_mm must be 0.01 to"),
        ("clearance_mm", "0", "clearance_mm must be 0.001 to 100"),
        ("friction", "-1", "friction must be 0 to 100"),
        ("restitution", "2", "restitution must be 0 to 1"),
    ] {
        refuse(
            &TILTS.replacen("[[ring]]\nz_mm = -120\n", "[[ring]]\nz_mm=-120\n", 1),
            "[ring]",
            key,
            value,
            rule,
        );
    }
}

#[test]
fn tables_that_do_not_go_together() {
    for (parts, rule) in [
        (
            format!("{GIVES_WAY}[[mode]]\nfrequency_hz = 900\n"),
            "[[mode]] needs [two_plane]",
        ),
        (
            "[[ring]]\nz_mm = 1\n".to_owned(),
            ":12: [[ring]] needs [two_plane]",
        ),
        (
            TILTS.split("[[ring]]").next().unwrap().to_owned(),
            "[[ring]] must stand 1 to 4 times, stands 0 times",
        ),
        (
            format!("{TILTS}{}", "[[ring]]\nz_mm = 1\n".repeat(3)),
            "[[ring]] must stand 1 to 4 times, stands 5",
        ),
        (
            format!("{TILTS}{}", "[[magnet]]\nz_mm = 1\n".repeat(4)),
            "[[magnet]] must stand 4 times at most",
        ),
        (
            TILTS.replace("transverse_inertia_kg_m2 = 0.03\n", ""),
            "transverse_inertia_kg_m2 or rotor_length_mm must be given",
        ),
        (
            TILTS.replace("unbalance_deg = 10", "rotor_length_mm = 300"),
            "rotor_length_mm: give one",
        ),
        (
            TILTS.replace("[0.1, 0.1]", "[5, 0]"),
            ":23: the start is outside the gap of ring a",
        ),
        (
            format!("{TILTS}[start]\nangle_deg = 0\n"),
            "a start on the wall is for one plane",
        ),
        (
            "[model]\nrung = \"two-plane\"\n".to_owned(),
            ":12: rung = \"two-plane\" needs [two_plane]",
        ),
        (
            "[support]\nmass_kg = 1\n".to_owned(),
            "missing required key `stiffness_n_m`",
        ),
        (
            "[support]\nmass_kg = 1\nspring = 3\n".to_owned(),
            "unknown key `spring`",
        ),
    ] {
        explain(&format!("{MACHINE}{parts}"))
            .code(2)
            .stdout("")
            .stderr(contains(rule));
    }
    explain(&MACHINE.replace("duration_s", "inclination_deg = 91\nduration_s"))
        .code(2)
        .stderr(contains(
            "scene.toml:10: inclination_deg must be -90 to 90, is 91",
        ));
}

#[test]
fn what_only_compliant_contacts_have_is_refused_without_them() {
    let balls = format!("{GIVES_WAY}stiffness_n_m = 1e8\n");
    let rule = "stiffness_n_m of balls is that of [model] contact = \"compliant\"";
    let plane = explain(&format!("{MACHINE}{balls}"));
    plane.code(2).stdout("").stderr(contains(rule));
    let rings = format!("{TILTS}[ball_bearing]\ninner_ring_inertia_kg_m2 = 3e-5\nstiffness_n_m = 1e8\n");
    let rigid = explain(&format!("{MACHINE}{rings}"));
    rigid.code(2).stdout("").stderr(contains(rule));
    let compliant = "[model]\ncontact = \"compliant\"\n";
    explain(&format!("{MACHINE}{rings}{compliant}")).success();
    let rule = "contact = \"compliant\" needs [two_plane]: in the plane rung = \"hertz\" is that";
    refuse("[model]\ncontact = \"restitution\"\n", "model", "contact", "\"compliant\"", rule);
    let limited = format!("{TILTS}limit_n = 10\n{compliant}");
    refuse(&limited, "magnet", "limit_n", "0", "limit_n must be above 0");
    let rule = "rung = \"two-plane\" has no support, ball bearing, mode, base, compliant contact";
    let given = format!("{limited}rung = \"coupled\"\n");
    refuse(&given, "model", "rung", "\"two-plane\"", rule);
}
