//! Dry friction between a ring and the housing that it lies on, in any direction of the plane.
//!
//! At rest the ring is held by as much as it takes, up to the limit. A ring on its rigid stop is held along the stop only:
//! what presses it on the stop is the stop's. One that gives way pushes the ring as its mount does. The sliding ring is
//! braked by the limit, against its motion.
//!
//! Cut-off: it comes to rest where it is slower than 1e-7 of the unit of speed, and sets off with twice that, in the
//! direction in which it pulled. Where it is not held at that speed it goes on so. The direction of a slow slide follows
//! the force within m v/F, which bounds the steps: a run with a lower cut-off would not end where the force turns.

use super::super::jet::{Jet, dot};
use super::system::{Hold, Mode, System};
use super::tape::Term;
use super::unknown::Unknown;
use std::f64::consts::SQRT_2;

/// Speed at which a sliding ring is at rest, in units of speed.
pub const SLOWEST: f64 = 1e-7;
/// Speed with which it sets off, in cut-offs.
const SET_OFF: f64 = 2.0;

/// Of a seat in a system: that of a ring, and the number of its link.
#[derive(Clone, Copy, Debug)]
pub struct SeatLink {
    /// Number of the link.
    pub link: usize,
    /// Greatest force, N.
    pub limit: f64,
    stop: Option<usize>,
}

impl SeatLink {
    /// All of a system.
    pub fn all(system: &System) -> impl Iterator<Item = Self> {
        let links = system.links.iter().enumerate();
        links.filter_map(|(link, it)| match it.hold {
            Hold::Seat { limit, stop } => Some(Self { link, limit, stop }),
            _ => None,
        })
    }

    /// Those of which the ring slides.
    pub fn sliding(system: &System) -> impl Iterator<Item = Self> {
        Self::all(system).filter(|it| system.links[it.link].mode != Mode::Stick)
    }

    /// In which the ring at rest is held.
    pub fn directions(&self, system: &System, place: &[f64]) -> Vec<[f64; 2]> {
        let stop = self.stop.map(|stop| &system.links[stop]);
        match stop.filter(|stop| stop.mode != Mode::Flight) {
            Some(stop) => {
                let [x, y] = stop.lateral(place);
                let distance = f64::hypot(x, y);
                vec![[-y / distance, x / distance]]
            }
            None => vec![[1.0, 0.0], [0.0, 1.0]],
        }
    }

    /// Speed of the ring, m/s.
    pub fn speed(&self, system: &System, speed: &[f64]) -> f64 {
        let [x, y] = system.links[self.link].lateral(speed);
        f64::hypot(x, y)
    }

    /// The velocity with which it sets off where this force would be needed to hold it, m/s.
    pub fn set_off([x, y]: [f64; 2], slowest: f64) -> [f64; 2] {
        let size = f64::hypot(x, y);
        [x, y].map(|part| -SET_OFF * slowest * part / size)
    }

    /// Whether a motion that has fallen to the cut-off along what was its direction is at rest.
    pub fn stops(&self, system: &System, speed: &[f64], slowest: f64) -> bool {
        self.speed(system, speed) <= SQRT_2 * slowest
    }

    /// The unknown forces that hold the ring at rest.
    pub fn hold<'t>(&self, system: &System, place: &[Term<'t>]) -> Vec<Unknown<'t>> {
        let values: Vec<f64> = place.iter().map(Term::value).collect();
        let directions = self.directions(system, &values);
        let held = |direction: [f64; 2]| {
            Unknown::at_rest(self.link, direction.map(|part| place[0].constant(part)))
        };
        directions.into_iter().map(held).collect()
    }

    /// Adds the sliding ring's friction to the accelerations.
    pub fn brake<'t>(&self, system: &System, speed: &[Term<'t>], acceleration: &mut [Term<'t>]) {
        let w = system.links[self.link].lateral(speed);
        let slowness = dot(&w, &w).power(-0.5);
        let direction = w.map(|part| part * slowness);
        for (i, part) in system.moved(self.link) {
            acceleration[i] = acceleration[i] + direction[i % 2] * (-self.limit * part);
        }
    }

    /// Falls below zero where the ring at rest is held no longer; in parts of the limit, squared.
    pub fn spare(&self, held: &[Jet; 2]) -> Jet {
        let held = held.map(|part| part * (1.0 / self.limit));
        Jet::constant(1.0) - dot(&held, &held)
    }

    /// Falls below zero where the ring has no more than the cut-off of its speed in the direction that it has at the start.
    pub fn haste(&self, system: &System, speed: &[Jet], slowest: f64) -> Jet {
        let w = system.links[self.link].lateral(speed);
        let [x, y] = w.map(|part| part.at(0.0));
        let size = f64::hypot(x, y);
        w[0] * (x / size) + w[1] * (y / size) - Jet::constant(slowest)
    }

    /// Time in which the force on the sliding ring would stop it or turn it, s.
    pub fn time(&self, system: &System, speed: &[f64], acceleration: &[f64]) -> f64 {
        self.speed(system, speed) / self.speed(system, acceleration)
    }
}
