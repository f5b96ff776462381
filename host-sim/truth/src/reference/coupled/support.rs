//! A rotor in a retainer ring on a spring and a damper, with an inner ring that turns.

use super::mode::Mode;
use super::motion::{Moment, Motion};
use super::surroundings::{Body, Surroundings};
use super::system::{Hold, Link, System};
use crate::reference::scale::Scale;
use touchdown_base::history::ModelEvent;
use touchdown_base::machine::{Machine, Start};

/// What the retainer ring stands on.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Mount {
    /// Of the ring, kg.
    pub mass: f64,
    /// Spring, N/m.
    pub stiffness: f64,
    /// Damper, N s/m.
    pub damping: f64,
    /// Way of the ring from its rest place to a hard stop, m: without friction and rebound.
    pub travel: Option<f64>,
}

/// Inner ring of a ball bearing, with the clearance added to the rotor's radius as its bore.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Race {
    /// kg m^2.
    pub inertia: f64,
    /// Drag that doesn't depend on the speed, and holds at rest, N m.
    pub dry_drag: f64,
    /// Drag over speed, N m s.
    pub viscous_drag: f64,
}

/// Rotor and retainer, SI; without mount the ring is fixed, without race it doesn't turn.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SupportMachine {
    /// Rotor, gap and gravity.
    pub rotor: Machine,
    /// Under the ring.
    pub mount: Option<Mount>,
    /// In the ring.
    pub race: Option<Race>,
}

/// The release; the ring's place counts from where it rests under its own weight.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SupportStart {
    /// The rotor: where it is free its position is in space, on the wall its angle and its
    /// tangential speed are those in the ring.
    pub rotor: Start,
    /// Counter-clockwise, rad/s.
    pub spin: f64,
    /// m.
    pub ring_position: [f64; 2],
    /// m/s.
    pub ring_velocity: [f64; 2],
    /// Spin of the inner ring, rad/s.
    pub race_spin: f64,
}

impl SupportStart {
    /// With the ring at rest.
    pub fn new(rotor: Start, spin: f64) -> Self {
        Self {
            rotor,
            spin,
            ring_position: [0.0; 2],
            ring_velocity: [0.0; 2],
            race_spin: 0.0,
        }
    }
}

/// Everything at one moment, SI.
#[derive(Clone, Debug, PartialEq)]
pub struct SupportState {
    /// s.
    pub time: f64,
    /// Rotor centre in space, m.
    pub position: [f64; 2],
    /// m/s.
    pub velocity: [f64; 2],
    /// rad/s.
    pub spin: f64,
    /// Ring, from its rest place, m.
    pub ring_position: [f64; 2],
    /// m/s.
    pub ring_velocity: [f64; 2],
    /// Inner ring, rad/s.
    pub race_spin: f64,
    /// Angle that the inner ring has turned since the release, rad.
    pub race_angle: f64,
    /// Of the rotor in the ring, and of the ring at its stop.
    pub modes: [Mode; 2],
    /// Between the same, N.
    pub normal_forces: [f64; 2],
    /// Signed turns of the rotor round the ring since contact began; 0 in flight.
    pub turns_in_contact: f64,
    moment: Moment,
}

impl SupportState {
    /// Displacement of the rotor in the ring, m.
    pub fn displacement(&self) -> [f64; 2] {
        [0, 1].map(|k| self.position[k] - self.ring_position[k])
    }

    /// Its rate, m/s.
    pub fn displacement_rate(&self) -> [f64; 2] {
        [0, 1].map(|k| self.velocity[k] - self.ring_velocity[k])
    }
}

/// A drop onto a support, followed from its release.
///
/// Happenings of contact 0 are those of the rotor in the ring, told with the rotor's position in
/// space; those of contact 1 are the ring's at its stop, told with the ring's position.
#[derive(Clone, Debug)]
pub struct SupportReference {
    motion: Motion<Surroundings>,
}

impl SupportReference {
    /// At the release.
    pub fn new(machine: &SupportMachine, start: &SupportStart) -> Self {
        let SupportMachine { rotor, mount, race } = machine;
        let scale = Scale::new(rotor, &start.rotor, start.spin);
        let bore = rotor.radius + rotor.clearance;
        let mut links = vec![Link {
            shares: vec![1.0, -1.0],
            arms: vec![rotor.radius, -bore],
            hold: Hold::Wall {
                clearance: rotor.clearance,
                friction: rotor.friction,
                restitution: rotor.restitution,
            },
            told: vec![1.0, 0.0],
        }];
        links.extend(mount.and_then(|mount| mount.travel).map(|travel| Link {
            shares: vec![0.0, 1.0],
            arms: vec![0.0; 2],
            hold: Hold::Wall {
                clearance: travel,
                friction: 0.0,
                restitution: 0.0,
            },
            told: vec![0.0, 1.0],
        }));
        let dry = race.map_or(0.0, |race| race.dry_drag);
        links.extend((dry > 0.0).then_some(Link {
            shares: vec![0.0; 2],
            arms: vec![0.0, bore],
            hold: Hold::Brake(dry / bore),
            told: vec![0.0; 2],
        }));
        let (body, ring) = (
            1.0 / rotor.mass,
            mount.map_or(0.0, |mount| 1.0 / mount.mass),
        );
        let system = System {
            mobility: vec![
                body,
                body,
                ring,
                ring,
                1.0 / rotor.polar_inertia,
                race.map_or(0.0, |race| 1.0 / race.inertia),
            ],
            size: vec![
                scale.length,
                scale.length,
                scale.length,
                scale.length,
                1.0,
                1.0,
            ],
            links,
        };
        let law = Surroundings {
            polar_inertia: 0.0,
            bodies: vec![
                Body {
                    weight: [0.0, -rotor.mass * rotor.gravity],
                    ..Body::default()
                },
                Body {
                    stiffness: mount.map_or(0.0, |mount| mount.stiffness),
                    damping: mount.map_or(0.0, |mount| mount.damping),
                    ..Body::default()
                },
            ],
            magnets: Vec::new(),
            viscous_drags: vec![0.0, race.map_or(0.0, |race| race.viscous_drag)],
        };
        let motion = Motion::new(
            system,
            law,
            (scale.time, scale.speed),
            coordinates(machine, start),
        );
        Self { motion }
    }

    /// Advances to `time` (finite, s since the release; times must not decrease), reporting every
    /// happening on the way in order.
    pub fn advance(
        &mut self,
        time: f64,
        on_event: &mut impl FnMut(usize, ModelEvent),
    ) -> SupportState {
        let moment = self.motion.advance(time, on_event);
        let pair = |of: &[f64], first: usize| [of[first], of[first + 1]];
        let (place, speed) = (&moment.place, &moment.speed);
        let stop = self.motion.walls() > 1;
        SupportState {
            time: moment.time,
            position: pair(place, 0),
            velocity: pair(speed, 0),
            spin: speed[4],
            ring_position: pair(place, 2),
            ring_velocity: pair(speed, 2),
            race_spin: speed[5],
            race_angle: place[5],
            modes: [
                moment.modes[0],
                if stop { moment.modes[1] } else { Mode::Flight },
            ],
            normal_forces: [moment.normal[0], if stop { moment.normal[1] } else { 0.0 }],
            turns_in_contact: moment.turns[0],
            moment,
        }
    }

    /// Translation, spin, height and spring, J.
    pub fn energy(&self, state: &SupportState) -> f64 {
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

fn coordinates(machine: &SupportMachine, start: &SupportStart) -> (Vec<f64>, Vec<f64>) {
    let ([u, v], [du, dv]) = match machine.mount {
        Some(_) => (start.ring_position, start.ring_velocity),
        None => ([0.0; 2], [0.0; 2]),
    };
    let race_spin = machine.race.map_or(0.0, |_| start.race_spin);
    let ([x, y], [vx, vy]) = match start.rotor {
        Start::Free { position, velocity } => (position, velocity),
        Start::Wall { angle, tangential } => {
            let (sine, cosine) = angle.sin_cos();
            let clearance = machine.rotor.clearance;
            (
                [u + clearance * sine, v - clearance * cosine],
                [du + tangential * cosine, dv + tangential * sine],
            )
        }
    };
    (
        vec![x, y, u, v, 0.0, 0.0],
        vec![vx, vy, du, dv, start.spin, race_spin],
    )
}
