//! Random machines of the rung `coupled`: every combination of its parts, each with numbers from end to
//! end of what such a machine may have.

use std::f64::consts::{PI, TAU};
use std::ops::Range;

use rand::{Rng, SeedableRng};
use rand_chacha::ChaCha8Rng;
use rayon::prelude::*;

use super::coupled::Seen;
use super::row::Row;
use super::{PRECISIONS, refused};
use touchdown_base::failure::Failure;
use touchdown_base::progress::Progress;
use touchdown_scene::{Precision, Scene};

/// Parts, by the bits of a combination.
const PARTS: [&str; 6] = [
    "soft mounts",
    "ball bearings",
    "bending modes",
    "magnets",
    "magnets that come back",
    "walls that give way",
];
/// Of the progress.
pub const JOBS: u64 = 1 << PARTS.len();
/// Steps of a run at most: its duration is cut.
const STEPS: f64 = 8_000.0;

/// All measures of `machines` random machines, in equal numbers of each combination. What does not hold
/// stands in rows of its own, with the machine.
pub fn rows(machines: u64, progress: &mut Progress) -> Result<Vec<Row>, Failure> {
    let mut rows = Vec::new();
    for parts in 0..JOBS {
        let seeds: Vec<u64> = (parts..machines).step_by(JOBS as usize).collect();
        if seeds.is_empty() {
            continue;
        }
        let name = format!("coupled: {} machines with {}", seeds.len(), named(parts));
        for precision in PRECISIONS {
            let seen = seeds.par_iter().map(|seed| watched(*seed, precision));
            let seen: Vec<Seen> = seen.collect::<Result<_, Failure>>()?;
            for (seed, seen) in seeds.iter().zip(&seen) {
                let own = seen.rows(&own_name(*seed), precision);
                rows.extend(own.into_iter().filter(|row| !row.holds));
            }
            let worst = seen.into_iter().fold(Seen::default(), Seen::worse);
            rows.extend(worst.rows(&name, precision));
        }
        progress.advance();
    }
    Ok(rows)
}

/// All measures of one random machine.
pub fn rows_of(seed: u64) -> Result<Vec<Row>, Failure> {
    let of = |precision| Ok(watched(seed, precision)?.rows(&own_name(seed), precision));
    let rows = PRECISIONS.into_iter().map(of);
    Ok(rows.collect::<Result<Vec<_>, Failure>>()?.concat())
}

fn watched(seed: u64, precision: Precision) -> Result<Seen, Failure> {
    let mut scene = Scene::parse(&format!("machine {seed}"), &text(seed))?;
    scene.model.precision = precision;
    let mut seen = Seen::default();
    seen.watch(&scene).map_err(refused)?;
    Ok(seen)
}

fn own_name(seed: u64) -> String {
    format!("coupled: machine {seed}")
}

fn named(parts: u64) -> String {
    let there = (0..PARTS.len()).filter(|bit| parts >> bit & 1 == 1);
    let names = std::iter::once("two ends").chain(there.map(|bit| PARTS[bit]));
    names.collect::<Vec<_>>().join(", ")
}

/// The scene file of a random machine; its parts are the seed's lowest bits.
pub fn text(seed: u64) -> String {
    let mut random = ChaCha8Rng::seed_from_u64(seed);
    let has = |part: u64| seed >> part & 1 == 1;
    let mass = decades(&mut random, -1.0..3.0);
    let clearance = decades(&mut random, -1.3..0.3);
    // Cylinder of steel, 4 to 30 times as long as its radius.
    let slender: f64 = random.random_range(4.0..30.0);
    let radius = 1e3 * (mass / (7850.0 * PI * slender)).cbrt();
    let length = slender * radius;
    let polar = 0.5e-6 * mass * radius * radius * random.random_range(0.5..5.0);
    let speed = random.random_range(-1.0..1.0) * 6e6 / radius;
    let friction = random.random_range(0.0..0.5);
    let restitution = random.random_range(0.0..1.0);
    let mut text = format!(
        "[rotor]\nmass_kg = {mass}\nradius_mm = {radius}\npolar_inertia_kg_m2 = {polar}\nspeed_rpm = {speed}\n\
         [retainer]\nclearance_mm = {clearance}\nfriction = {friction}\nrestitution = {restitution}\n"
    );
    let ends = [-0.45, 0.45].map(|at| at * length * random.random_range(0.3..1.0));
    // Unbalance of the grades G 0.1 to G 6.3.
    let grade = decades(&mut random, -1.0..0.8);
    let unbalance = 1e3 * mass * grade / (speed.abs() * TAU / 60.0).max(10.0);
    text += &format!("[two_plane]\nrotor_length_mm = {length}\nunbalance_g_mm = {unbalance}\n");
    for at in ends {
        text += &format!("[[ring]]\nz_mm = {at}\n");
    }
    if has(0) {
        text += &support(&mut random, mass, clearance);
        // A stop that there is may give way.
        if text.contains("travel_mm") {
            text += &perhaps(&mut own(seed, 8), "stop_stiffness_n_m", 1.0, 4.0..10.0);
        }
        text += &seat(seed, mass);
    }
    if has(1) {
        let inertia = polar * decades(&mut random, -4.0..-0.5);
        text += &format!("[ball_bearing]\ninner_ring_inertia_kg_m2 = {inertia}\n");
        // So may balls, behind compliant contacts.
        if has(5) {
            text += &perhaps(&mut own(seed, 7), "stiffness_n_m", 1.0, 6.0..9.0);
        }
    }
    if has(2) {
        text += &modes(&mut random);
    }
    if has(3) {
        text += &left(&mut random, seed, mass, ends);
    }
    let [x, y] = [(); 2].map(|()| clearance * random.random_range(-0.2..0.2));
    let step = decades(&mut random, 0.0..300_f64.log10());
    let duration = (STEPS * 1e-6 * step).min(0.05);
    if has(4) {
        text += &lift(seed, mass, ends, duration);
    }
    text += &format!(
        "[start]\nx_mm = {x}\ny_mm = {y}\n[run]\nduration_s = {duration}\n[model]\nrung = \"coupled\"\nstep_us = {step}\n"
    );
    if has(5) {
        text += "contact = \"compliant\"\n";
    }
    text
}

/// 1e4 to 1e10 N/m, rings from 1e-4 of the rotor, and a stop in one of two.
fn support(random: &mut ChaCha8Rng, mass: f64, clearance: f64) -> String {
    let ring = mass * decades(random, -4.0..0.0);
    let stiffness = decades(random, 4.0..10.0);
    let damping = 2.0 * (stiffness * ring).sqrt() * decades(random, -3.0..1.0);
    let mut text = format!(
        "[support]\nmass_kg = {ring}\nstiffness_n_m = {stiffness}\ndamping_n_s_m = {damping}\n"
    );
    if random.random() {
        let travel = (clearance * decades(random, -2.0..0.5)).max(0.001);
        text += &format!("travel_mm = {travel}\n");
    }
    text
}

/// Another stiffness along y in one of two, dry friction of 0.01 to 10 times the weight in one of two. Numbers of their own.
fn seat(seed: u64, mass: f64) -> String {
    let mut random = own(seed, 2);
    let mut text = String::new();
    let spring = decades(&mut random, 4.0..10.0);
    let damper = decades(&mut random, 0.0..5.0);
    if random.random() {
        text += &format!("vertical_stiffness_n_m = {spring}\nvertical_damping_n_s_m = {damper}\n");
    }
    text + &perhaps(&mut random, "dry_friction_n", 9.81 * mass, -2.0..1.0)
}

/// The greatest force of a magnet, 0.1 to 10 times the weight, in one of two. Numbers of their own.
fn limit(seed: u64, stream: u64, mass: f64) -> String {
    perhaps(&mut own(seed, stream), "limit_n", 9.81 * mass, -1.0..1.0)
}

/// A key and so many decades of a unit, in one of two.
fn perhaps(random: &mut ChaCha8Rng, key: &str, unit: f64, range: Range<f64>) -> String {
    let value = unit * decades(random, range);
    match random.random() {
        true => format!("{key} = {value}\n"),
        false => String::new(),
    }
}

/// What does not change the numbers of other parts.
fn own(seed: u64, stream: u64) -> ChaCha8Rng {
    let mut random = ChaCha8Rng::seed_from_u64(seed);
    random.set_stream(stream);
    random
}

/// What is left of magnets that held half the rotor each at 15 to 100 Hz; 1 N/m at least, as a scene asks.
fn left(random: &mut ChaCha8Rng, seed: u64, mass: f64, ends: [f64; 2]) -> String {
    let mut text = String::new();
    for (at, stream) in ends.into_iter().zip(3..) {
        let rate = TAU * random.random_range(15.0..100.0_f64);
        let held = 0.5 * mass * rate.powi(2);
        let stiffness: f64 = held * random.random_range(-1.0..0.3);
        let stiffness = stiffness.abs().max(1.0).copysign(stiffness);
        let damping = random.random_range(0.0..0.8) * (held * 0.5 * mass).sqrt();
        text += &format!(
            "[[magnet]]\nz_mm = {at}\nstiffness_n_m = {stiffness}\ndamping_n_s_m = {damping}\n"
        );
        text += &limit(seed, stream, mass);
    }
    text
}

/// Magnets that hold the rotor at 15 to 100 Hz again, in the run and perhaps to its end. Numbers of their own: the
/// machine without them stays the same.
fn lift(seed: u64, mass: f64, ends: [f64; 2], duration: f64) -> String {
    let mut random = own(seed, 1);
    let from = duration * random.random_range(0.1..0.6);
    let mut text = String::new();
    for (at, stream) in ends.into_iter().zip(5..) {
        let rate = TAU * random.random_range(15.0..100.0_f64);
        let stiffness = -0.5 * mass * rate * rate;
        let damping = 0.5 * mass * rate * random.random_range(0.1..2.0);
        text += &format!(
            "[[magnet]]\nz_mm = {at}\nstiffness_n_m = {stiffness}\ndamping_n_s_m = {damping}\nfrom_s = {from}\n"
        );
        if random.random() {
            text += &format!("until_s = {}\n", from + 0.3 * duration);
        }
        text += &limit(seed, stream, mass);
    }
    text
}

/// One to three of a uniform beam.
fn modes(random: &mut ChaCha8Rng) -> String {
    let first = decades(random, 1.0..3.3);
    let mut text = String::new();
    // Squares of the roots of the free-free beam, over the first.
    let ratios = [1.0, 2.757, 5.404];
    for ratio in ratios.iter().take(random.random_range(1..=3)) {
        let (frequency, damping) = (first * ratio, decades(random, -4.0..-1.0));
        text += &format!(
            "[[mode]]\nfrequency_hz = {frequency}\ndamping_ratio = {damping}\nbeam = true\n"
        );
    }
    text
}

fn decades(random: &mut ChaCha8Rng, range: Range<f64>) -> f64 {
    10_f64.powf(random.random_range(range))
}
