//! A rigid rotor that falls and tilts, in several rings.
//!
//! The axis at the place z (from the centre of mass) is displaced by p + z a, with the tilt
//! a = (theta_y, -theta_x). Free tilt turns as a'' = i g w a', g = J_p/J_t, x + iy: forward nutation.
//! Small tilt; unbalance does not act on the spin.

use super::jet::constants;
use super::mode::Mode;
use super::motion::{Moment, Motion};
use super::surroundings::{Body, Magnet, Surroundings};
use super::system::{Hold, Law, Link, System};
use touchdown_base::history::ModelEvent;

/// A ring that does not move.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Ring {
    /// Along the axis from the centre of mass, m.
    pub place: f64,
    /// Of the rotor there, m.
    pub radius: f64,
    /// Radial gap, m.
    pub clearance: f64,
    /// Coulomb's coefficient.
    pub friction: f64,
    /// Coefficient of restitution, 0 to 1.
    pub restitution: f64,
}

/// Directions are those at spin angle 0, counter-clockwise from x.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Unbalance {
    /// Of the centre of mass, m: the force m e w^2.
    pub eccentricity: f64,
    /// rad.
    pub angle: f64,
    /// Of the axis of inertia, rad: the moment (J_t - J_p) chi w^2.
    pub skew: f64,
    /// rad.
    pub skew_angle: f64,
}

/// Rotor and surroundings, SI.
#[derive(Clone, Debug, PartialEq)]
pub struct TwoPlaneMachine {
    /// kg.
    pub mass: f64,
    /// kg m^2.
    pub polar_inertia: f64,
    /// About the centre of mass, kg m^2.
    pub transverse_inertia: f64,
    /// In the plane, m/s^2.
    pub gravity: [f64; 2],
    /// One at least.
    pub rings: Vec<Ring>,
    /// None by default.
    pub unbalance: Unbalance,
    /// Any number.
    pub magnets: Vec<Magnet>,
}

/// The release; places outside a ring are taken back to its wall.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct TwoPlaneStart {
    /// Of the centre of mass, m.
    pub position: [f64; 2],
    /// m/s.
    pub velocity: [f64; 2],
    /// a, rad.
    pub tilt: [f64; 2],
    /// rad/s.
    pub tilt_rate: [f64; 2],
}

impl TwoPlaneStart {
    /// Touching the rings `a` and `b` (by number; the same for one ring, the axis then parallel) at
    /// an angle from the bottom, moving round at `rate` (rad/s), counter-clockwise positive.
    pub fn on_walls(machine: &TwoPlaneMachine, [a, b]: [usize; 2], angle: f64, rate: f64) -> Self {
        let (a, b) = (&machine.rings[a], &machine.rings[b]);
        let slope = match b.place - a.place {
            0.0 => 0.0,
            apart => (b.clearance - a.clearance) / apart,
        };
        let middle = a.clearance - slope * a.place;
        let (sine, cosine) = angle.sin_cos();
        let (outward, along) = ([sine, -cosine], [cosine, sine]);
        Self {
            position: outward.map(|e| e * middle),
            velocity: along.map(|e| e * middle * rate),
            tilt: outward.map(|e| e * slope),
            tilt_rate: along.map(|e| e * slope * rate),
        }
    }
}

/// Everything at one moment, SI.
#[derive(Clone, Debug, PartialEq)]
pub struct TwoPlaneState {
    /// s.
    pub time: f64,
    /// Centre of mass, m.
    pub position: [f64; 2],
    /// m/s.
    pub velocity: [f64; 2],
    /// a, rad.
    pub tilt: [f64; 2],
    /// rad/s.
    pub tilt_rate: [f64; 2],
    /// Counter-clockwise positive, rad/s.
    pub spin: f64,
    /// Since the release, rad.
    pub spin_angle: f64,
    /// In each ring.
    pub modes: Vec<Mode>,
    /// In each ring, N.
    pub normal_forces: Vec<f64>,
    /// Signed turns round each ring since contact began; 0 in flight.
    pub turns_in_contact: Vec<f64>,
    moment: Moment,
}

impl TwoPlaneState {
    /// Displacement of the axis at a place, m.
    pub fn displacement(&self, place: f64) -> [f64; 2] {
        [0, 1].map(|k| self.position[k] + place * self.tilt[k])
    }

    /// Its rate, m/s.
    pub fn displacement_rate(&self, place: f64) -> [f64; 2] {
        [0, 1].map(|k| self.velocity[k] + place * self.tilt_rate[k])
    }
}

/// A drop into several rings, followed from its release.
#[derive(Clone, Debug)]
pub struct TwoPlaneReference {
    motion: Motion<Surroundings>,
}

impl TwoPlaneReference {
    /// At the release; `spin` is counter-clockwise, rad/s.
    pub fn new(machine: &TwoPlaneMachine, start: &TwoPlaneStart, spin: f64) -> Self {
        let least =
            |of: &dyn Fn(&Ring) -> f64| machine.rings.iter().map(of).fold(f64::INFINITY, f64::min);
        let length = least(&|ring| ring.clearance);
        let tilt = least(&|ring| ring.clearance / ring.place.abs());
        let tilt = if tilt.is_finite() { tilt } else { 1.0 };
        let Unbalance {
            eccentricity,
            angle,
            skew,
            skew_angle,
        } = machine.unbalance;
        let couple = (machine.transverse_inertia - machine.polar_inertia) * skew;
        let law = Surroundings {
            polar_inertia: machine.polar_inertia,
            bodies: vec![
                Body {
                    weight: machine.gravity.map(|g| machine.mass * g),
                    turning: (machine.mass * eccentricity, angle),
                    ..Body::default()
                },
                Body {
                    turning: (couple, skew_angle),
                    ..Body::default()
                },
            ],
            magnets: machine
                .magnets
                .iter()
                .map(|magnet| (vec![1.0, magnet.place], *magnet, 0.0))
                .collect(),
            viscous_drags: vec![0.0],
        };
        let link = |ring: &Ring| Link {
            shares: vec![1.0, ring.place],
            arms: vec![ring.radius],
            hold: Hold::Wall {
                clearance: ring.clearance,
                friction: ring.friction,
                restitution: ring.restitution,
            },
            told: vec![1.0, ring.place],
        };
        let (body, tilting) = (1.0 / machine.mass, 1.0 / machine.transverse_inertia);
        let polar = 1.0 / machine.polar_inertia;
        let system = System {
            mobility: vec![body, body, tilting, tilting, polar],
            size: vec![length, length, tilt, tilt, 1.0],
            links: machine.rings.iter().map(link).collect(),
        };
        let coordinates = |[a, b]: [f64; 2], [c, d]: [f64; 2], last| vec![a, b, c, d, last];
        let place = coordinates(start.position, start.tilt, 0.0);
        let speed = coordinates(start.velocity, start.tilt_rate, spin);
        let pulled = law.forces(&constants(&place), &constants(&speed));
        let pull = f64::hypot(pulled[0].value(), pulled[1].value()) / machine.mass;
        let moving = |ring: &Ring| {
            let rate = |k: usize| speed[k] + ring.place * speed[2 + k];
            f64::hypot(rate(0), rate(1))
        };
        let speed_unit = [
            (pull * length).sqrt(),
            machine.rings.iter().map(moving).fold(0.0, f64::max),
            machine
                .rings
                .iter()
                .map(|ring| (ring.radius * spin).abs())
                .fold(0.0, f64::max),
        ]
        .into_iter()
        .find(|speed| *speed > 0.0)
        .unwrap_or(1.0);
        let units = (length / speed_unit, speed_unit);
        Self {
            motion: Motion::new(system, law, units, (place, speed)),
        }
    }

    /// Advances to `time` (finite, s since the release; times must not decrease), reporting every
    /// happening on the way in order: the number of the ring, and what happened, told with the
    /// axis' displacement there.
    pub fn advance(
        &mut self,
        time: f64,
        on_event: &mut impl FnMut(usize, ModelEvent),
    ) -> TwoPlaneState {
        let moment = self.motion.advance(time, on_event);
        let pair = |of: &[f64], first: usize| [of[first], of[first + 1]];
        let (place, speed) = (&moment.place, &moment.speed);
        TwoPlaneState {
            time: moment.time,
            position: pair(place, 0),
            velocity: pair(speed, 0),
            tilt: pair(place, 2),
            tilt_rate: pair(speed, 2),
            spin: speed[4],
            spin_angle: place[4],
            modes: moment.modes.clone(),
            normal_forces: moment.normal.clone(),
            turns_in_contact: moment.turns.clone(),
            moment,
        }
    }

    /// Translation, tilt, spin, gravity and magnets, J.
    pub fn energy(&self, state: &TwoPlaneState) -> f64 {
        self.motion.energy(&state.moment)
    }

    /// When its steps were spent, s; it stays there.
    pub fn given_up(&self) -> Option<f64> {
        self.motion.given_up()
    }

    /// Size of the last terms of the series (1e-18 of the clearance if not set).
    pub fn set_accuracy(&mut self, accuracy: f64) {
        self.motion.set_accuracy(accuracy);
    }
}
