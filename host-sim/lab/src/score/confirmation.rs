//! What trust costs: how late a fall is confirmed, and how often a caught disturbance is, over
//! `confirm_travel`, with and without "levitation on" wired.

use rand::Rng;
use rand_chacha::ChaCha8Rng;
use touchdown_core::event::EventKind;

use super::figure::{Curve, Figure};
use super::impact::dropped;
use super::listening::{Case, listen};
use super::{Plan, campaign};
use touchdown_base::failure::Failure;
use touchdown_base::statistics::median;
use touchdown_scene::Scene;

const TRAVELS: [f32; 7] = [0.05, 0.1, 0.17, 0.25, 0.3, 0.4, 0.5];
/// Without and with the signal.
const SIGNALS: [bool; 2] = [false, true];
/// One seed: a drop, and base shocks for so long, s.
const PIECE: f64 = 5.0;
/// Seeds, at most.
const PIECES: f64 = 24.0;
/// The rotor has hit the wall by then, s.
const WATCHED: f64 = 15e-3;

/// Latency in s, infinite if not confirmed, and false trips.
type Trial = (f64, u32);

/// Measures and draws.
pub fn figure(plan: &Plan) -> Result<Figure, Failure> {
    let pieces = (plan.seconds / PIECE).clamp(1.0, PIECES).floor();
    // Each setting gets the same drops and the same shocks.
    let trials = campaign::map_of(
        plan.first_seed,
        pieces as u64,
        "confirmation",
        &[()],
        |(), random| {
            let settings = SIGNALS.map(|signal| TRAVELS.map(|travel| (signal, travel)));
            let tried = settings.as_flattened().iter();
            tried
                .map(|(signal, travel)| trial(plan, *travel, *signal, &random))
                .collect::<Result<Vec<Trial>, Failure>>()
        },
    )?;
    let trials = trials.concat();
    let hours = pieces * PIECE / 3600.0;
    let point = |setting: usize| {
        let late: Vec<f64> = trials.iter().map(|it| it[setting].0).collect();
        let trips: u32 = trials.iter().map(|it| it[setting].1).sum();
        [f64::from(trips) / hours, 1e3 * median(&late)]
    };
    let curve = |signal: usize, name: &str| {
        let settings = (0..TRAVELS.len()).map(|travel| point(signal * TRAVELS.len() + travel));
        Curve::new(name.to_owned(), settings.collect())
    };
    Ok(Figure::Curves {
        title: "Confirmation: latency against false trips, confirm_travel 0.05 to 0.5",
        x: "base shocks up to 2 g, two a second, that are confirmed as a fall, per hour",
        y: "latency of confirmation, median, ms",
        decades: false,
        curves: vec![curve(0, "position alone"), curve(1, "levitation-on wired")],
    })
}

fn trial(plan: &Plan, travel: f32, signal: bool, random: &ChaCha8Rng) -> Result<Trial, Failure> {
    let (mut plan, mut random) = (plan.clone(), random.clone());
    plan.tuning.confirm_travel = travel;
    let mut scene = Scene::load("rig")?;
    scene.run.duration = WATCHED;
    scene.sensors.levitation_signal = signal;
    scene.tuning = plan.tuning;
    let spin = scene.rotor.spin * if random.random() { 1.0 } else { -1.0 };
    let watched = dropped(&plan, scene.clone(), spin, &mut random).watch()?;
    let mut events = watched.detection.events.iter();
    let fall = events.find(|it| it.event == EventKind::FreeFall && it.declared_s >= 0.0);
    let late = fall.and_then(|it| it.confirmed_s).unwrap_or(f64::INFINITY);
    let heard = listen(Case::Shock, &scene, PIECE, random)?;
    Ok((late, heard.confirmed))
}
