//! What is held of the rungs `support`, `two-plane` and `coupled` at any extreme, watched step by step: no
//! wall is passed, contacts make no energy, and all of it is accounted for.

use touchdown_rotor::error::ConfigError;

use super::extreme::{STEPS, at_step};
use super::row::{Row, Worst};
use super::{epsilon, refused};
use crate::{limits::support, limits::two_plane};
use touchdown_base::failure::Failure;
use touchdown_base::history::Impact;
use touchdown_run::model::coupled::watch;
use touchdown_scene::{Precision, Ring, Scene, Support, TwoPlane};
use touchdown_truth::{Units, simulate};

/// Of a place or an energy, in units of the last digit.
const ROUNDED: f64 = 64.0;

/// Of the first impact's time at an extreme, h^2/T: forces that go round with the spin change within a step. Chosen.
const LATE: f64 = 4.0;

/// Of a random machine's energy of motion, in units of the last digit, a stretch or impact: a whirl turns all of it round. Chosen.
const TURNED: f64 = 16.0;

/// How long the reference runs beyond the model's first impact and what it may be off, s.
const AFTER: f64 = 20e-6;

/// What the place at a random machine's first impact may be off, h^2 times the greatest acceleration: the midpoint rule
/// is of second order. Chosen. A mode of bending turns late by (W h)^2/12 of its angle W t.
const OFF: f64 = 4.0;

/// Of an extreme, s.
const DURATION: f64 = 0.03;

/// All measures of all extremes.
pub fn rows() -> Result<Vec<Row>, Failure> {
    let scenes = support::scenes()?.into_iter().chain(two_plane::scenes()?);
    let mut rows = Vec::new();
    for (name, mut scene) in scenes {
        scene.run.duration = DURATION;
        for precision in super::PRECISIONS {
            rows.extend(of(name, &scene, precision).map_err(refused)?);
        }
    }
    Ok(rows)
}

/// Worst of all steps.
#[derive(Default)]
pub struct Seen {
    random: bool,
    beyond: Worst,
    made: Worst,
    missing: Worst,
    late: Option<Worst>,
    broken: Worst,
}

impl Seen {
    /// Runs a random machine as it is; its first impact is held against the reference's.
    pub fn watch(&mut self, scene: &Scene) -> Result<(), ConfigError> {
        self.random = true;
        if let Some(ours) = look(scene, self)? {
            let late = may_be_late(scene, &ours);
            let truth = first_impact(scene, ours.state.time + late);
            self.impact(scene, &ours, truth, late);
        }
        Ok(())
    }

    /// `truth` is the time of the reference's impact, `late` what ours may be off but for rounding, s.
    fn impact(&mut self, scene: &Scene, ours: &Impact, truth: f64, late: f64) {
        let time = Units::of(scene).time;
        let rounding = ROUNDED * epsilon(scene.model.precision);
        let off = (ours.state.time - truth).abs() / time;
        let worst = self.late.get_or_insert_default();
        worst.take(off, late / time + rounding);
    }

    /// The worse of each measure.
    pub fn worse(mut self, other: Self) -> Self {
        let take = |into: &mut Worst, it: Worst| into.take(it.measured, it.limit);
        take(&mut self.beyond, other.beyond);
        take(&mut self.made, other.made);
        take(&mut self.missing, other.missing);
        self.broken.measured += other.broken.measured;
        if let Some(late) = other.late {
            take(self.late.get_or_insert_default(), late);
        }
        self
    }

    /// One for each measure.
    pub fn rows(&self, name: &str, precision: Precision) -> Vec<Row> {
        let row = |measure: &str| Row::of(format!("{name}: {measure}"), precision);
        let mut rows = vec![
            row("farthest beyond a wall").worst(self.beyond, "of a step's path"),
            row("energy made by contacts").worst(self.made, "m g rho0"),
            row("energy not accounted for").worst(self.missing, "m g rho0"),
            row("steps with NaN or infinity").worst(self.broken, "steps"),
        ];
        let late = row("first impact, off the reference");
        rows.extend(self.late.map(|it| late.worst(it, "T")));
        rows
    }
}

fn of(name: &str, scene: &Scene, precision: Precision) -> Result<Vec<Row>, ConfigError> {
    let mut seen = Seen::default();
    let mut first = None;
    for step in STEPS {
        let scene = at_step(scene, precision, step);
        if let Some(ours) = look(&scene, &mut seen)? {
            let about = ours.state.time;
            let truth = *first.get_or_insert_with(|| first_impact(&scene, about));
            let late = LATE * step * step / Units::of(&scene).time;
            seen.impact(&scene, &ours, truth, late);
        }
    }
    let name = format!("{}: {name}", scene.model.rung);
    Ok(seen.rows(&name, precision))
}

/// Of the reference, s; infinite where it has none at about this time. What follows may be costly.
fn first_impact(scene: &Scene, about: f64) -> f64 {
    let mut scene = scene.clone();
    scene.run.duration = about + AFTER;
    let first = simulate(&scene).impacts.first().map(|it| it.state.time);
    first.unwrap_or(f64::INFINITY)
}

/// What the time of the first impact may be off, s: a path that only grazes meets the wall anywhere.
fn may_be_late(scene: &Scene, impact: &Impact) -> f64 {
    let modes = scene.two_plane.iter().flat_map(|it| &it.modes);
    let fastest = modes.map(|mode| mode.speed).fold(0.0, f64::max);
    let square = scene.model.step * scene.model.step;
    let place = OFF * square * greatest_acceleration(scene);
    place * (1.0 + fastest * impact.state.time / 12.0) / impact.normal_speed
}

/// Of the rotor in any ring before it touches one, m/s^2; an upper bound.
fn greatest_acceleration(scene: &Scene) -> f64 {
    let Some(machine) = &scene.two_plane else {
        return scene.run.gravity;
    };
    let spin = scene.rotor.spin * scene.rotor.spin;
    let stiffness: f64 = machine.magnets.iter().map(|it| it.stiffness.abs()).sum();
    let in_ring = |ring: &Ring| {
        let carried = stiffness * ring.retainer.clearance / scene.rotor.mass;
        let unbalance =
            machine.unbalance.eccentricity + machine.unbalance.skew.abs() * ring.place.abs();
        (scene.run.gravity + carried + spin * unbalance) * rotor_lever(scene, machine, ring)
    };
    machine.rings.iter().map(in_ring).fold(0.0, f64::max)
}

/// Greatest speed in a ring over that of all of the rotor's motion.
fn rotor_lever(scene: &Scene, machine: &TwoPlane, ring: &Ring) -> f64 {
    let mass = scene.rotor.mass;
    let modes = machine.modes.iter();
    let bent: f64 = modes
        .map(|mode| mode.at(ring.place).powi(2) * mass / mode.mass)
        .sum();
    (1.0 + ring.place * ring.place * mass / machine.transverse_inertia + bent).sqrt()
}

/// Greatest speed at any wall over that of all motion, in its clearances.
fn lever(scene: &Scene) -> f64 {
    let yields = |it: Option<Support>| it.map_or(0.0, |it| scene.rotor.mass / it.mass).sqrt();
    let Some(machine) = &scene.two_plane else {
        return yields(scene.support).max(1.0);
    };
    let of = |ring: &Ring| {
        let part = scene.retainer.clearance / ring.retainer.clearance;
        part * rotor_lever(scene, machine, ring).hypot(yields(ring.support))
    };
    machine.rings.iter().map(of).fold(0.0, f64::max)
}

/// Watches one run; its first impact.
fn look(scene: &Scene, seen: &mut Seen) -> Result<Option<Impact>, ConfigError> {
    let epsilon = epsilon(scene.model.precision);
    let (mut start, mut most_gone) = (None, f64::MIN);
    let (mut farthest, mut made, mut missing, mut size) = (0.0_f64, 0.0_f64, 0.0_f64, 0.0_f64);
    let (mut turned_round, mut taken, mut rolled, mut fastest) = (0.0, 0, 0.0_f64, 0.0_f64);
    let (step, lever) = (scene.model.step / Units::of(scene).time, lever(scene));
    let run = watch(scene, &mut |view| {
        let energy = view.energy;
        let (motion, total) = (energy.motion + energy.rings, energy.total());
        let gone = energy.heat + energy.lost + energy.stops;
        let parts = [
            energy.spin + energy.races,
            motion,
            energy.bending + energy.springs + energy.contacts,
            energy.magnets.abs() + energy.driven.abs() + energy.height.abs(),
        ];
        let mut all = [view.beyond, total, gone].into_iter().chain(parts);
        seen.broken.measured += f64::from(u8::from(all.any(|number| !number.is_finite())));
        most_gone = most_gone.max(gone);
        made = made.max(most_gone - gone);
        fastest = fastest.max((2.0 * motion).sqrt());
        turned_round += motion * (view.taken - taken) as f64;
        taken = view.taken;
        rolled = rolled.max(energy.races);
        let path = step * (fastest + step) * lever + ROUNDED * epsilon;
        farthest = farthest.max(view.beyond / path);
        missing = missing.max((total - *start.get_or_insert(total)).abs());
        size = size.max(parts.iter().fold(gone.abs(), |sum, it| sum + it.abs()));
    })?;
    if !seen.random {
        (turned_round, rolled) = (0.0, 0.0);
    }
    let rounded = epsilon * (ROUNDED * size + TURNED * turned_round);
    let rounding = super::rounding(scene.model.precision) + rounded;
    seen.beyond.take(farthest, 1.0);
    // Slip is stopped at the end of a step, not in its mean: off by the square of the angle that it turns.
    let turned = step * fastest;
    seen.made.take(
        made,
        rounding + 0.25 * turned * turned * (fastest * fastest + 2.0 * rolled),
    );
    seen.missing.take(missing, rounding);
    Ok(run.histories.whole.impacts.into_iter().next())
}
