//! Scenes of the rung `coupled`: which have it, what a ring's row overrides, modes, and broken rules.

use touchdown_scene::{Fidelity, Scene};

fn york(change: impl Fn(String) -> String) -> Result<Scene, String> {
    let text = Scene::text("york-ymc2").expect("built in").into_owned();
    Scene::parse("c.toml", &change(text)).map_err(|error| error.to_string())
}

#[test]
fn the_combination_chooses_the_rung() {
    let scene = york(|text| text).expect("valid");
    assert_eq!(scene.model.rung, Fidelity::Coupled);
    assert!(scene.warnings().is_empty(), "{:?}", scene.warnings());
    let plain = Scene::load("two-plane").expect("built in");
    assert_eq!(plain.model.rung, Fidelity::TwoPlane);
    let damped = york(|_| {
        let text = Scene::text("two-plane").expect("built in").into_owned();
        text + "\n[[magnet]]\nz_mm = 0.0\ndamping_n_s_m = 10.0\n"
    });
    assert_eq!(damped.expect("valid").model.rung, Fidelity::Coupled);
}

#[test]
fn a_tilt_that_is_not_small_is_warned_of() {
    let warned = |rings: &str| {
        let text = Scene::text("rig").expect("built in").into_owned();
        let text = format!("{text}\n[two_plane]\nrotor_length_mm = 300\n{rings}");
        Scene::parse("t.toml", &text).expect("valid").warnings()
    };
    let ring = |place: f64| format!("[[ring]]\nz_mm = {place}\n");
    let pair = |a: f64, b: f64| warned(&(ring(a) + &ring(b)));
    // 0.3 mm of gap at either end.
    assert!(pair(100.0, 106.1).is_empty() && pair(-120.0, 120.0).is_empty());
    assert!(pair(100.0, 105.9)[0].contains("hold the tilt to 102 mrad"), "{:?}", pair(100.0, 105.9));
    assert!(warned(&ring(2.9)).is_empty());
    assert!(warned(&ring(120.0))[0].contains("one ring, 120 mm from"), "{:?}", warned(&ring(120.0)));
    let held = "[[magnet]]\nz_mm = -100\nstiffness_n_m = -1e5\n";
    assert!(warned(&(ring(120.0) + held)).is_empty());
}

#[test]
fn a_row_overrides_what_holds_for_all_rings() {
    let own = "z_mm = 190.0\nsupport = { mass_kg = 0.3, stiffness_n_m = 1e6 }\n";
    let scene = york(|text| text.replace("z_mm = 190.0", own)).expect("valid");
    let rings = &scene.two_plane.expect("rings").rings;
    let masses: Vec<_> = rings.iter().map(|it| it.support.expect("mount").mass).collect();
    assert_eq!(masses, [0.6, 0.3]);
    assert!(rings.iter().all(|it| it.ball_bearing.is_some()));
}

/// The mean square of a free-free mode is 1, and its ends move by 2.
#[test]
fn a_beam_has_its_modes() {
    let beam = |text: String| {
        let at = text.find("at_mm").expect("shape");
        let end = text.find("[start]").expect("start");
        let text = format!("{}beam = true\n\n{}", &text[..at], &text[end..]);
        text.replace("transverse_inertia_kg_m2 = 1.5", "rotor_length_mm = 580.0")
    };
    let scene = york(beam).expect("valid");
    let modes = scene.two_plane.expect("modes").modes;
    let points = 2000;
    let square = (0..points).map(|k| 0.58 * ((f64::from(k) + 0.5) / f64::from(points) - 0.5));
    let mean = square.map(|z| modes[0].at(z).powi(2)).sum::<f64>() / f64::from(points);
    assert!((mean - 1.0).abs() < 1e-4, "{mean}");
    assert!((modes[0].at(0.29) - 2.0).abs() < 1e-9);
    assert!((modes[0].at(0.0) + 1.2157).abs() < 1e-3);
}

#[test]
fn broken_rules_name_their_line() {
    for (from, to, rule) in [
        ("shape = [2.0,", "shape = [", "shape and at_mm must have the same length"),
        ("at_mm = [-280.0", "at_mm = [-80.0", "at_mm must rise"),
        ("damping_ratio = 0.005", "damping_ratio = 2.0", "damping_ratio must be 0 to 1"),
        ("[start]", "[model]\nrung = \"two-plane\"\n[start]", "rung = \"two-plane\" has no support"),
        ("[start]", "[[magnet]]\nz_mm = 0.0\nfrom_s = -0.1\n[start]", "from_s must be 0 to 86400"),
        ("[start]", "[[magnet]]\nz_mm = 0.0\nuntil_s = 0.0\n[start]", "until_s must be after from_s"),
        ("[start]", "[base]\namplitude_mm = [0, 1]\nfrequency_hz = 0.0\n[start]", "frequency_hz must be"),
        ("[start]", "[stator]\ngap_mm = 0.0\n[start]", "gap_mm must be 0.001 to 100"),
    ] {
        let error = york(|text| text.replacen(from, to, 1)).expect_err(rule);
        assert!(error.contains(rule), "{error}");
        assert!(error.starts_with("c.toml:"), "{error}");
    }
}

/// A machine that follows its mounts unasked, and says so where it is told not to.
#[test]
fn the_default_step_follows_the_fastest_motion() {
    let fastest = |scene: &Scene| {
        let machine = scene.two_plane.as_ref().expect("two ends");
        scene.model.step * machine.fastest(scene.rotor.spin)
    };
    let plain = york(|text| text).expect("valid");
    assert!(fastest(&plain) <= 0.1 && plain.model.step <= 1e-5);
    let stiff = york(|text| text.replace("2.0e7", "4.0e8")).expect("valid");
    assert!(stiff.model.step < 0.5 * plain.model.step && fastest(&stiff) <= 0.1);
    let long = york(|text| {
        let text = text.replace("2.0e7", "2.0e10");
        text.replace("duration_s = 0.3", "duration_s = 2.0")
    });
    let long = long.expect("valid");
    assert!(long.run.duration / long.model.step <= 1e5);
    assert!(long.warnings()[0].contains("half a radian"), "{:?}", long.warnings());
    let coarse = york(|text| text + "\n[model]\nstep_us = 200.0\n").expect("valid");
    assert!(coarse.warnings()[0].contains("step_us is 200"), "{:?}", coarse.warnings());
}
