//! The rotor's state: where its axis is, how it moves, and which rings hold it.

use super::{Ring, TwoPlane};
use crate::vector::{Sums, Vector};
use touchdown_rotor::clock::Instant;
use touchdown_rotor::error::ConfigError;
use touchdown_rotor::kinematics::{Kinematics, ModelEvent, Touch};
use touchdown_rotor::precision::Precision;
use touchdown_rotor::real::Real;
use touchdown_rotor::sum::Sum;
use touchdown_rotor::turns::Turns;

/// Where the rotor starts, in the model's units.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Placement<R> {
    /// Of the centre of mass, rho0.
    pub position: [R; 2],
    /// V.
    pub velocity: [R; 2],
    /// (theta_y, -theta_x), in units of [`TwoPlane::tilt_scale`].
    pub tilt: [R; 2],
    /// The same over T.
    pub tilt_rate: [R; 2],
}

impl Placement<f64> {
    /// Every number rounded once.
    pub fn rounded<R: Real>(&self) -> Placement<R> {
        Placement {
            position: self.position.map(R::lit),
            velocity: self.velocity.map(R::lit),
            tilt: self.tilt.map(R::lit),
            tilt_rate: self.tilt_rate.map(R::lit),
        }
    }
}

/// Permanent contact in a ring.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct Held<R> {
    pub(super) rolling: bool,
    pub(super) turns: Turns<R>,
}

/// What the contacts and the unbalance have done to the energy so far, per mass, V^2.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct Ledger<R> {
    /// Taken by friction.
    pub(super) heat: Sum<R>,
    /// Taken by impacts.
    pub(super) lost: Sum<R>,
    /// Given by the drive that keeps an unbalanced rotor's spin.
    pub(super) driven: Sum<R>,
}

/// The rotor's state.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TwoPlaneState<R, const N: usize> {
    pub(super) tick: u64,
    /// Of the centre of mass, and of the tilt.
    pub(super) place: [Sums<R>; 2],
    pub(super) velocity: [Sums<R>; 2],
    /// As surface speed at the first ring.
    pub(super) spin: Sum<R>,
    pub(super) angle: Turns<R>,
    pub(super) held: [Option<Held<R>>; N],
    pub(super) ledger: Ledger<R>,
    pub(super) shortened: u32,
}

impl<R: Precision, const N: usize> TwoPlaneState<R, N> {
    /// Time since the release, in whole steps.
    pub fn now(&self) -> Instant<R> {
        Instant::at_tick(self.tick)
    }

    /// Steps of which a part was left out, because whirl went too far or contacts were too many.
    pub fn shortened(&self) -> u32 {
        self.shortened
    }

    /// Displacement and velocity of the centre of mass, rho0 and V.
    pub fn centre(&self) -> ([R; 2], [R; 2]) {
        let at = |sums: &[Sums<R>; 2]| sums[0].value().parts();
        (at(&self.place), at(&self.velocity))
    }

    /// Tilt (theta_y, -theta_x) and its rate, in units of [`TwoPlane::tilt_scale`] and T.
    pub fn tilt(&self) -> ([R; 2], [R; 2]) {
        let at = |sums: &[Sums<R>; 2]| sums[1].value().parts();
        (at(&self.place), at(&self.velocity))
    }

    /// Spin as surface speed at the first ring, V.
    pub fn spin(&self) -> R {
        self.spin.value()
    }

    /// Spin angle beyond whole turns, rad.
    pub fn angle(&self) -> R {
        self.angle.parts().1
    }

    /// Displacement of the axis at axial place `zeta` and its velocity, rho0 and V: what a sensor
    /// plane sees.
    pub fn axis_at(&self, zeta: R) -> ([R; 2], [R; 2]) {
        let (place, velocity) = self.at(zeta);
        (place.parts(), velocity.parts())
    }

    pub(super) fn at(&self, zeta: R) -> (Vector<R>, Vector<R>) {
        let at = |sums: &[Sums<R>; 2]| sums[0].value() + sums[1].value().times(zeta);
        (at(&self.place), at(&self.velocity))
    }

    pub(super) fn is_held(&self, ring: usize) -> bool {
        matches!(self.held.get(ring), Some(Some(_)))
    }

    /// `part` of a step after the present step's start.
    pub(super) fn in_step(&self, part: R) -> Instant<R> {
        Instant {
            tick: self.tick,
            fraction: part,
        }
    }
}

impl<R: Precision, const N: usize> TwoPlane<R, N> {
    /// The state at time 0, and what happens there; `spin` is the surface speed at the first ring.
    pub fn start(
        &self,
        start: &Placement<R>,
        spin: R,
        mut on_event: impl FnMut(usize, ModelEvent<R>),
    ) -> Result<TwoPlaneState<R, N>, ConfigError> {
        if !spin.is_finite() {
            return Err(ConfigError::NotFinite("spin"));
        }
        let numbers = [start.position, start.velocity, start.tilt, start.tilt_rate];
        if numbers.as_flattened().iter().any(|x| !x.is_finite()) {
            return Err(ConfigError::NotFinite("start"));
        }
        let mut state = TwoPlaneState {
            tick: 0,
            place: [Sums::new(start.position), Sums::new(start.tilt)],
            velocity: [Sums::new(start.velocity), Sums::new(start.tilt_rate)],
            spin: Sum::new(spin),
            angle: Turns::default(),
            held: [None; N],
            ledger: Ledger::default(),
            shortened: 0,
        };
        for ring in &self.rings {
            let place = state.at(ring.zeta).0;
            if place.length() > ring.limit * (R::ONE + Self::together()) {
                let rule = "inside the clearance at every ring";
                return Err(ConfigError::OutOfRange("start", rule));
            }
        }
        self.meet(&mut state, None, false, R::ZERO, &mut on_event);
        Ok(state)
    }

    /// The rotor at ring `ring`, spin as surface speed there.
    pub fn kinematics_at(&self, state: &TwoPlaneState<R, N>, ring: usize) -> Kinematics<R> {
        let none = Ring {
            zeta: R::ZERO,
            limit: R::ONE,
            surface: R::ONE,
            friction: R::ZERO,
            restitution: R::ZERO,
        };
        let held = state.held.get(ring).copied().flatten();
        let ring = self.rings.get(ring).unwrap_or(&none);
        let (position, velocity) = state.axis_at(ring.zeta);
        Kinematics {
            position,
            velocity,
            spin: ring.surface * state.spin.value(),
            touch: match held {
                None => Touch::None,
                Some(held) if held.rolling => Touch::Rolling,
                Some(_) => Touch::Sliding,
            },
            turns: held.map_or((0, R::ZERO), |held| held.turns.parts()),
        }
    }
}
