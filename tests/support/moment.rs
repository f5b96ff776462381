//! A rotor in a ring that moves, at one moment.

use touchdown_models::{Ledger, Load};
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
    pub ledger: Ledger<f64>,
    /// N.
    pub load: Load<f64>,
    /// Steps that hit the bound on their stretches.
    pub shortened: u32,
}

/// Every number by the unit.
pub fn scaled(ledger: &Ledger<f64>, unit: f64) -> Ledger<f64> {
    Ledger {
        motion: ledger.motion * unit,
        spin: ledger.spin * unit,
        height: ledger.height * unit,
        ring: ledger.ring * unit,
        spring: ledger.spring * unit,
        race: ledger.race * unit,
        heat: ledger.heat * unit,
        lost: ledger.lost * unit,
        damped: ledger.damped * unit,
        stop: ledger.stop * unit,
        drag: ledger.drag * unit,
    }
}
