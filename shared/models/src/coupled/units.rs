//! What turns SI into the model's units.

use touchdown_rotor::scales::Scales;

/// Of the rotor and one of its rings.
#[derive(Clone, Copy, Debug)]
pub(super) struct Units<R> {
    pub(super) mass: R,
    /// Of the rotor at the first ring, m.
    pub(super) radius: R,
    /// Of the retainer, m.
    pub(super) bore: R,
    /// Length of a step, T.
    pub(super) step: R,
    pub(super) scales: Scales<R>,
}
