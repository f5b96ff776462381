//! Random drops whose estimated errors are held against their true ones.
//!
//! True is what the reference says that has all parts, where it says the same at two accuracies to a millionth of the
//! natural time and speed. An impact's errors cover if it has an impact within all of them.

use std::f64::consts::TAU;

use rayon::prelude::*;
use serde::Serialize;
use touchdown_base::history::{History, Impact};
use touchdown_base::machine::Start;
use touchdown_lab::limits::machine;
use touchdown_run::accuracy::{self, ImpactError, RunAccuracy};
use touchdown_run::model;
use touchdown_scene::{Fidelity, Precision, Scene};
use touchdown_truth::{Truth, Units};

use crate::family::upper_bound;
use crate::plant::Rng;

/// Impacts of each drop that are looked at.
const IMPACTS: usize = 20;
/// What a run goes on for after them, T.
const SHORTLY: f64 = 0.02;
/// Of the reference: of its series' last terms.
const SERIES: [f64; 2] = [1e-18, 1e-14];
/// Both agree to this, in T and V.
const AGREE: f64 = 1e-6;
/// Rounding of a time that is told, in T, and of a speed, in V.
const ROUNDING: f64 = 1e-15;

/// What a kind of drops showed.
#[derive(Clone, Debug, Serialize)]
pub struct Kind {
    /// Which.
    pub name: &'static str,
    /// Drops.
    pub drops: usize,
    /// Impacts that the reference determines.
    pub impacts: usize,
    /// Of them, those whose errors are told.
    pub told: usize,
    /// Of these, those whose true errors are greater.
    pub beyond: usize,
    /// Rate of such, below at 95 %.
    pub rate_below: f64,
    /// Told over true error of times and speeds: median and 90 %.
    pub over: [f64; 2],
    /// The first that are greater.
    pub failures: Vec<String>,
}

type Make = fn(u64) -> Scene;
/// Random scenes, and their name.
pub(crate) const KINDS: [(&str, Make); 2] =
    [("plane, rigid", plane), ("two ends, all parts", two_ends)];

/// So many drops of each kind.
pub fn run(drops: u64, first_seed: u64) -> Vec<Kind> {
    let kind = |(name, make): (&'static str, Make)| {
        let seen: Vec<Seen> = (first_seed..first_seed + drops)
            .into_par_iter()
            .filter_map(|seed| look(seed, &make(seed)))
            .collect();
        of(name, seen)
    };
    KINDS.map(kind).to_vec()
}

/// A rotor in the plane, its numbers from end to end.
fn plane(seed: u64) -> Scene {
    let mut random = Rng(seed.wrapping_mul(0x2545_f491_4f6c_dd1d));
    let mut between = |low, high| random.uniform(low, high);
    let mut scene = Scene::load("rig").expect("built in");
    scene.rotor.spin = between(-4000.0, 4000.0);
    scene.retainer.friction = between(0.0, 0.6);
    scene.retainer.restitution = between(0.0, 0.95);
    scene.retainer.clearance = 10_f64.powf(between(-4.7, -3.0));
    let units = Units::of(&scene);
    let (radius, at) = (between(0.0, 0.95) * units.length, between(0.0, TAU));
    let (speed, to) = (between(0.0, 2.0) * units.speed, between(0.0, TAU));
    scene.start = Start::Free {
        position: [radius * at.cos(), radius * at.sin()],
        velocity: [speed * to.cos(), speed * to.sin()],
    };
    scene.run.duration = 20.0 * units.time;
    scene.model.step = 10_f64.powf(between(-6.0, -3.0));
    if between(0.0, 1.0) < 0.5 {
        scene.model.precision = Precision::F32;
    }
    scene
}

/// Of a machine's number: its contacts are compliant. The reference tells no impulses of such.
const COMPLIANT: u64 = 1 << 5;

/// A rotor in two rings with any of the other parts that there are.
fn two_ends(seed: u64) -> Scene {
    let text = machine(seed & !COMPLIANT);
    // With its default step.
    let text = text.split("step_us").next().expect("a model");
    let mut scene = Scene::parse("machine", text).expect("a valid scene");
    let mut random = Rng(seed.wrapping_mul(0x2545_f491_4f6c_dd1d));
    scene.model.step *= 2_f64.powf(random.uniform(-1.0, 1.0));
    if seed & COMPLIANT != 0 {
        scene.model.precision = Precision::F32;
    }
    scene
}

/// Of a drop.
#[derive(Default)]
struct Seen {
    impacts: usize,
    told: usize,
    beyond: Vec<String>,
    over: Vec<f64>,
}

/// None where it takes too long.
fn look(seed: u64, scene: &Scene) -> Option<Seen> {
    let scene = &to_last_impact(scene);
    let run = model::run(scene).expect("a valid scene");
    let told = accuracy::estimate(scene, &run)?;
    let ours = run.histories.whole;
    let truths = if scene.model.rung == Fidelity::Rigid {
        [
            Some(touchdown_truth::simulate(scene)),
            truth(scene, SERIES[0]),
        ]
    } else {
        SERIES.map(|accuracy| truth(scene, accuracy))
    };
    let [fine, coarse] = truths;
    Some(compare(seed, scene, &ours, &told, &[fine?, coarse?]))
}

/// The same drop until shortly after the impacts that are looked at.
fn to_last_impact(scene: &Scene) -> Scene {
    let mut scene = scene.clone();
    let all = model::simulate(&scene).expect("a valid scene").impacts;
    if let Some(next) = all.get(IMPACTS) {
        let end = next.state.time + SHORTLY * Units::of(&scene).time;
        scene.run.duration = scene.run.duration.min(end);
    }
    scene
}

fn truth(scene: &Scene, accuracy: f64) -> Option<History> {
    let mut truth = Truth::to_accuracy(scene, accuracy);
    truth.advance(scene.run.duration);
    truth.given_up().is_none().then(|| truth.finish().whole)
}

fn compare(
    seed: u64,
    scene: &Scene,
    ours: &History,
    told: &RunAccuracy,
    [fine, coarse]: &[History; 2],
) -> Seen {
    let units = Units::of(scene);
    let mut seen = Seen::default();
    for (index, (impact, told)) in ours
        .impacts
        .iter()
        .zip(&told.impacts)
        .enumerate()
        .take(IMPACTS)
    {
        let Some(truth) = nearest(impact, fine, &units) else {
            continue;
        };
        let own =
            nearest(truth, coarse, &units).map_or(f64::INFINITY, |it| apart(truth, it, &units));
        if own > AGREE {
            continue;
        }
        seen.impacts += 1;
        let Some(told) = told else { continue };
        seen.told += 1;
        let slack = own + ROUNDING;
        let within = |it: &Impact| within(impact, it, told, slack, scene);
        if !fine.impacts.iter().any(within) {
            let numbers = |it: &Impact| {
                format!(
                    "{:.9} s, {:.6} m/s, {:.3e} N s",
                    it.state.time, it.normal_speed, it.normal_impulse
                )
            };
            seen.beyond.push(format!(
                "seed {seed}, impact {index}, step {:.1e} s: {}; reference {}; told {told:?}",
                scene.model.step,
                numbers(impact),
                numbers(truth),
            ));
        }
        let time = (impact.state.time - truth.state.time).abs();
        let speed = (impact.normal_speed - truth.normal_speed).abs();
        seen.over.push(told.time_s / time.max(slack * units.time));
        seen.over
            .push(told.normal_speed_m_s / speed.max(slack * units.speed));
    }
    seen
}

fn apart(a: &Impact, b: &Impact, units: &Units) -> f64 {
    let time = (a.state.time - b.state.time) / units.time;
    let speed = (a.normal_speed - b.normal_speed) / units.speed;
    time.abs().max(speed.abs())
}

fn nearest<'a>(of: &Impact, among: &'a History, units: &Units) -> Option<&'a Impact> {
    let apart = |it: &&Impact| apart(of, it, units);
    let all = among.impacts.iter();
    all.min_by(|a, b| apart(a).total_cmp(&apart(b)))
}

fn within(ours: &Impact, truth: &Impact, told: &ImpactError, slack: f64, scene: &Scene) -> bool {
    let units = Units::of(scene);
    let impulse = told.normal_impulse_n_s.unwrap_or(f64::INFINITY);
    let mass = scene.rotor.mass;
    (ours.state.time - truth.state.time).abs() <= told.time_s + slack * units.time
        && (ours.normal_speed - truth.normal_speed).abs()
            <= told.normal_speed_m_s + slack * units.speed
        && (ours.normal_impulse - truth.normal_impulse).abs()
            <= impulse + slack * mass * units.speed
}

fn of(name: &'static str, seen: Vec<Seen>) -> Kind {
    let mut over: Vec<f64> = seen.iter().flat_map(|it| it.over.iter().copied()).collect();
    over.sort_by(f64::total_cmp);
    let quantile = |part: f64| over[(part * (over.len() - 1) as f64) as usize];
    let told = seen.iter().map(|it| it.told).sum();
    let beyond = seen.iter().map(|it| it.beyond.len()).sum();
    let first = seen.iter().filter_map(|it| it.beyond.first().cloned());
    Kind {
        name,
        drops: seen.len(),
        impacts: seen.iter().map(|it| it.impacts).sum(),
        told,
        beyond,
        rate_below: upper_bound(beyond, told),
        over: [0.5, 0.9].map(quantile),
        failures: first.take(20).collect(),
    }
}
