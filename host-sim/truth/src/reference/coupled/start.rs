//! How a machine is released.

use super::machine::CoupledMachine;
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

    /// Coordinates and their rates.
    pub(super) fn coordinates(&self, machine: &CoupledMachine, spin: f64) -> [Vec<f64>; 2] {
        [0, 1].map(|rate| {
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
        })
    }
}
