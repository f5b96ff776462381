//! Drops of random machines that are as told: clearance 0.1 to 1 mm, sample rate 5 to 100 kHz, 1 um noise on two planes, calm or
//! out of an orbit.

use std::f64::consts::TAU;

use itertools::iproduct;
use rand::Rng;
use rand_chacha::ChaCha8Rng;

use super::contact::{MOST, ONSET, contact_error};
use super::fall::{Fall, fall};
use super::impact::{Impacts, ORBIT_LEAD, TURNS};
use super::levitated::{LEAD, Levitated, ORBIT};
use super::whirl::has_wrong_sign;
use super::{Drop, Findings, Named, Plan, Row, bound, campaign};
use touchdown_base::evenly::in_disc;
use touchdown_base::failure::Failure;
use touchdown_base::statistics::{median, quantile, share};
use touchdown_scene::Scene;

/// Of a fall's latency to its bound: median, and below which 90 % are.
const LATE: [f64; 2] = [1.15, 1.3];
/// Part of the time to the first touch within which a fall is confirmed, and part of the falls.
const CONFIRMED: [f64; 2] = [0.7, 0.99];
/// Slowest loop of magnets that a fall has to be told from, Hz: until a quarter of its period is over they may catch the rotor.
const LOOP: f64 = 80.0;

/// What no rotor's surface goes beyond, m/s: steel would burst.
const SURFACE_SPEED: f64 = 400.0;
/// The slowest bounce series, of 1 mm and restitution 0.9, takes 0.27 s.
const WATCHED: f64 = 0.4;

#[derive(Clone, Copy, Debug)]
struct Case {
    /// Sample rate from and to, Hz.
    rates: [f64; 2],
    orbits: bool,
}

impl Case {
    fn name(self) -> String {
        let [from, to] = self.rates.map(|it| it / 1e3);
        let before = if self.orbits {
            "out of an orbit"
        } else {
            "calm"
        };
        format!("random machines, {from} to {to} kHz, {before}")
    }

    fn drop(self, plan: &Plan, random: &mut ChaCha8Rng) -> Result<Drop, Failure> {
        let mut any = |from: f64, to: f64| from * (to / from).powf(random.random_range(0.0..1.0));
        let mut scene = Scene::load("rig")?;
        scene.run.duration = WATCHED;
        scene.run.sample_rate = any(self.rates[0], self.rates[1]);
        scene.retainer.clearance = any(1e-4, 1e-3);
        scene.sensors.range = 2.0 * scene.retainer.clearance;
        scene.retainer.friction = any(0.02, 0.6);
        scene.retainer.restitution = any(0.2, 0.9);
        scene.rotor.radius = any(10e-3, 150e-3);
        scene.rotor.polar_inertia = 0.5 * scene.rotor.mass * scene.rotor.radius.powi(2);
        let [slow, fast] = TURNS;
        let orbit = any(slow, fast);
        let speed = any(1e3, 9e4) / 60.0;
        let sign = if random.random() { 1.0 } else { -1.0 };
        scene.run.seed = random.random();
        let (radius, turns, lead) = if self.orbits {
            (ORBIT, orbit, ORBIT_LEAD)
        } else {
            (0.0, speed, LEAD)
        };
        let floats = Levitated {
            place: in_disc(random, 0.5 * scene.retainer.clearance - radius),
            radius,
            angle: random.random_range(0.0..TAU),
            spin: sign * TAU * turns.min(SURFACE_SPEED / (TAU * scene.rotor.radius)),
            ..Levitated::default()
        };
        let first = random.random_range(0.0..1.0);
        Ok(Drop::released(plan, scene, floats, [0.0; 2], lead, first).before_fast_whirl())
    }
}

fn cases() -> Vec<Case> {
    let all = iproduct!([[5e3, 20e3], [20e3, 100e3]], [false, true]);
    all.map(|(rates, orbits)| Case { rates, orbits }).collect()
}

pub fn drops(plan: &Plan, random: &mut ChaCha8Rng) -> Result<Named, Failure> {
    let few = cases().into_iter().take(1);
    few.map(|case| Ok((case.name(), case.drop(plan, random)?)))
        .collect()
}

/// What was seen of a drop.
#[derive(Clone, Debug)]
struct Seen {
    fall: Fall,
    /// Lowest latency of the fall that noise allows, and the time to the first touch, s.
    bound: f64,
    touch: f64,
    impacts: Impacts,
    /// Of the first contact, s; none where there is none.
    contact: Option<f64>,
    /// Of each whirl that was told: whether its sign is not that of the motion.
    wrong_signs: Vec<bool>,
}

fn seen(drop: &Drop) -> Result<Seen, Failure> {
    let watched = drop.watch()?;
    let (scene, truth) = (&drop.scene, &watched.truth);
    let impact = truth.impacts.first().map(|it| it.state.time);
    let contact = truth.contact_starts.first().copied();
    let touches = impact.into_iter().chain(contact);
    let variance = bound::variance(&scene.sensors);
    let signs = watched.detection.events.iter();
    Ok(Seen {
        fall: fall(&watched),
        bound: bound::fall(variance, scene.run.gravity, scene.run.sample_rate),
        touch: touches.fold(f64::INFINITY, f64::min),
        impacts: Impacts::of(drop, &watched),
        contact: contact_error(&watched),
        wrong_signs: signs
            .filter_map(|it| has_wrong_sign(&watched, it))
            .collect(),
    })
}

pub fn run(plan: &Plan) -> Result<Findings, Failure> {
    let cases = cases();
    let drops = campaign::map(plan, "ideal", &cases, |case, mut random| {
        seen(&case.drop(plan, &mut random)?)
    })?;
    let rows = cases.iter().zip(&drops);
    Ok(rows
        .flat_map(|(case, drops)| judged(*case, drops))
        .collect())
}

fn judged(case: Case, drops: &[Seen]) -> Vec<Row> {
    let name = &case.name();
    let late: Vec<f64> = drops.iter().map(|it| it.fall.latency / it.bound).collect();
    let missed = late.iter().filter(|it| !it.is_finite()).count();
    let mut rows = Vec::new();
    // The bound is of many samples in a fall.
    if case.rates[0] >= 20e3 {
        for (quantity, part, most) in [
            ("fall_ratio", 0.5, LATE[0]),
            ("fall_ratio_p90", 0.9, LATE[1]),
        ] {
            rows.push(
                Row::quantile_at_most(name, quantity, &late, part, most)
                    .with("drops", drops.len())
                    .with("missed", missed)
                    .noted(format!("{missed} of {} missed", drops.len())),
            );
        }
    }
    let [part, most] = CONFIRMED;
    let long = drops.iter().filter(|it| part * it.touch >= 0.25 / LOOP);
    let confirmed: Vec<f64> = long.map(|it| it.fall.confirmed / it.touch).collect();
    let early: usize = drops.iter().map(|it| it.fall.early).sum();
    rows.push(
        Row::quantile_at_most(name, "confirmed_p99_of_fall", &confirmed, most, part)
            .and(early == 0)
            .with("false_falls", early)
            .with("falls", confirmed.len())
            .with("confirmed_median_of_fall", median(&confirmed)),
    );
    let impacts: Vec<_> = drops.iter().map(|it| it.impacts.clone()).collect();
    rows.extend(Impacts::rows(name, &impacts));
    let contacts: Vec<f64> = (drops.iter().filter_map(|it| it.contact))
        .map(f64::abs)
        .collect();
    let within = contacts.iter().filter(|it| **it <= ONSET[0]).count();
    rows.push(
        Row::at_least(
            name,
            "share_within_1_ms",
            share(within, contacts.len()),
            MOST,
        )
        .of(contacts.len())
        .with("contacts", contacts.len())
        .with("onset_error_p99_s", quantile(&contacts, 0.99)),
    );
    let signs = || drops.iter().flat_map(|it| &it.wrong_signs);
    let (told, wrong) = (signs().count(), signs().filter(|it| **it).count());
    rows.push(
        Row::at_most(name, "wrong_signs", wrong as f64, 0.0)
            .with("told", told)
            .noted(format!("{wrong} of {told} told")),
    );
    rows
}
