//! What the detector is told besides the position.

use crate::fault::Found;
use crate::tachometer::Bore;

/// What the rotor touches.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum Retainer {
    /// A wall that does not turn, as far as known.
    #[default]
    Fixed,
    /// A ball bearing's inner ring whose speed is measured, and that speed where it is known.
    Turning(Option<Bore>),
}

/// One sample's signals.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Signals {
    /// Spin, counter-clockwise positive, rad/s, where measured.
    pub spin: Option<f32>,
    /// What this sample showed to be wrong with the spin.
    pub spin_fault: Option<Found>,
    /// What the rotor touches; without a measured spin its turning tells nothing of the slip.
    pub retainer: Retainer,
    /// Whether the magnetic bearings are commanded on, where that is wired.
    pub levitated: Option<bool>,
}
