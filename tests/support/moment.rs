//! A rotor in a ring that moves, at one moment.

use touchdown_models::{CoupledEnergy, Load};
use touchdown_rotor::Touch;

/// The model at one moment, SI.
#[derive(Clone, Copy, Debug)]
pub struct Moment {
    /// s.
    pub time: f64,
    /// Rotor centre in space, m.
    pub position: [f64; 2],
    /// m/s.
    pub velocity: [f64; 2],
    /// rad/s.
    pub spin: f64,
    /// Of the rotor in the ring.
    pub displacement: [f64; 2],
    /// Of the ring, m.
    pub ring: [f64; 2],
    /// m/s.
    pub ring_velocity: [f64; 2],
    /// Whether the stop holds the ring.
    pub stopped: bool,
    /// Inner ring and cage, rad/s; temperature, K.
    pub race: [f64; 3],
    /// Contact or not.
    pub touch: Touch,
    /// Of the rotor round the ring since contact began.
    pub turns: f64,
    /// J.
    pub energy: CoupledEnergy<f64>,
    /// N.
    pub load: Load<f64>,
    /// Steps that hit the bound on their stretches.
    pub shortened: u32,
}

/// Every number by the unit.
pub fn scaled(energy: &CoupledEnergy<f64>, unit: f64) -> CoupledEnergy<f64> {
    CoupledEnergy {
        motion: energy.motion * unit,
        spin: energy.spin * unit,
        height: energy.height * unit,
        magnets: energy.magnets * unit,
        bending: energy.bending * unit,
        contacts: energy.contacts * unit,
        rings: energy.rings * unit,
        springs: energy.springs * unit,
        races: energy.races * unit,
        heat: energy.heat * unit,
        lost: energy.lost * unit,
        mounts: energy.mounts * unit,
        stops: energy.stops * unit,
        drag: energy.drag * unit,
        damped: energy.damped * unit,
        driven: energy.driven * unit,
    }
}
