//! `fidelity = "auto"`: what it takes gives what is asked, and is the cheapest that does.

use std::fs;

use predicates::str::contains;
use rayon::prelude::*;
use serde_json::Value;
use tempfile::TempDir;
use touchdown_base::history::History;
use touchdown_run::ensemble::varied;
use touchdown_run::fidelity::{Candidate, choose};
use touchdown_run::model::simulate;
use touchdown_scene::{BUILT_IN, Fidelity, Model, Precision, Scene};
use touchdown_tests::binary::{touchdown, trade};

fn text(name: &str, model: &str, outputs: &str) -> String {
    let built_in = BUILT_IN.iter().find(|scene| scene.name == name);
    let text = built_in.expect("a built-in scene").text;
    format!("{text}\n[model]\nfidelity = \"auto\"\n{model}\n[outputs]\n{outputs}\n")
}

/// Drops that no choice was made on.
const FRESH: std::ops::Range<u64> = 100_000..100_100;

/// The choice for `outputs`, over drops of its own.
fn check(name: &str, outputs: &str, suffices: impl Fn(&History, &History) -> bool + Sync) -> Model {
    let scene = Scene::parse(name, &text(name, "", outputs)).expect("a valid scene");
    assert!(scene.run.duration <= 1.0, "measured whole");
    let choice = choose(&scene, scene.auto.as_ref().expect("open")).expect("some");
    assert!(choice.suffices(), "{:?}", choice.taken());
    let best = choice.taken();
    for cheaper in choice.candidates.iter().take_while(|it| *it != best) {
        let fails_around = cheaper.tried.as_ref().is_some_and(|it| it.kept < it.drops);
        let fails = !cheaper.suffices(&choice.asked) || fails_around;
        assert!(fails && cheaper.cost <= best.cost, "{cheaper:?}");
    }
    let kept = FRESH.into_par_iter().filter(|number| {
        let scene = varied(&scene, *number);
        let truth = touchdown_truth::simulate(&scene);
        let model = best.model;
        let ours = simulate(&Scene { model, ..scene }).expect("possible");
        suffices(&ours, &truth)
    });
    let kept = kept.count();
    println!("{name}, {outputs}: {:?}, kept in {kept} of 100", best.model);
    assert!(kept >= 95, "{kept}");
    best.model
}

fn same_regime(history: &History, truth: &History) -> bool {
    history.regime == truth.regime
}

fn impact_times(history: &History, truth: &History, tolerance: f64) -> bool {
    let wanted = truth.impacts.len().min(10);
    history.impacts.len() >= wanted
        && history.impacts[..wanted]
            .iter()
            .zip(&truth.impacts)
            .all(|(a, b)| (a.state.time - b.state.time).abs() <= tolerance)
}

#[test]
fn the_choice_is_the_cheapest_that_holds_in_drops_around_it() {
    check("rig", "regime = true", same_regime);
    let times = check("rig", "impact_time_us = 50", |ours, truth| {
        impact_times(ours, truth, 50e-6)
    });
    let exact = check("rig", "impact_time_us = 1e-6", |ours, truth| {
        impact_times(ours, truth, 1e-12)
    });
    assert_eq!(times.rung, Fidelity::Rigid);
    assert_eq!(exact.precision, Precision::F64, "1 ps needs f64");
    check(
        "lift-off",
        "regime = true\nimpact_time_us = 20",
        |ours, truth| same_regime(ours, truth) && impact_times(ours, truth, 20e-6),
    );
    check("backward-whirl", "regime = true", same_regime);
}

/// Hertz' F0 and T_c of the first impact; at restitution 1 the pulse is theirs.
#[test]
fn a_force_needs_the_rung_that_has_one() {
    let outputs = "peak_force_percent = 2\ncontact_time_percent = 2";
    let text = text("rig", "", outputs).replace("restitution = 0.8", "restitution = 1.0");
    let mut scene = Scene::parse("rig", &text).expect("a valid scene");
    assert_eq!(scene.retainer.restitution, 1.0);
    scene.run.duration = 0.02;
    let choice = choose(&scene, scene.auto.as_ref().expect("open")).expect("some");
    let best = choice.taken();
    assert_eq!(best.model.rung, Fidelity::Hertz);
    scene.model = best.model;
    let impact = simulate(&scene).expect("possible").impacts[0];
    let pulse = impact.pulse.expect("a pulse");
    let (mass, radius) = (scene.rotor.mass, scene.rotor.radius);
    let outer = radius + scene.retainer.clearance;
    let modulus = 3.625e11;
    let flat = 1.0 - radius / outer;
    let speed = impact.normal_speed;
    let force =
        0.811_45 * (speed.powi(6) * mass.powi(3) * radius * modulus * modulus / flat).powf(0.2);
    let time = 4.533_98 * (mass * mass * flat / (speed * radius * modulus * modulus)).powf(0.2);
    println!(
        "{:?}: {} N of {force}, {} s of {time}",
        best.model, pulse.peak_force, pulse.duration
    );
    // The weight, a hundredth of the force, is not in the formulas.
    assert!((pulse.peak_force / force - 1.0).abs() < 0.02 + 0.01);
    assert!((pulse.duration / time - 1.0).abs() < 0.02 + 0.01);
    for candidate in &choice.candidates {
        let given = candidate.errors.iter().all(|error| error.is_finite());
        assert_eq!(given, candidate.model.rung == Fidelity::Hertz, "{candidate:?}");
    }
}

#[test]
fn keys_of_the_model_are_kept() {
    let text = text("rig", "precision = \"f64\"\nstep_us = 37", "regime = true");
    let scene = Scene::parse("rig", &text).expect("a valid scene");
    let choice = choose(&scene, scene.auto.as_ref().expect("open")).expect("some");
    assert!(choice.candidates.len() > 6);
    for candidate in &choice.candidates {
        assert_eq!(candidate.model.precision, Precision::F64);
        assert_eq!(candidate.model.step, 37e-6);
    }
}

/// What `trade` prints of a combination is what the choice weighs.
#[test]
fn costs_are_those_of_the_table_of_trade() {
    for name in ["rig", "soft-support", "two-plane"] {
        let text = text(name, "", "regime = true").replace("duration_s = 0.3", "duration_s = 0.012");
        let scene = Scene::parse(name, &text).expect("a valid scene");
        assert_eq!(scene.run.duration, 0.012);
        let choice = choose(&scene, scene.auto.as_ref().expect("open")).expect("some");
        let json = trade(&text);
        let rows = json["rows"].as_array().expect("rows");
        let mut counted = 0;
        for Candidate { model, cost, .. } in &choice.candidates {
            let is_it = |row: &&Value| {
                row["rung"] == model.rung.to_string()
                    && row["scheme"] == model.scheme.to_string()
                    && row["precision"] == model.precision.to_string()
                    && row["math"] == model.math.to_string()
                    && (row["step_s"].as_f64().expect("a step") - model.step).abs() < 1e-12
            };
            let row = rows.iter().find(is_it).expect("a row of each");
            let each = row["mcu_instructions_per_step"].as_f64();
            let deviation = cost.zip(each).map(|(cost, each)| cost * model.step / each - 1.0);
            assert_eq!(cost.is_some(), each.is_some(), "{model:?}");
            assert!(deviation.is_none_or(|it| it.abs() < 1e-12), "{model:?}: {deviation:?}");
            counted += usize::from(cost.is_some());
        }
        assert!(counted > 50, "{counted}");
    }
}

fn drop_of(text: &str) -> assert_cmd::assert::Assert {
    let folder = TempDir::new().unwrap();
    fs::write(folder.path().join("auto.toml"), text).unwrap();
    touchdown(folder.path())
        .args(["drop", "auto.toml", "--json", "drop.json"])
        .assert()
}

#[test]
fn a_drop_says_what_was_taken_and_why() {
    drop_of(&text("rig", "", "impact_time_us = 1e-6"))
        .success()
        .stdout(contains("fidelity: rigid launch f64"))
        .stdout(contains("cheaper, but: "))
        .stdout(contains("instructions a simulated second"));
}

#[test]
fn what_nothing_gives_is_answered_by_the_nearest() {
    drop_of(&text("rig", "rung = \"rigid\"", "impact_time_us = 1e-12"))
        .success()
        .stdout(contains("the nearest: none gives all that is asked"))
        .stdout(contains("impact times: "))
        .stdout(contains("kept in 0 of "));
    // A rotor with two ends has no count of instructions on the target.
    drop_of(&text("york-ymc2", "step_us = 10\nprecision = \"f64\"", "regime = true\nimpact_time_us = 1"))
        .success()
        .stdout(contains("fidelity: coupled midpoint"));
}
