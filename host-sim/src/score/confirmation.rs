//! What trust costs: how late a fall is confirmed, and how often a caught disturbance is, over
//! `confirm_travel`, with and without "levitation on" wired.

use rand::Rng;
use touchdown_core::event::EventKind;

use super::campaign;
use super::figure::{Curve, Figure};
use super::impact::dropped;
use super::quiet::{Case, listen};
use super::statistics::median;
use super::Plan;
use crate::failure::Failure;
use crate::scene::Scene;

const TRAVELS: [f32; 7] = [0.05, 0.1, 0.17, 0.25, 0.3, 0.4, 0.5];
/// Base shocks that each is tried with, at most, s: two a second.
const SHOCKS: f64 = 60.0;
/// Drops, at most.
const DROPS: u64 = 50;
/// The rotor has hit the wall by then, s.
const WATCHED: f64 = 15e-3;

/// Measures and draws.
pub fn figure(plan: &Plan) -> Result<Figure, Failure> {
    let mut curves = Vec::new();
    for (signal, name) in [(false, "position alone"), (true, "levitation-on wired")] {
        let mut points = Vec::new();
        for travel in TRAVELS {
            points.push(point(plan, travel, signal)?);
        }
        curves.push(Curve::new(name.to_owned(), points));
    }
    Ok(Figure::Curves {
        title: "Confirmation: latency against false trips, confirm_travel 0.05 to 0.5",
        x: "base shocks up to 2 g that are confirmed as a fall, per hour of two a second",
        y: "latency of confirmation, median, ms",
        decades: false,
        curves,
    })
}

/// False trips an hour, and latency in ms.
fn point(plan: &Plan, travel: f32, signal: bool) -> Result<[f64; 2], Failure> {
    let mut plan = plan.clone();
    plan.tuning.confirm_travel = travel;
    let drops = plan.seeds.min(DROPS);
    let late = campaign::map_of(plan.first_seed, drops, "confirmation", &[()], |_, mut random| {
        let mut scene = Scene::load("rig")?;
        scene.run.duration = WATCHED;
        scene.sensors.levitation_signal = signal;
        let spin = scene.rotor.spin * if random.random() { 1.0 } else { -1.0 };
        let watched = dropped(&plan, scene, spin, &mut random).watch()?;
        let mut events = watched.detection.events.iter();
        let fall = events.find(|it| it.event == EventKind::FreeFall && it.declared_s >= 0.0);
        Ok(fall.and_then(|it| it.confirmed_s).unwrap_or(f64::INFINITY))
    })?;
    let mut scene = Scene::load("rig")?;
    scene.tuning = plan.tuning;
    let seconds = plan.seconds.min(SHOCKS);
    let tripped = campaign::map_of(plan.first_seed, 1, "confirmation", &[()], |_, random| {
        listen(Case::Shock, &scene, signal, seconds, random)
    })?;
    let trips: u32 = tripped.iter().flatten().map(|it| it.confirmed).sum();
    Ok([
        f64::from(trips) * 3600.0 / seconds,
        1e3 * median(&late.concat()),
    ])
}
