//! A drop of a machine: how it is released, and what it does.

use super::machine::CoupledMachine;
use super::motion::Motion;
use super::system::{Coordinates, Link, Mode};
use super::tape::Tape;
use touchdown_base::history::ModelEvent;
use touchdown_base::machine::Start;

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

impl CoupledStart {
    /// Without tilt; on a wall, that of a ring at rest with this clearance (m).
    pub fn level(rotor: &Start, clearance: f64) -> Self {
        let [position, velocity] = match *rotor {
            Start::Free { position, velocity } => [position, velocity],
            Start::Wall { angle, tangential } => {
                let (sine, cosine) = angle.sin_cos();
                [
                    [clearance * sine, -clearance * cosine],
                    [tangential * cosine, tangential * sine],
                ]
            }
        };
        Self {
            position,
            velocity,
            ..Self::default()
        }
    }

    fn coordinates(&self, machine: &CoupledMachine, spin: f64) -> Coordinates {
        let [place, speed] = [0, 1].map(|rate| {
            let rotor = [[self.position, self.tilt], [self.velocity, self.tilt_rate]][rate];
            let mut of = rotor.concat();
            for k in 0..machine.bending.len() {
                of.extend(self.bending.get(k).map_or([0.0; 2], |it| it[rate]));
            }
            for (k, it) in machine.retainers.iter().enumerate() {
                let ring = self.rings.get(k).filter(|_| it.mount.is_some());
                of.extend(ring.map_or([0.0; 2], |it| it[rate]));
            }
            let turning = rate as f64;
            of.push(turning * spin);
            for (k, it) in machine.retainers.iter().enumerate() {
                let race = self.race_spins.get(k).filter(|_| it.race.is_some());
                of.push(turning * race.copied().unwrap_or(0.0));
            }
            of.extend(machine.base.map(|base| [base.phase, base.rate][rate]));
            of
        });
        Coordinates { place, speed }
    }
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
    at: Coordinates,
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
    motion: Motion,
    rings: usize,
    bending: usize,
}

impl CoupledReference {
    /// At the release; `spin` is counter-clockwise, rad/s.
    pub fn new(machine: &CoupledMachine, start: &CoupledStart, spin: f64) -> Self {
        let rings = machine.retainers.iter();
        let clearances = rings.clone().map(|ring| ring.clearance);
        let length = clearances.fold(f64::INFINITY, f64::min);
        let (mut surroundings, system) = (machine.surroundings(), machine.system(length));
        let release = start.coordinates(machine, spin);
        surroundings.cut_off(&release);
        let tape = Tape::new();
        let pulled = surroundings.forces(&release.map(|value| tape.given(*value)));
        let pull = f64::hypot(pulled[0].value(), pulled[1].value()) / machine.mass;
        let moving = system.links[..machine.retainers.len()].iter().map(|link| {
            let [x, y] = link.lateral(&release.speed);
            f64::hypot(x, y)
        });
        let turning = rings.map(|ring| (ring.radius * spin).abs());
        let unit = [
            (pull * length).sqrt(),
            moving.fold(0.0, f64::max),
            turning.fold(0.0, f64::max),
        ];
        let unit = unit.into_iter().find(|speed| *speed > 0.0).unwrap_or(1.0);
        Self {
            motion: Motion::new(system, surroundings, (length / unit, unit), release),
            rings: machine.retainers.len(),
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
        let (time, part) = self.motion.advance(time, on_event);
        let at = self.motion.step.at(part);
        let Coordinates { place, speed } = &at;
        let of = |of: &[f64], body: usize| [of[2 * body], of[2 * body + 1]];
        let first = 2 + self.bending;
        let spins = 2 * (first + self.rings);
        let ring = |(i, link): (usize, &Link)| RingState {
            position: of(place, first + i),
            velocity: of(speed, first + i),
            displacement: link.lateral(place),
            displacement_rate: link.lateral(speed),
            race_spin: speed[spins + 1 + i],
            race_angle: place[spins + 1 + i],
        };
        let links = self.motion.system.links.iter();
        let rings = links.clone().take(self.rings).enumerate();
        let walls = links.filter(|link| link.clearance().is_some()).count();
        let held = |link: usize, _: &Link| self.motion.step.held(link, part)[0];
        CoupledState {
            time,
            position: of(place, 0),
            velocity: of(speed, 0),
            tilt: of(place, 1),
            tilt_rate: of(speed, 1),
            spin: speed[spins],
            bending: (2..first).map(|k| of(place, k)).collect(),
            rings: rings.map(ring).collect(),
            modes: self.motion.each(|_, link| link.mode)[..walls].to_vec(),
            normal_forces: self.motion.each(held)[..walls].to_vec(),
            turns_in_contact: self.motion.turns_at(place)[..walls].to_vec(),
            at,
        }
    }

    /// Translation, tilt, bending, rings, spins, gravity, mounts and magnets, J.
    pub fn energy(&self, state: &CoupledState) -> f64 {
        self.motion.energy(&state.at)
    }

    /// When its steps were spent, s; it stays there.
    pub fn given_up(&self) -> Option<f64> {
        self.motion.given_up()
    }

    /// Size of the last terms of the series (1e-18 of the clearance if not set).
    pub fn set_accuracy(&mut self, accuracy: f64) {
        self.motion.accuracy = accuracy;
    }
}
