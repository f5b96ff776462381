//! A wall that gives way to a force, in place of one with restitution: force K times a function of the depth, times
//! 1 + a d'/V with the speed V at which this contact was entered (Hunt and Crossley; docs/know/model.md).
//!
//! In a stretch the force is its mean over the way from one depth to the other, so that a contact without damping keeps
//! the energy. Its tangent makes it a link that gives way; stretch by stretch that is found by Newton's method (`normals`).

use super::Units;
use super::links::{Grip, Link};
use super::vector::Vector;
use crate::hertz::{Shape, damping};
use touchdown_rotor::clock::Instant;
use touchdown_rotor::error::ConfigError;
use touchdown_rotor::precision::Precision;
use touchdown_rotor::real::Real;
use touchdown_rotor::scales::positive;

/// Newton's steps for the part of the depth that is not the balls': each doubles the digits.
const POLISHINGS: usize = 8;

/// A wall that gives way, SI. The ring's restitution sets its damping.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CompliantConfig {
    /// How the force grows.
    pub shape: Shape,
    /// K, N/m^n.
    pub stiffness: f64,
    /// Of balls and races, which give way with the wall, N/m; rigid without.
    pub balls: Option<f64>,
    /// Speed up to which the damping is scaled by it and not by the contact's own, m/s.
    pub slowest: f64,
}

#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Compliant<R> {
    shape: Shape,
    /// Force per mass of the rotor.
    stiffness: R,
    balls: Option<R>,
    damping: R,
    slowest: R,
    /// Clearance, of the first ring's.
    gap: R,
}

/// A contact, from its first to its last moment beyond the wall.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct SoftContact<R> {
    pub(super) since: Instant<R>,
    /// Of the damping, over depth per time.
    rate: R,
    /// Energy in the wall.
    pub(super) stored: R,
    pub(super) peak: R,
    pub(super) impulse: R,
    leaves: bool,
    /// Whether it was pressed again before it was left: it is permanent.
    pub(super) stays: bool,
}

impl<R: Precision> Compliant<R> {
    /// A spring that takes nothing: its stiffness per mass of the rotor, and the way to it.
    pub(super) fn spring(stiffness: f64, gap: f64) -> Self {
        Self {
            shape: Shape::Spring,
            stiffness: R::lit(stiffness),
            balls: None,
            damping: R::ZERO,
            slowest: R::ONE,
            gap: R::lit(gap),
        }
    }

    /// `gap` is the ring's clearance over the first's.
    pub(super) fn try_new(
        config: &CompliantConfig,
        restitution: f64,
        gap: f64,
        units: &Units,
    ) -> Result<Self, ConfigError> {
        positive("stiffness", config.stiffness)?;
        positive("slowest", config.slowest)?;
        let scales = &units.scales;
        let spring = scales.length / scales.speed * (scales.length / scales.speed) / units.mass;
        let root = match config.shape {
            Shape::Point => Real::sqrt(scales.length),
            _ => 1.0,
        };
        if let Some(balls) = config.balls {
            positive("balls", balls)?;
        }
        Ok(Self {
            shape: config.shape,
            stiffness: R::lit(config.stiffness * spring * root),
            balls: config.balls.map(|it| R::lit(it * spring)),
            damping: R::lit(damping(restitution)),
            slowest: R::lit(config.slowest / scales.speed),
            gap: R::lit(gap),
        })
    }

    /// Of the wall alone: force and its slope.
    fn alone(&self, depth: R) -> [R; 2] {
        if depth <= R::ZERO {
            return [R::ZERO; 2];
        }
        let power = self.shape.power(depth, self.gap);
        let slope = self.shape.slope(depth, power);
        let force = self.stiffness * power;
        [force, slope * force / depth]
    }

    /// The part of a depth that is the wall's, and not the balls'.
    fn own(&self, depth: R) -> R {
        let Some(balls) = self.balls else {
            return depth;
        };
        let mut own = depth;
        for _ in 0..POLISHINGS {
            let [force, slope] = self.alone(own);
            own -= (own + force / balls - depth) / (R::ONE + slope / balls);
        }
        own
    }

    /// Without damping: force and its slope.
    fn force(&self, depth: R) -> [R; 2] {
        let [force, slope] = self.alone(self.own(depth));
        match self.balls {
            Some(balls) => [force, slope / (R::ONE + slope / balls)],
            None => [force, slope],
        }
    }

    /// What is stored at a depth.
    pub(super) fn energy(&self, depth: R) -> R {
        if depth <= R::ZERO {
            return R::ZERO;
        }
        let own = self.own(depth);
        let [force, _] = self.alone(own);
        let power = force / self.stiffness;
        let parts = self.shape.parts(own, power);
        let balls = self.balls.map_or(R::ZERO, |it| R::HALF * force / it);
        force * (own / parts + balls)
    }

    /// Mean force on the way from one depth to another, and how that grows with the other.
    fn mean(&self, from: R, to: R) -> [R; 2] {
        if from < R::ZERO && to > R::ZERO {
            let [mean, slope] = self.mean(R::ZERO, to);
            let share = to / (to - from);
            let before = (R::ONE - share) / (to - from);
            return [mean * share, slope * share + mean * before];
        }
        let (from, inside) = (from.most(R::ZERO), to.most(R::ZERO));
        let mean = if self.balls.is_none() && self.shape == Shape::Point {
            // Of d^1.5: by differences of d^2.5, of which the root of the depth is a factor.
            let (a, b) = (from.sqrt(), inside.sqrt());
            let sum = a + b;
            if sum <= R::ZERO {
                return [R::ZERO; 2];
            }
            let terms = from * from + inside * inside + a * b * (from + inside) + from * inside;
            R::lit(0.4) * self.stiffness * terms / sum
        } else {
            // Two points of Gauss.
            let (middle, half) = (R::HALF * (from + inside), R::HALF * (inside - from));
            let off = R::lit(0.577_350_269_189_625_8) * half;
            R::HALF * (self.force(middle - off)[0] + self.force(middle + off)[0])
        };
        if to < R::ZERO {
            let share = from / (from - to);
            return [mean * share, mean * share / (from - to)];
        }
        let third = (inside - from) / R::from_i32(3);
        [mean, R::HALF * self.force(inside - third)[1]]
    }

    /// Force towards the centre at a place, over its distance.
    pub(super) fn pull(&self, place: Vector<R>) -> R {
        let distance = place.length();
        let depth = distance - self.gap;
        if depth <= R::ZERO {
            return R::ZERO;
        }
        self.force(depth)[0] / distance
    }

    /// What is stored at a place.
    pub(super) fn stored(&self, place: Vector<R>) -> R {
        self.energy(place.length() - self.gap)
    }

    /// Whether a place is beyond a part of the way to it.
    pub(super) fn is_beyond(&self, place: Vector<R>, part: R) -> bool {
        let way = part * self.gap;
        place.square() > way * way
    }

    /// A contact entered at this speed.
    pub(super) fn entered(&self, since: Instant<R>, speed: R) -> SoftContact<R> {
        SoftContact {
            since,
            rate: self.damping / speed.most(self.slowest),
            ..SoftContact::default()
        }
    }

    /// Makes the link that of the tangent of the force where what presses moves so from a place in a time; how far that is
    /// from what it was, of the distance. A contact that has been entered is not before the wall but for rounding.
    pub(super) fn linearize(
        &self,
        link: &mut Link<R>,
        soft: Option<&SoftContact<R>>,
        (from, time): (Vector<R>, R),
        moved: Vector<R>,
    ) -> R {
        let end = from + moved;
        let (before, after) = (from.length(), end.length());
        let sum = from + end;
        let part = sum.length() / (before + after);
        let deeper = after - before;
        let along = sum.dot(moved) / sum.length();
        let (rate, least) = soft.map_or((R::ZERO, -self.gap), |it| (it.rate, R::ZERO));
        let start = (before - self.gap).most(least);
        let [mean, slope] = self.mean(start, after - self.gap);
        let damped = R::ONE + rate * deeper / time;
        let factor = R::HALF * time * time * part;
        let pressed = factor * mean * damped.most(R::ZERO);
        let stiffness = factor * part * (slope * damped + mean * rate / time);
        if pressed <= R::ZERO || stiffness <= R::ZERO {
            let off = if link.grip == Grip::Open {
                R::ZERO
            } else {
                link.pressed
            };
            link.grip = Grip::Open;
            link.wanted = along + before;
            return off / before;
        }
        let off = (pressed - link.pressed) / stiffness;
        link.softness = R::ONE / stiffness;
        link.wanted = along - pressed / stiffness;
        off.abs() / before
    }
}

impl<R: Precision> SoftContact<R> {
    /// After a stretch that went deeper by so much with this mean force; whether it has become permanent.
    pub(super) fn goes_on(&mut self, deeper: R, force: R, time: R) -> bool {
        self.peak = self.peak.most(force);
        self.impulse += force * time;
        let again = self.leaves && deeper > R::ZERO && !self.stays;
        self.leaves |= deeper < R::ZERO;
        self.stays |= again;
        again
    }
}
