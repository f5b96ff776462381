//! Choices of `fidelity = "auto"` for random machines: a part without effect is left out and one with effect stays, and what was
//! chosen keeps its tolerance in drops that no choice was made on.

use std::ops::Range;

use touchdown_run::ensemble::varied;
use touchdown_run::fidelity::{self, Choice};
use touchdown_run::model;
use touchdown_scene::parts::removable;
use touchdown_scene::{Auto, Fixed, Output, Removable, Request, Scene};

use crate::accuracy_runs::KINDS;
use crate::family::{Family, Verdict, seeds};
use crate::plant::Rng;

/// Drops of each choice; a choice is made on the first 59.
const FRESH: Range<u64> = 1_000..1_100;
/// Of them, those that must keep the tolerance.
const KEPT: usize = 95;

/// The families whose name contains `only`: so many `runs` of answers in the plane, half of it of each other.
pub fn run(only: &str, runs: u64, first_seed: u64) -> Vec<Family> {
    let planted: [(_, &[bool]); 3] = [
        ("planted: no effect, left out; both ends stay", &[false]),
        ("planted: effect, stays; both ends stay", &[true]),
        (
            "planted: one without effect, left out, one with, stays; both ends stay",
            &[false, true],
        ),
    ];
    let mut families = Vec::new();
    for (name, effects) in planted {
        if name.contains(only) {
            let verdicts = seeds(runs / 2, first_seed, |rng| {
                Some(planted_parts(rng, effects))
            });
            families.push(Family::of_verdicts(name, verdicts));
        }
    }
    let [(_, plane), (_, two_ends)] = KINDS;
    let answers = [
        ("answers: plane", runs, plane),
        ("answers: two ends, all parts", runs / 2, two_ends),
    ];
    for (name, runs, make) in answers {
        if name.contains(only) {
            let verdicts = seeds(runs, first_seed, |rng| Some(answer(rng, make)));
            families.push(Family::of_verdicts(name, verdicts));
        }
    }
    families
}

/// A machine with two ends and other parts, each with or without effect on impacts.
fn planted_parts(rng: &mut Rng, effects: &[bool]) -> Verdict {
    let mass = 10_f64.powf(rng.uniform(0.0, 1.5));
    let (radius, length) = (rng.uniform(10.0, 40.0), rng.uniform(300.0, 800.0));
    let clearance = rng.uniform(0.2, 0.4);
    let wider = clearance * rng.uniform(1.2, 1.5);
    let speed = rng.uniform(3e3, 2e4);
    let (friction, restitution) = (rng.uniform(0.15, 0.3), rng.uniform(0.5, 0.7));
    let ends = [-rng.uniform(0.3, 0.45), rng.uniform(0.3, 0.45)].map(|it| it * length);
    let mut kinds = vec![Removable::Mount, Removable::BallBearing, Removable::Bending];
    let mut tables = String::new();
    let mut planted = vec![(Removable::Tilt, true)];
    for has_effect in effects {
        let kind = rng.any(&kinds);
        kinds.retain(|it| *it != kind);
        tables += &table(rng, kind, mass, radius, length, *has_effect);
        planted.push((kind, *has_effect));
    }
    // Falls from the centre to the nearer wall.
    let duration = rng.uniform(3.5, 4.5) * (2e-3 * clearance / 9.81).sqrt();
    let text = format!(
        "[rotor]\nmass_kg = {mass}\nradius_mm = {radius}\nspeed_rpm = {speed}\n\
         [retainer]\nclearance_mm = {clearance}\nfriction = {friction}\nrestitution = {restitution}\n\
         [two_plane]\nrotor_length_mm = {length}\n\
         [[ring]]\nz_mm = {}\n[[ring]]\nz_mm = {}\nclearance_mm = {wider}\n{tables}\
         [model]\nfidelity = \"auto\"\nstep_us = 2\n[outputs]\nimpact_time_us = 100\n\
         [run]\nduration_s = {duration}\n",
        ends[0], ends[1]
    );
    let mut scene = Scene::parse("planted", &text).expect("a valid scene");
    scene.run.seed = rng.next_u64();
    let choice = chosen(&scene);
    if !choice.suffices() {
        return Verdict::Undecided("nothing keeps it".into());
    }
    scene.model = choice.taken().model;
    let modelled = removable(&scene);
    let wrong = planted
        .iter()
        .find(|(part, has_effect)| modelled.contains(part) != *has_effect);
    match wrong {
        None => Verdict::Held,
        Some((part, has_effect)) => {
            let what = if *has_effect { "left out" } else { "stays" };
            Verdict::Failed(format!("{part:?} {what}: {}", fidelity::explain(&choice)))
        }
    }
}

/// A part's table: without effect a mount and an inner ring that are too heavy to be moved, and modes that do not move the
/// ends.
fn table(
    rng: &mut Rng,
    part: Removable,
    mass: f64,
    radius: f64,
    length: f64,
    has_effect: bool,
) -> String {
    match part {
        Removable::Mount => {
            let ring = if has_effect { 0.3 * mass } else { 1e6 };
            let rate = std::f64::consts::TAU * rng.uniform(50.0, 150.0);
            let (stiffness, damping) = (0.5 * mass * rate * rate, 0.2 * mass * rate);
            format!(
                "[support]\nmass_kg = {ring}\nstiffness_n_m = {stiffness}\ndamping_n_s_m = {damping}\n"
            )
        }
        Removable::BallBearing => {
            let rotor = mass * (1e-3 * radius).powi(2);
            let inertia = rotor * if has_effect { 1e-5 } else { 1e5 };
            format!("[ball_bearing]\ninner_ring_inertia_kg_m2 = {inertia}\n")
        }
        _ => {
            let frequency = rng.uniform(100.0, 400.0);
            let [end, middle] = [2.0, -1.2].map(|it| it * if has_effect { 1.0 } else { 1e-3 });
            let half = 0.5 * length;
            format!(
                "[[mode]]\nfrequency_hz = {frequency}\ndamping_ratio = 0.01\n\
                 at_mm = [-{half}, 0, {half}]\nshape = [{end}, {middle}, {end}]\n"
            )
        }
    }
}

/// A tolerance asked of a random scene, and kept by what is chosen.
fn answer(rng: &mut Rng, make: fn(u64) -> Scene) -> Verdict {
    let mut scene = make(rng.next_u64());
    scene.run.seed = rng.next_u64();
    let (output, tolerance) = rng.any(&[
        (Output::Regime, [0.0; 2]),
        (Output::ImpactTime, [1e-6, 1e-4]),
        (Output::ImpactSpeed, [1e-3, 1e-1]),
        (Output::Phases, [1e-6, 1e-4]),
    ]);
    let tolerance = rng.uniform(tolerance[0], tolerance[1]);
    let asked = vec![Request { output, tolerance }];
    let fixed = Fixed {
        step: Some(scene.model.step),
        ..Fixed::default()
    };
    scene.auto = Some(Auto { asked, fixed });
    let choice = chosen(&scene);
    if !choice.suffices() {
        return Verdict::Undecided("nothing keeps it".into());
    }
    scene.model = choice.taken().model;
    let keeps = |number: &u64| {
        let scene = varied(&scene, *number);
        let truth = touchdown_truth::simulate(&scene);
        let ours = model::simulate(&scene).expect("possible");
        fidelity::error(output, &ours, &truth, &scene) <= tolerance
    };
    let kept = FRESH.filter(keeps).count();
    if kept >= KEPT {
        return Verdict::Held;
    }
    Verdict::Failed(format!(
        "{output} to {tolerance:e}: kept in {kept} of {}",
        FRESH.count()
    ))
}

fn chosen(scene: &Scene) -> Choice {
    let auto = scene.auto.as_ref().expect("a model is left open");
    fidelity::choose(scene, auto).expect("a model that takes the scene")
}
