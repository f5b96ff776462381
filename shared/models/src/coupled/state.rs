//! The state: the rotor's coordinates, its spin, and each ring's motion.

use super::compliant::SoftContact;
use super::mount::SprungState;
use super::race::{BallBearingState, RaceMotion};
use super::vector::{Sums, Vector};
use super::{Coupled, MAGNETS, at};
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
    /// (theta_y, -theta_x), in units of [`Coupled::tilt_scale`]; 0 without tilt.
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

/// Normal force in a ring over the rotor's mass, V^2/rho0: impulse of a step over its length.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Load<R> {
    /// In the last step.
    pub normal: R,
    /// Largest so far; an impact counts by its impulse, so it depends on the step.
    pub peak: R,
    /// Largest so far, without the impulses of impacts.
    pub held_peak: R,
}

/// A ring and its inner ring at one moment.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RingMotion<R> {
    /// From the place where it rests under its own weight, rho0.
    pub position: [R; 2],
    /// V.
    pub velocity: [R; 2],
    /// Whether the hard stop holds it.
    pub stopped: bool,
    /// The inner ring of a ball bearing.
    pub race: Option<RaceMotion<R>>,
}

/// Something that happened in a ring.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RingEvent<R> {
    /// Its index.
    pub ring: usize,
    /// What; the place is that of the axis at the ring, the spin surface speed there.
    pub event: ModelEvent<R>,
}

/// Who is told of what happens, and at which part of a step it does.
pub(super) struct Listener<'a, R> {
    pub(super) part: R,
    pub(super) on_event: &'a mut dyn FnMut(RingEvent<R>),
}

/// Permanent contact in a ring.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct Held<R> {
    pub(super) rolling: bool,
    pub(super) turns: Turns<R>,
    /// Where the wall gives way.
    pub(super) soft: Option<SoftContact<R>>,
}

impl<R: Real> Held<R> {
    /// Whether it is an impact yet.
    pub(super) fn passes(&self) -> bool {
        self.soft.as_ref().is_some_and(|it| !it.stays)
    }
}

/// A ring's part of the state.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct Seat<R> {
    pub(super) held: Option<Held<R>>,
    pub(super) mount: SprungState<R>,
    pub(super) race: BallBearingState<R>,
    pub(super) load: Load<R>,
    /// Normal impulse in this step so far.
    pub(super) impulse: R,
    /// Part of it without impacts.
    pub(super) held_impulse: R,
}

/// What was done to the energy so far, per mass, V^2.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct Books<R> {
    pub(super) heat: Sum<R>,
    pub(super) lost: Sum<R>,
    /// Taken by the damping of modes and magnets.
    pub(super) damped: Sum<R>,
    pub(super) driven: Sum<R>,
}

/// The state of rotor and rings.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CoupledState<R, const N: usize, const Q: usize> {
    pub(super) tick: u64,
    pub(super) place: [Sums<R>; Q],
    pub(super) velocity: [Sums<R>; Q],
    /// As surface speed at the first ring.
    pub(super) spin: Sum<R>,
    pub(super) angle: Turns<R>,
    pub(super) seats: [Seat<R>; N],
    /// Which magnets are on.
    pub(super) on: [bool; MAGNETS],
    /// Angle of the base, from that at the release.
    pub(super) base: Turns<R>,
    pub(super) books: Books<R>,
    pub(super) shortened: u32,
    pub(super) work: u64,
    pub(super) taken: u64,
    pub(super) jammed: Option<u64>,
}

impl<R: Precision, const N: usize, const Q: usize> CoupledState<R, N, Q> {
    /// Steps of which a part was left out, because contacts were too many.
    pub fn shortened(&self) -> u32 {
        self.shortened
    }

    /// Stretches tried and systems of walls solved so far: what the run has cost, each about as much.
    pub fn work(&self) -> u64 {
        self.work
    }

    /// Stretches and impacts taken so far: of each the rounding stays.
    pub fn taken(&self) -> u64 {
        self.taken
    }

    /// The first step in which walls jammed: friction was left out of what the others were solved with.
    pub fn jammed(&self) -> Option<u64> {
        self.jammed
    }

    /// Time since the release, in whole steps.
    pub fn now(&self) -> Instant<R> {
        Instant::at_tick(self.tick)
    }

    /// Spin as surface speed at the first ring, V.
    pub fn spin(&self) -> R {
        self.spin.value()
    }

    /// Spin angle beyond whole turns, rad.
    pub fn angle(&self) -> R {
        self.angle.parts().1
    }

    /// Displacement and velocity of the centre of mass, rho0 and V.
    pub fn centre(&self) -> ([R; 2], [R; 2]) {
        (self.places()[0].parts(), self.velocities()[0].parts())
    }

    /// Displacement and velocity of each coordinate: centre, tilt, modes; of the rotor's mass each.
    pub fn coordinate(&self, index: usize) -> ([R; 2], [R; 2]) {
        let of = |sums: &[Sums<R>; Q]| {
            sums.get(index)
                .map_or([R::ZERO; 2], |it| it.value().parts())
        };
        (of(&self.place), of(&self.velocity))
    }

    /// Displacement and velocity of the axis at a place of this shape, [`Coupled::shape_at`].
    pub fn axis_at(&self, shape: &[R; Q]) -> ([R; 2], [R; 2]) {
        (
            at(shape, &self.places()).parts(),
            at(shape, &self.velocities()).parts(),
        )
    }

    pub(super) fn places(&self) -> [Vector<R>; Q] {
        self.place.map(|sums| sums.value())
    }

    pub(super) fn velocities(&self) -> [Vector<R>; Q] {
        self.velocity.map(|sums| sums.value())
    }

    pub(super) fn ring_place(&self, ring: usize) -> Vector<R> {
        self.seats[ring].mount.place.value()
    }

    pub(super) fn ring_velocity(&self, ring: usize) -> Vector<R> {
        self.seats[ring].mount.velocity.value()
    }

    pub(super) fn is_held(&self, ring: usize) -> bool {
        self.seats[ring].held.is_some()
    }

    /// Whether a wall holds the axis that does not give way.
    pub(super) fn lies(&self, ring: usize) -> bool {
        let held = self.seats[ring].held.as_ref();
        held.is_some_and(|it| it.soft.is_none())
    }

    /// Whether a hard stop holds the ring.
    pub(super) fn is_stopped(&self, ring: usize) -> bool {
        self.seats[ring].mount.stopped
    }

    pub(super) fn worked(&mut self, more: u32) {
        self.work = self.work.saturating_add(u64::from(more));
    }

    pub(super) fn in_step(&self, part: R) -> Instant<R> {
        Instant {
            tick: self.tick,
            fraction: part,
        }
    }

    /// Gives an impulse at a place of this shape.
    pub(super) fn kick(&mut self, shape: &[R; Q], push: Vector<R>) {
        for (sums, b) in self.velocity.iter_mut().zip(shape) {
            sums.add(push.times(*b));
        }
    }
}

impl<R: Precision, const N: usize, const Q: usize> Coupled<R, N, Q> {
    /// The state at time 0, and what happens there; `spin` is the surface speed at the first ring. Rings
    /// and inner rings are at rest, and nothing is bent.
    pub fn start(
        &self,
        start: &Placement<R>,
        spin: R,
        mut on_event: impl FnMut(RingEvent<R>),
    ) -> Result<CoupledState<R, N, Q>, ConfigError> {
        if !spin.is_finite() {
            return Err(ConfigError::NotFinite("spin"));
        }
        let numbers = [start.position, start.velocity, start.tilt, start.tilt_rate];
        if numbers.as_flattened().iter().any(|x| !x.is_finite()) {
            return Err(ConfigError::NotFinite("start"));
        }
        let tilts = [start.tilt, start.tilt_rate];
        if Q == 1 && tilts.as_flattened().iter().any(|x| *x != R::ZERO) {
            return Err(ConfigError::OutOfRange("start", "without tilt"));
        }
        let mut state = CoupledState {
            tick: 0,
            place: [Sums::default(); Q],
            velocity: [Sums::default(); Q],
            spin: Sum::new(spin),
            angle: Turns::default(),
            seats: [Seat::default(); N],
            on: self.on_at(Instant::at_tick(0)),
            base: Turns::default(),
            books: Books::default(),
            shortened: 0,
            work: 0,
            taken: 0,
            jammed: None,
        };
        for (sums, x) in state.place.iter_mut().zip([start.position, start.tilt]) {
            *sums = Sums::new(x);
        }
        let rates = [start.velocity, start.tilt_rate];
        for (sums, v) in state.velocity.iter_mut().zip(rates) {
            *sums = Sums::new(v);
        }
        for (i, ring) in self.rings.iter().enumerate() {
            if self.within(&state, i).length() > ring.limit * (R::ONE + Self::together()) {
                let rule = "inside the clearance at every ring";
                return Err(ConfigError::OutOfRange("start", rule));
            }
        }
        let (part, on_event) = (R::ZERO, &mut on_event);
        self.meet(&mut state, None, false, &mut Listener { part, on_event });
        Ok(state)
    }

    /// Displacement of the axis in a ring.
    pub(super) fn within(&self, state: &CoupledState<R, N, Q>, ring: usize) -> Vector<R> {
        at(&self.rings[ring].shape, &state.places()) - state.ring_place(ring)
    }

    /// Velocity of the axis in a ring.
    pub(super) fn relative(&self, state: &CoupledState<R, N, Q>, ring: usize) -> Vector<R> {
        at(&self.rings[ring].shape, &state.velocities()) - state.ring_velocity(ring)
    }

    /// Surface speed of the rotor against what it rubs on.
    pub(super) fn surface(&self, state: &CoupledState<R, N, Q>, ring: usize) -> R {
        let race = state.seats[ring].race.surface();
        self.rings[ring].surface * state.spin.value() - race
    }

    /// The axis at a ring, spin as surface speed there.
    pub fn kinematics_at(&self, state: &CoupledState<R, N, Q>, ring: usize) -> Kinematics<R> {
        let held = state.seats[ring].held.filter(|it| !it.passes());
        let (position, velocity) = state.axis_at(&self.rings[ring].shape);
        Kinematics {
            position,
            velocity,
            spin: self.rings[ring].surface * state.spin.value(),
            touch: match held {
                None => Touch::None,
                Some(held) if held.rolling => Touch::Rolling,
                Some(_) => Touch::Sliding,
            },
            turns: held.map_or((0, R::ZERO), |held| held.turns.parts()),
        }
    }

    /// Displacement of the axis in a ring, rho0.
    pub fn displacement(&self, state: &CoupledState<R, N, Q>, ring: usize) -> [R; 2] {
        self.within(state, ring).parts()
    }

    /// Whether a ring's wall gives way.
    pub fn is_compliant(&self, ring: usize) -> bool {
        self.rings[ring].compliant.is_some()
    }

    /// A ring's way beyond its hard stop, rho0; below 0 before it, none without a stop.
    pub fn beyond_stop(&self, state: &CoupledState<R, N, Q>, ring: usize) -> Option<R> {
        let travel = self.rings[ring].mount?.travel?;
        Some(state.ring_place(ring).length() - travel)
    }

    /// Distance of the axis from a ring's centre, of the ring's clearance.
    pub fn reach_at(&self, state: &CoupledState<R, N, Q>, ring: usize) -> R {
        self.within(state, ring).length() / self.rings[ring].limit
    }

    /// A ring and its inner ring now.
    pub fn ring(&self, state: &CoupledState<R, N, Q>, ring: usize) -> RingMotion<R> {
        let race = self.rings[ring].race;
        RingMotion {
            position: state.ring_place(ring).parts(),
            velocity: state.ring_velocity(ring).parts(),
            stopped: state.is_stopped(ring),
            race: race.map(|it| it.motion(&state.seats[ring].race)),
        }
    }

    /// Normal force in a ring.
    pub fn load(&self, state: &CoupledState<R, N, Q>, ring: usize) -> Load<R> {
        state.seats[ring].load
    }
}
