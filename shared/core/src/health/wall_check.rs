//! Whether wall and zero of a plane are still where the commissioning check found them: rest and touches show it.
//!
//! A touch that goes beyond the wall tells nothing, since a retainer gives way. One that ends short of it does, where
//! no magnet can have turned the rotor back so fast. A rotor rests where it is lowest, but for what friction holds it
//! aside by: farther aside the zero has moved.

use crate::config::MachineConfig;
use crate::sample::count_in_a_row;
use crate::vector::{length, less};
use touchdown_rotor::real::sqrt;

/// Part of the clearance by which the wall may seem off. The check's own errors, 2 % of zero and of gain at 95 %, add up
/// to 3 %; sag of the retainer and temperature have the rest.
const OFF: f32 = 0.05;
/// Part of the clearance that is at the wall, at least: no rotor floats there.
const AT_WALL: f32 = 0.7;
/// Part of the clearance within which a rotor at rest begins and ends what its mean place is taken over.
const STILL: f32 = 0.04;
/// Such times in a row, 0.1 s each.
const RESTS: u32 = 2;
/// Touches in a row that end short.
const TOUCHES: u8 = 3;

/// Coefficients.
#[derive(Clone, Copy, Debug)]
pub(crate) struct WallCheck {
    per_clearance: f32,
    /// Part of the clearance by which friction holds a rotor aside, at most.
    aside: f32,
    /// Only what has been checked can have moved.
    is_on: bool,
}

/// Of a plane.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct WallCheckState {
    rests: u32,
    told: bool,
}

impl WallCheck {
    /// Of a `machine`.
    pub(crate) fn new(machine: &MachineConfig, is_on: bool) -> Self {
        let friction = machine.friction;
        Self {
            per_clearance: 1.0 / machine.clearance,
            aside: if machine.gravity > 0.0 {
                friction / sqrt(1.0 + friction * friction)
            } else {
                f32::INFINITY
            },
            is_on,
        }
    }

    /// Takes a mean place, and those at the beginning and the end of what it was taken over, m.
    pub(crate) fn rest(&self, it: &mut WallCheckState, mean: [f32; 2], ends: [[f32; 2]; 2]) {
        let far = |way: [f32; 2]| length(way) * self.per_clearance;
        let is_still = ends.iter().all(|end| far(less(*end, mean)) < STILL);
        let distance = far(mean);
        let aside = (mean[0] * self.per_clearance).abs();
        let is_elsewhere = (distance - 1.0).abs() > OFF || aside > self.aside + OFF;
        let is_off = is_still && distance > AT_WALL && is_elsewhere;
        count_in_a_row(&mut it.rests, is_off);
    }

    /// Whether it is to be told now, after so many touches in a row that ended `short`: once.
    #[inline]
    pub(crate) fn tell(&self, it: &mut WallCheckState, short: u8) -> bool {
        let tells = self.is_on && !it.told && (it.rests >= RESTS || short >= TOUCHES);
        it.told |= tells;
        tells
    }
}
