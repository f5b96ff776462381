//! A rotor that falls, tilts and bends, in rings that may stand on mounts and turn in ball bearings.
//!
//! The axis at the place z is displaced by r(z) = p + z a + sum of phi_k(z) eta_k, with the tilt
//! a = (theta_y, -theta_x) and the modes' coordinates eta_k. A ring's place u counts from where it
//! rests under its own weight; r - u is what its clearance bounds.
//!
//! Limits: the damping of bending is taken in the frame that does not turn (no instability above a
//! critical speed), a mode is not split by its gyroscopic effect, a couple unbalance bends nothing,
//! small tilt, unbalance does not act on the spin, and a magnet's force has no limit.

use super::jet::constants;
use super::mode::Mode;
use super::motion::{Moment, Motion};
use super::support::{Mount, Race};
use super::surroundings::{Body, Magnet, Surroundings};
use super::system::{Hold, Law, Link, System};
use super::two_plane::{Ring, Unbalance};
use touchdown_base::history::ModelEvent;

/// A ring and what holds it; without mount it is fixed, without race it doesn't turn.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Retainer {
    /// Place, gap and contact.
    pub ring: Ring,
    /// Under the ring.
    pub mount: Option<Mount>,
    /// In the ring.
    pub race: Option<Race>,
}

/// A bending mode of the free rotor.
#[derive(Clone, Debug, PartialEq)]
pub struct Bending {
    /// Undamped, rad/s.
    pub rate: f64,
    /// Part of critical damping.
    pub damping_ratio: f64,
    /// With the shapes below, kg.
    pub modal_mass: f64,
    /// At each ring.
    pub at_rings: Vec<f64>,
    /// At each magnet.
    pub at_magnets: Vec<f64>,
    /// At the centre of mass.
    pub at_centre: f64,
}

/// Rotor and surroundings, SI.
#[derive(Clone, Debug, PartialEq)]
pub struct CoupledMachine {
    /// kg.
    pub mass: f64,
    /// kg m^2.
    pub polar_inertia: f64,
    /// About the centre of mass, kg m^2.
    pub transverse_inertia: f64,
    /// In the plane, m/s^2.
    pub gravity: [f64; 2],
    /// One at least.
    pub retainers: Vec<Retainer>,
    /// None by default.
    pub unbalance: Unbalance,
    /// Each with its damping, force against the axis' speed, N s/m.
    pub magnets: Vec<(Magnet, f64)>,
    /// Any number.
    pub bending: Vec<Bending>,
}

/// The release; places outside a ring are taken back to its wall. The rotor is straight, and all that
/// surrounds it at rest, where a list is shorter than the machine's.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct CoupledStart {
    /// Of the centre of mass, m.
    pub position: [f64; 2],
    /// m/s.
    pub velocity: [f64; 2],
    /// a, rad.
    pub tilt: [f64; 2],
    /// rad/s.
    pub tilt_rate: [f64; 2],
    /// Of each mode, and their rates.
    pub bending: Vec<[[f64; 2]; 2]>,
    /// Of each ring with a mount (the others are fixed), m, and their rates.
    pub rings: Vec<[[f64; 2]; 2]>,
    /// Of each inner ring (those without a race don't turn), rad/s.
    pub race_spins: Vec<f64>,
}

/// A ring at one moment, SI; zeros where it can't move.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct RingState {
    /// From its rest place, m.
    pub position: [f64; 2],
    /// m/s.
    pub velocity: [f64; 2],
    /// Of the rotor in it, m.
    pub displacement: [f64; 2],
    /// m/s.
    pub displacement_rate: [f64; 2],
    /// Inner ring, rad/s.
    pub race_spin: f64,
    /// Turned by the inner ring since the release, rad.
    pub race_angle: f64,
}

/// Everything at one moment, SI.
#[derive(Clone, Debug, PartialEq)]
pub struct CoupledState {
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
    /// Of each mode.
    pub bending: Vec<[f64; 2]>,
    /// Of each ring.
    pub rings: Vec<RingState>,
    /// In each ring, then at each stop.
    pub modes: Vec<Mode>,
    /// Of the same, N.
    pub normal_forces: Vec<f64>,
    /// Signed turns round each of them since contact began; 0 in flight.
    pub turns_in_contact: Vec<f64>,
    moment: Moment,
}

impl CoupledState {
    /// Displacement of the axis at a place where the modes have these shapes, m.
    pub fn displacement(&self, place: f64, shapes: &[f64]) -> [f64; 2] {
        let straight = [0, 1].map(|k| self.position[k] + place * self.tilt[k]);
        let modes = self.bending.iter().zip(shapes);
        modes.fold(straight, |[x, y], (bent, shape)| {
            [x + shape * bent[0], y + shape * bent[1]]
        })
    }
}

/// A drop, followed from its release.
///
/// Happenings of contact i are those of the rotor in ring i, told with the axis' displacement there in
/// space; then come the stops, of the rings that have one, told with the ring's position.
#[derive(Clone, Debug)]
pub struct CoupledReference {
    motion: Motion<Surroundings>,
    /// Displacements in the rings.
    rings: Vec<Link>,
    bending: usize,
}

impl CoupledMachine {
    fn bodies(&self) -> usize {
        2 + self.bending.len() + self.retainers.len()
    }

    /// Parts of the bodies in the displacement of the axis.
    fn axis(&self, place: f64, shape: impl Fn(&Bending) -> f64) -> Vec<f64> {
        let mut shares = vec![1.0, place];
        shares.extend(self.bending.iter().map(shape));
        shares.resize(self.bodies(), 0.0);
        shares
    }

    /// Walls of the rings, of the stops, and brakes.
    fn links(&self) -> Vec<Link> {
        let (mut walls, mut stops, mut brakes) = (Vec::new(), Vec::new(), Vec::new());
        for (i, Retainer { ring, mount, race }) in self.retainers.iter().enumerate() {
            let body = 2 + self.bending.len() + i;
            let bore = ring.radius + ring.clearance;
            let none = vec![0.0; self.bodies()];
            let still = vec![0.0; 1 + self.retainers.len()];
            let with = |mut of: Vec<f64>, index: usize, value: f64| {
                of[index] = value;
                of
            };
            let told = self.axis(ring.place, |mode| mode.at_rings[i]);
            walls.push(Link {
                shares: with(told.clone(), body, -1.0),
                arms: with(with(still.clone(), 0, ring.radius), 1 + i, -bore),
                hold: Hold::Wall {
                    clearance: ring.clearance,
                    friction: ring.friction,
                    restitution: ring.restitution,
                },
                told,
            });
            stops.extend(mount.and_then(|mount| mount.travel).map(|travel| Link {
                shares: with(none.clone(), body, 1.0),
                arms: still.clone(),
                hold: Hold::Wall {
                    clearance: travel,
                    friction: 0.0,
                    restitution: 0.0,
                },
                told: with(none.clone(), body, 1.0),
            }));
            let dry = race.map_or(0.0, |race| race.dry_drag);
            brakes.extend((dry > 0.0).then(|| Link {
                shares: none.clone(),
                arms: with(still, 1 + i, bore),
                hold: Hold::Brake(dry / bore),
                told: none,
            }));
        }
        [walls, stops, brakes].concat()
    }

    fn surroundings(&self) -> Surroundings {
        let centre = self.mass * self.unbalance.eccentricity;
        let angle = self.unbalance.angle;
        let couple = (self.transverse_inertia - self.polar_inertia) * self.unbalance.skew;
        let mut bodies = vec![
            Body {
                weight: self.gravity.map(|g| self.mass * g),
                turning: (centre, angle),
                ..Body::default()
            },
            Body {
                turning: (couple, self.unbalance.skew_angle),
                ..Body::default()
            },
        ];
        bodies.extend(self.bending.iter().map(|mode| Body {
            stiffness: mode.modal_mass * mode.rate * mode.rate,
            damping: 2.0 * mode.damping_ratio * mode.modal_mass * mode.rate,
            turning: (mode.at_centre * centre, angle),
            ..Body::default()
        }));
        bodies.extend(self.retainers.iter().map(|it| Body {
            stiffness: it.mount.map_or(0.0, |mount| mount.stiffness),
            damping: it.mount.map_or(0.0, |mount| mount.damping),
            ..Body::default()
        }));
        let magnet = |(i, (magnet, damping)): (usize, &(Magnet, f64))| {
            let shares = self.axis(magnet.place, |mode| mode.at_magnets[i]);
            (shares, *magnet, *damping)
        };
        let drags = self
            .retainers
            .iter()
            .map(|it| it.race.map_or(0.0, |race| race.viscous_drag));
        Surroundings {
            polar_inertia: self.polar_inertia,
            bodies,
            magnets: self.magnets.iter().enumerate().map(magnet).collect(),
            viscous_drags: [0.0].into_iter().chain(drags).collect(),
        }
    }

    fn system(&self, length: f64) -> System {
        let both = |values: Vec<f64>| values.into_iter().flat_map(|value| [value; 2]);
        let over = |of: Option<f64>| of.map_or(0.0, |of| 1.0 / of);
        let reach = |parts: &mut dyn Iterator<Item = f64>| {
            let largest = parts.map(f64::abs).fold(0.0, f64::max);
            if largest > 0.0 { length / largest } else { 1.0 }
        };
        let mut mobility = vec![1.0 / self.mass, 1.0 / self.transverse_inertia];
        let mut size = vec![
            length,
            reach(&mut self.retainers.iter().map(|it| it.ring.place)),
        ];
        for mode in &self.bending {
            mobility.push(1.0 / mode.modal_mass);
            size.push(reach(&mut mode.at_rings.iter().copied()));
        }
        for it in &self.retainers {
            mobility.push(over(it.mount.map(|mount| mount.mass)));
            size.push(length);
        }
        let races = self
            .retainers
            .iter()
            .map(|it| over(it.race.map(|race| race.inertia)));
        let spins = [1.0 / self.polar_inertia].into_iter().chain(races);
        System {
            mobility: both(mobility).chain(spins).collect(),
            size: both(size)
                .chain(vec![1.0; 1 + self.retainers.len()])
                .collect(),
            links: self.links(),
        }
    }

    /// Coordinates and their rates.
    fn coordinates(&self, start: &CoupledStart, spin: f64) -> [Vec<f64>; 2] {
        [0, 1].map(|rate| {
            let rotor = [
                [start.position, start.tilt],
                [start.velocity, start.tilt_rate],
            ][rate];
            let mut of = rotor.concat();
            for k in 0..self.bending.len() {
                of.extend(start.bending.get(k).map_or([0.0; 2], |it| it[rate]));
            }
            for (k, it) in self.retainers.iter().enumerate() {
                let ring = start.rings.get(k).filter(|_| it.mount.is_some());
                of.extend(ring.map_or([0.0; 2], |it| it[rate]));
            }
            let turning = rate as f64;
            of.push(turning * spin);
            for (k, it) in self.retainers.iter().enumerate() {
                let race = start.race_spins.get(k).filter(|_| it.race.is_some());
                of.push(turning * race.copied().unwrap_or(0.0));
            }
            of
        })
    }
}

impl CoupledReference {
    /// At the release; `spin` is counter-clockwise, rad/s.
    pub fn new(machine: &CoupledMachine, start: &CoupledStart, spin: f64) -> Self {
        let rings = || machine.retainers.iter().map(|it| it.ring);
        let length = rings()
            .map(|ring| ring.clearance)
            .fold(f64::INFINITY, f64::min);
        let (law, system) = (machine.surroundings(), machine.system(length));
        let [place, speed] = machine.coordinates(start, spin);
        let pulled = law.forces(&constants(&place), &constants(&speed));
        let pull = f64::hypot(pulled[0].value(), pulled[1].value()) / machine.mass;
        let walls = system.links[..machine.retainers.len()].to_vec();
        let moving = walls.iter().map(|link| {
            let [x, y] = link.lateral(&speed);
            f64::hypot(x, y)
        });
        let unit = [
            (pull * length).sqrt(),
            moving.fold(0.0, f64::max),
            rings()
                .map(|ring| (ring.radius * spin).abs())
                .fold(0.0, f64::max),
        ];
        let unit = unit.into_iter().find(|speed| *speed > 0.0).unwrap_or(1.0);
        Self {
            motion: Motion::new(system, law, (length / unit, unit), (place, speed)),
            rings: walls,
            bending: machine.bending.len(),
        }
    }

    /// Advances to `time` (finite, s since the release; times must not decrease), reporting every
    /// happening on the way in order.
    pub fn advance(
        &mut self,
        time: f64,
        on_event: &mut impl FnMut(usize, ModelEvent),
    ) -> CoupledState {
        let moment = self.motion.advance(time, on_event);
        let (place, speed) = (&moment.place, &moment.speed);
        let of = |of: &[f64], body: usize| [of[2 * body], of[2 * body + 1]];
        let (first, walls) = (2 + self.bending, self.motion.walls());
        let spins = 2 * (first + self.rings.len());
        let ring = |(i, link): (usize, &Link)| RingState {
            position: of(place, first + i),
            velocity: of(speed, first + i),
            displacement: link.lateral(place),
            displacement_rate: link.lateral(speed),
            race_spin: speed[spins + 1 + i],
            race_angle: place[spins + 1 + i],
        };
        CoupledState {
            time: moment.time,
            position: of(place, 0),
            velocity: of(speed, 0),
            tilt: of(place, 1),
            tilt_rate: of(speed, 1),
            spin: speed[spins],
            spin_angle: place[spins],
            bending: (2..first).map(|k| of(place, k)).collect(),
            rings: self.rings.iter().enumerate().map(ring).collect(),
            modes: moment.modes[..walls].to_vec(),
            normal_forces: moment.normal[..walls].to_vec(),
            turns_in_contact: moment.turns[..walls].to_vec(),
            moment,
        }
    }

    /// Translation, tilt, bending, rings, spins, gravity, mounts and magnets, J.
    pub fn energy(&self, state: &CoupledState) -> f64 {
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
