//! The source paper's numbers: what `touchdown paper` writes, and that it is right.

use std::f64::consts::{FRAC_PI_2, PI};
use std::fs;

use serde_json::Value;
use tempfile::TempDir;
use touchdown_base::failure::Failure;
use touchdown_base::history::History;
use touchdown_base::machine::Start;
use touchdown_base::paint::Paint;
use touchdown_base::regions::Plane;
use touchdown_lab::paper;
use touchdown_lab::paper::Paper;
use touchdown_scene::{BUILT_IN, Scene};
use touchdown_tests::binary::touchdown;

/// Enough to see every kind of ending; the command takes 1000.
const DROPS: u32 = 60;

fn numbers() -> Paper {
    paper::run(DROPS).unwrap()
}

fn row<'a>(paper: &'a Paper, item: &str) -> &'a paper::Row {
    let found = paper.rows.iter().find(|row| row.item == item);
    found.unwrap_or_else(|| panic!("no row {item:?}"))
}

#[test]
fn the_command_writes_rows_and_page() {
    let folder = TempDir::new().unwrap();
    let output = touchdown(folder.path())
        .args(["paper", "--drops", "20", "--json", "-"])
        .output()
        .unwrap();
    let text = String::from_utf8(output.stderr).unwrap();
    assert!(output.status.success(), "{text}");
    assert!(text.contains("wrote touchdown-paper.html"), "{text}");
    assert!(
        text.lines().all(|line| line.chars().count() <= 80),
        "{text}"
    );
    let json: Value = serde_json::from_slice(&output.stdout).unwrap();
    for row in json["rows"].as_array().unwrap() {
        let mut keys: Vec<&str> = row
            .as_object()
            .unwrap()
            .keys()
            .map(String::as_str)
            .collect();
        keys.sort_unstable();
        assert_eq!(
            keys,
            ["agrees", "item", "note", "ours", "printed", "right", "unit"]
        );
        assert!(row["right"].is_f64(), "{row}");
        assert_eq!(row["ours"].is_null(), row["agrees"].is_null(), "{row}");
        assert_ne!(row["note"], "", "{row}");
    }
    let page = fs::read_to_string(folder.path().join("touchdown-paper.html")).unwrap();
    for figure in ["Fig. 3", "Fig. 4", "Fig. 7"] {
        assert!(page.contains(figure));
    }
    for banned in ["http", "<link", "url(", "src=", "NaN", "inf\""] {
        assert!(!page.contains(banned), "{banned} in the page");
    }
}

#[test]
fn the_page_goes_where_it_is_asked_to() {
    let folder = TempDir::new().unwrap();
    touchdown(folder.path())
        .args(["paper", "--drops", "1", "--report", "there.html"])
        .assert()
        .success();
    assert!(folder.path().join("there.html").exists());
    assert!(!folder.path().join("touchdown-paper.html").exists());
    touchdown(folder.path())
        .args(["paper", "--drops", "0"])
        .assert()
        .code(2);
}

#[test]
fn ours_is_right_in_every_row() {
    let paper = numbers();
    assert!(paper.agrees());
    for row in &paper.rows {
        assert_ne!(row.agrees, Some(false), "{row:?}");
    }
    let measured = paper.rows.iter().filter(|row| row.ours.is_some()).count();
    assert_eq!((paper.rows.len(), measured), (49, 48));
}

/// Force and time of the contact by steps, each within 2e-5 and its power of right.
#[test]
fn the_contact_rows_are_runs_of_the_compliant_rung() {
    let paper = numbers();
    let rows = paper
        .rows
        .iter()
        .skip_while(|row| !row.item.starts_with("eq. (8)"));
    let mut measured = 0;
    for row in rows {
        let Some(ours) = row.ours else {
            assert_eq!(row.item, "1/(0.2 ms)");
            assert!(row.note.contains("no run of ours"), "{row:?}");
            continue;
        };
        let off = (ours / row.right - 1.0).abs();
        println!("{}: {off:.1e}", row.item);
        assert!(off > 0.0 && off <= 5e-5, "{row:?}");
        measured += 1;
    }
    assert_eq!(measured, 10);
    let peaks: Vec<f64> = paper
        .figures
        .iter()
        .filter(|it| it.figure == "7")
        .map(paper::Curve::top)
        .collect();
    let [narrow, wide, narrow_run, wide_run] = peaks[..] else {
        panic!("{peaks:?}");
    };
    assert!((narrow_run / narrow - 1.0).abs() < 1e-3 && (wide_run / wide - 1.0).abs() < 1e-3);
}

#[test]
fn a_wrong_row_fails_the_command() {
    let mut paper = paper::run(1).unwrap();
    let first = paper.rows.remove(0);
    let right = first.right;
    paper.rows.push(first.ours(right + 1.0, 0.5));
    assert!(!paper.agrees());
    assert!(paper::table(&paper, Paint::PLAIN).contains('!'));
    assert_eq!(Failure::Check(String::new()).status(), 1);
}

/// Printed and right numbers as known beforehand, to half a unit of their last digit.
#[test]
fn printed_and_right_are_the_known_numbers() {
    let paper = numbers();
    for (item, printed, right, unit) in [
        ("kappa", Some(600.0), 600.0, 0.5),
        ("speed after the fall, 0.3 mm", Some(0.1), 0.07672, 5e-6),
        ("speed after the fall, 0.75 mm", None, 0.1213, 5e-5),
        ("first jump of theta'", Some(60.0), 46.03, 5e-3),
        ("theta' before the second impact", None, -56.8, 0.05),
        ("second jump of theta'", Some(48.0), 31.4, 0.05),
        ("theta' after the second impact", None, -25.4, 0.05),
        ("largest |theta'| at an impact", None, 83.0, 0.5),
        ("whirl speed, contact kept", Some(350.0), 334.59, 5e-3),
        ("whirl speed without friction", None, 404.4, 0.06),
        ("friction whose whirl speed is 350 rad/s", None, 0.076, 5e-4),
        ("growth time from 350 rad/s, weightless", None, 0.029, 5e-4),
        ("whirl ends at, weightless", None, 25.0, 0.5),
        ("its load", None, 7.2e6, 5e4),
        ("spin used up, lying on the bearing", None, 38.6, 0.05),
        ("eq. (8), constant", Some(0.814), 0.81145, 5e-6),
        ("eq. (9), constant", Some(4.252), 4.53398, 5e-6),
        ("eq. (8) times (9), F0 T_c/(m V)", Some(3.461), 3.6791, 5e-5),
        ("eq. (10), E_r steel on steel", None, 3.625e11, 5e7),
        ("F0 of the rig, 0.3 mm", Some(3753.0), 3741.0, 0.5),
        ("f_c = 1/T_c of the rig, 0.75 mm", Some(3500.0), 3549.0, 0.5),
        ("f_c at 0.02 m/s, 0.75 mm", Some(3500.0), 2475.0, 0.5),
        ("T_c, half the mass, 0.3 mm", Some(2e-4), 1.95e-4, 1e-6),
        ("T_c, half the mass, 0.75 mm", Some(2e-4), 2.14e-4, 1e-6),
        ("1/(0.2 ms)", Some(5000.0), 5000.0, 0.5),
    ] {
        let row = row(&paper, item);
        assert!((row.right - right).abs() <= unit, "{row:?}");
        match (row.printed, printed) {
            (Some(ours), Some(printed)) => assert!((ours - printed).abs() <= 0.5, "{row:?}"),
            (ours, printed) => assert_eq!(ours, printed, "{row:?}"),
        }
    }
    let wide = row(&paper, "f_c = 1/T_c of the rig, 0.75 mm");
    assert!(wide.note.contains("3785 Hz with the printed constant"));
}

#[test]
fn thresholds_by_bisection_are_the_closed_forms() {
    let paper = numbers();
    let k: f64 = 9.81 / 0.3e-3;
    let kept =
        |mu: f64| (k * (3.0 * (1.0 + (-2.0 * PI * mu).exp()) / (1.0 + 4.0 * mu * mu) - 1.0)).sqrt();
    let ours = |item| row(&paper, item).ours.unwrap();
    assert!((ours("whirl speed, contact kept") - kept(0.1)).abs() < 1e-6);
    assert!((ours("whirl speed without friction") - (5.0 * k).sqrt()).abs() < 1e-6);
    let friction = ours("friction whose whirl speed is 350 rad/s");
    assert!((kept(friction) - 350.0).abs() < 1e-4);
    let after_lift_off = ours("whirl speed, after one lift-off");
    assert!((310.0..311.0).contains(&after_lift_off), "{after_lift_off}");
}

/// The gap has no part in it, friction decides, restitution matters little below 0.8.
#[test]
fn a_large_gap_does_not_avoid_whirl() {
    let paper = numbers();
    assert_eq!(
        row(&paper, "drops that end otherwise at 0.75 mm").ours,
        Some(0.0)
    );
    let whirl = |friction: f64, restitution: f64, gap: f64| {
        let tally = paper.drops.iter().find(|it| {
            let condition = &it.condition;
            condition.friction == friction
                && condition.restitution == restitution
                && condition.clearance_m == gap
                && condition.fastest > 0.0
        });
        tally.unwrap()
    };
    let (narrow, wide) = (whirl(0.1, 0.8, 0.3e-3), whirl(0.1, 0.8, 0.75e-3));
    assert!(narrow.whirl_low <= wide.whirl_high && wide.whirl_low <= narrow.whirl_high);
    let by_friction = [0.1, 0.2, 0.3, 0.5].map(|friction| whirl(friction, 0.8, 0.3e-3).whirl);
    assert!(by_friction.is_sorted(), "{by_friction:?}");
    assert!(by_friction[3] > 5 * by_friction[0], "{by_friction:?}");
    for tally in &paper.drops {
        assert_eq!(
            tally.whirl, tally.whirl_of_reference,
            "{:?}",
            tally.condition
        );
        assert_eq!(tally.drops, DROPS);
    }
}

fn from_wall(friction: f64, angle: f64, rate: f64) -> History {
    let mut scene = Scene::parse("rig", BUILT_IN[0].text).unwrap();
    scene.retainer.friction = friction;
    scene.run.duration = 0.1;
    let tangential = rate * scene.retainer.clearance;
    scene.start = Start::Wall { angle, tangential };
    touchdown_truth::simulate(&scene)
}

/// What becomes of a rotor on the wall.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Region {
    /// Contact is kept for ever, round and round.
    A,
    /// Contact is kept for ever, as a swing about the bottom.
    B,
    /// The wall cannot hold the rotor here.
    C,
    /// Contact now, lost later.
    Lost,
}

/// The region of a point, `phi` within -pi to pi, `rate` = theta' in rad/s.
fn region(plane: &Plane, friction: f64, phi: f64, rate: f64) -> Region {
    if rate.abs() < plane.limit(phi) {
        return Region::C;
    }
    let mut c = plane.orbit(phi, rate * rate).c;
    let (whirl, swing) = (plane.slowest_whirl().c, plane.widest_swing().c);
    if rate < 0.0 && c >= swing {
        // Against the friction: over the top while the force lasts there, with phi set back a turn.
        let fastest_at_the_top = plane.limit(-PI).powi(2);
        let over_the_top = plane.orbit(-PI, fastest_at_the_top).c;
        while c >= over_the_top {
            c *= (-4.0 * PI * friction).exp();
        }
        if c >= plane.orbit(-FRAC_PI_2, 0.0).c {
            return Region::Lost;
        }
    }
    match c {
        c if c >= whirl => Region::A,
        c if c <= swing => Region::B,
        _ => Region::Lost,
    }
}

/// The reference keeps contact exactly where the closed form of the regions says so.
#[test]
fn regions_are_those_of_the_reference() {
    for friction in [0.1, 0.45] {
        let plane = Plane::new(9.81 / 0.3e-3, friction);
        let mut seen = [0; 4];
        for step in 0..400 {
            let angle = 0.99 * PI * (2.0 * (f64::from(step) * 0.618).fract() - 1.0);
            let rate = f64::from(step - 200) * 2.5;
            let history = from_wall(friction, angle, rate);
            let region = region(&plane, friction, angle, rate);
            seen[region as usize] += 1;
            let turns = history.end.turns_in_contact;
            let first = history.lift_offs.first().copied();
            let expected = match first {
                Some(0.0) => Region::C,
                Some(_) => Region::Lost,
                None if history.contact_starts.first() != Some(&0.0) => Region::C,
                None if turns >= 1.0 => Region::A,
                None => Region::B,
            };
            assert_eq!(
                region, expected,
                "friction {friction}, {angle} rad, {rate} rad/s"
            );
        }
        assert!(seen.iter().all(|count| *count > 10), "{seen:?}");
    }
}
