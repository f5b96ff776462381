//! Rungs `support`, `two-plane` and `coupled`: a rotor that moves across its axis, tilts and bends, in rings of
//! their own axial places, each rigid or on a spring and a damper, each a bushing or a ball bearing.
//!
//! The axis at z is at p + z a + sum of phi_k(z) eta_k. In units of the model every one of these
//! coordinates has the rotor's mass, so that a place on the axis is a row of numbers b, its shape: its
//! displacement is b . X, and an impulse there moves another place by b . b'. `Q` coordinates: the centre, the
//! tilt, and one for each bending mode; 1 for a rotor that does not tilt. What a ring has not is not computed.
//!
//! Solved by time-stepping: the midpoint rule for all that is smooth, with the walls that are in permanent
//! contact in it (`passage`); impacts at the moments that a step shows (`follow`, `strike`); all walls that
//! touch at once together (`links`). Equations and limits: docs/know/coupled.md.

// Coordinates and rings are counted alike in several arrays.
#![allow(clippy::needless_range_loop)]

mod beyond;
mod compliant;
mod config;
mod energy;
mod follow;
mod links;
mod magnets;
mod mount;
mod normals;
mod passage;
mod race;
mod settle;
mod state;
mod strike;
mod vector;
mod whole;

pub use compliant::CompliantConfig;
pub use config::{
    ActuatorConfig, BaseConfig, CoupledConfig, ModeConfig, RingConfig, UnbalanceConfig,
};
pub use energy::CoupledEnergy;
pub use mount::{MountConfig, StopConfig};
pub use race::{RaceConfig, RaceMotion};
pub use state::{CoupledState, Load, Placement, RingEvent, RingMotion};
pub use whole::Whole;

use compliant::Compliant;
use config::MODES;
use magnets::Magnet;
use mount::Sprung;
use race::BallBearing;
use touchdown_rotor::precision::Precision;
use touchdown_rotor::real::Real;
use touchdown_rotor::scales::Scales;
use vector::Vector;

/// Most magnetic bearings: two planes of them, as they are left and as they come back.
const MAGNETS: usize = 4;

#[derive(Clone, Copy, Debug, PartialEq)]
struct Ring<R, const Q: usize> {
    shape: [R; Q],
    /// Clearance, of the first ring's.
    limit: R,
    /// Rotor radius, of the first ring's.
    surface: R,
    friction: R,
    restitution: R,
    /// In place of restitution.
    compliant: Option<Compliant<R>>,
    mount: Option<Sprung<R>>,
    race: Option<BallBearing<R>>,
}

/// A base that goes to and fro: the acceleration that all on it feels, from which it is seen.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Base<R> {
    /// Times the cosine of its angle.
    push: Vector<R>,
    rate: R,
    phase: R,
}

/// Coefficients of the model; `N` rings, `Q` coordinates.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Coupled<R, const N: usize, const Q: usize> {
    rings: [Ring<R, Q>; N],
    /// J_p/(m r^2) at the first ring.
    inertia_ratio: R,
    /// Rate of nutation for a spin of 1.
    gyration: R,
    /// Angular speed of a spin of 1.
    turn: R,
    gravity: Vector<R>,
    magnets: [Option<Magnet<R, Q>>; MAGNETS],
    base: Option<Base<R>>,
    /// Of each coordinate by itself: a bending mode's frequency and damping.
    frequency: [R; Q],
    decay: [R; Q],
    /// Shape of a mode in the model over that in the configuration.
    mode_scale: [R; Q],
    /// Unbalance in each coordinate, on the rotor.
    weight: [Vector<R>; Q],
    /// Whether a stretch is solved by repetition: inner rings, dry friction of mounts, magnets with a limit.
    repeats: bool,
    /// Length of a step, T.
    step: R,
    /// Tilt of 1, rad.
    tilt: R,
    scales: Scales<R>,
}

/// What turns SI into the model's units: of the rotor and one of its rings.
struct Units {
    mass: f64,
    /// Of the rotor at the first ring, m.
    radius: f64,
    /// Of the retainer, m.
    bore: f64,
    /// Length of a step, T.
    step: f64,
    scales: Scales<f64>,
}

/// Displacement of a place from the coordinates.
fn at<R: Real, const Q: usize>(shape: &[R; Q], of: &[Vector<R>; Q]) -> Vector<R> {
    let terms = shape.iter().zip(of);
    terms.fold(Vector::default(), |sum, (b, x)| sum + x.times(*b))
}

/// The shape of a place that tilts by `zeta`, with each mode's displacement there.
fn shape_of<R: Real, const Q: usize>(scale: [R; Q], zeta: R, modes: [R; MODES]) -> [R; Q] {
    let mut shape = scale;
    for (b, mode) in shape.iter_mut().skip(2).zip(modes) {
        *b *= mode;
    }
    for (b, rigid) in shape.iter_mut().zip([R::ONE, zeta]) {
        *b = rigid;
    }
    shape
}

fn product<R: Real, const Q: usize>(a: &[R; Q], b: &[R; Q]) -> R {
    a.iter().zip(b).fold(R::ZERO, |sum, (a, b)| sum + *a * *b)
}

impl<R: Precision, const N: usize, const Q: usize> Coupled<R, N, Q> {
    /// The model's units, those of the first ring.
    pub fn scales(&self) -> &Scales<R> {
        &self.scales
    }

    /// Unit of the tilt, rad: the tilt that displaces the axis by a clearance at the radius of gyration.
    pub fn tilt_scale(&self) -> R {
        self.tilt
    }

    /// A place on the axis, m from the centre of mass, with each mode's displacement there.
    pub fn shape_at(&self, place: R, modes: [R; MODES]) -> [R; Q] {
        shape_of(
            self.mode_scale,
            place * self.tilt / self.scales.length,
            modes,
        )
    }
}
