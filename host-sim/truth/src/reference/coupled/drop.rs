//! A drop of a machine.

use super::machine::CoupledMachine;
use super::motion::{Moment, Motion};
use super::start::CoupledStart;
use super::system::{Link, Mode};
use super::tape::Tape;
use touchdown_base::history::ModelEvent;

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
    motion: Motion,
    /// Displacements in the rings.
    rings: Vec<Link>,
    bending: usize,
}

impl CoupledReference {
    /// At the release; `spin` is counter-clockwise, rad/s.
    pub fn new(machine: &CoupledMachine, start: &CoupledStart, spin: f64) -> Self {
        let rings = || machine.retainers.iter().map(|it| it.ring);
        let length = rings()
            .map(|ring| ring.clearance)
            .fold(f64::INFINITY, f64::min);
        let (mut surroundings, system) = (machine.surroundings(), machine.system(length));
        let [place, speed] = start.coordinates(machine, spin);
        surroundings.cut_off(&place, &speed);
        let tape = Tape::new();
        let pulled = surroundings.forces(&tape.start(&place), &tape.start(&speed));
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
            motion: Motion::new(system, surroundings, (length / unit, unit), (place, speed)),
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
