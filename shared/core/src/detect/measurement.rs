//! A position as the sensors give it.

use crate::event::Moment;

/// A position as the sensors give it.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Measurement {
    /// When.
    pub(crate) now: Moment,
    /// m.
    pub(crate) position: [f32; 2],
    /// Of one axis, m^2.
    pub(crate) variance: f32,
    /// Of the rotor while it last floated, counter-clockwise positive, as measured or else as told, rad/s.
    pub(crate) spin: f32,
}
