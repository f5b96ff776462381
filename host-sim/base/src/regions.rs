//! Regions of the phase plane at the wall, in closed form, while the slip keeps its sign.
//!
//! With u = theta'^2 and friction that drives towards +phi (phi from the bottom), u is
//! `c e^(2 mu phi) + a cos phi + b sin phi` along every motion in contact, whichever way it goes. One
//! number, c, tells one motion from another. Contact ends where n = u + k cos phi, the wall's force over
//! m rho0, falls through zero: at phi above 90 degrees on the way up with the friction, at phi below -90
//! degrees against it. So the motions that just miss these two arcs bound the regions.

use std::f64::consts::{FRAC_PI_2, PI};
use std::ops::RangeInclusive;

/// A phase plane: theta' against phi on a wall whose friction drives towards +phi.
#[derive(Clone, Copy, Debug)]
pub struct Plane {
    /// g/rho0, 1/s^2.
    k: f64,
    /// Within [`Plane::FRICTION`].
    mu: f64,
    a: f64,
    b: f64,
}

/// The motions through one point, by their invariant.
#[derive(Clone, Copy, Debug)]
pub struct Orbit {
    plane: Plane,
    /// Of these motions alone.
    pub c: f64,
}

impl Plane {
    /// Friction for which the regions have this shape: from none to nearly 1/sqrt(2).
    pub const FRICTION: RangeInclusive<f64> = 1e-6..=0.7;

    /// For g/rho0 (1/s^2) and friction.
    pub fn new(k: f64, mu: f64) -> Self {
        let square = 1.0 + 4.0 * mu * mu;
        Self {
            k,
            mu,
            a: 2.0 * k * (1.0 - 2.0 * mu * mu) / square,
            b: 6.0 * k * mu / square,
        }
    }

    /// The motions that pass `phi` (rad) with theta'^2 = `u`.
    pub fn orbit(&self, phi: f64, u: f64) -> Orbit {
        let (sin, cos) = phi.sin_cos();
        Orbit {
            plane: *self,
            c: (u - self.a * cos - self.b * sin) * (-2.0 * self.mu * phi).exp(),
        }
    }

    /// Passes the top with no force left: the slowest whirl that keeps contact.
    pub fn slowest_whirl(&self) -> Orbit {
        self.orbit(PI, self.k)
    }

    /// Stops where the wall is upright: the widest swing that keeps contact.
    pub fn widest_swing(&self) -> Orbit {
        self.orbit(FRAC_PI_2, 0.0)
    }

    /// Between these, against the friction, a motion turns on the wall and then whirls. First the one that
    /// turns at once, then those that go over the top once, twice ... before; none where the friction is
    /// too weak for it.
    pub fn turning_whirls(&self) -> impl Iterator<Item = (Orbit, Orbit)> {
        // Stops where the wall is upright, on the way against the friction.
        let widest_against = self.orbit(-FRAC_PI_2, 0.0);
        let (mut slow, mut fast) = (self.slowest_whirl(), widest_against);
        let a_turn = (4.0 * PI * self.mu).exp();
        std::iter::from_fn(move || {
            let band = (slow, fast);
            slow.c *= a_turn;
            fast.c *= a_turn;
            (band.0.c < band.1.c).then_some(band)
        })
    }

    /// theta' below which the wall cannot hold the rotor at `phi`, rad/s.
    pub fn limit(&self, phi: f64) -> f64 {
        (-self.k * phi.cos()).max(0.0).sqrt()
    }
}

impl Orbit {
    /// theta'^2 at `phi`; negative where these motions do not come.
    pub fn square(&self, phi: f64) -> f64 {
        let (sin, cos) = phi.sin_cos();
        let Plane { mu, a, b, .. } = self.plane;
        self.c * (2.0 * mu * phi).exp() + a * cos + b * sin
    }

    /// Whether the wall holds them at `phi`.
    pub fn holds(&self, phi: f64) -> bool {
        let u = self.square(phi);
        u >= 0.0 && u + self.plane.k * phi.cos() >= 0.0
    }

    /// |theta'| at `phi`, rad/s; not a number where they do not come.
    pub fn rate(&self, phi: f64) -> f64 {
        self.square(phi).sqrt()
    }

    /// The angle between `from` and `to` (rad) up to which the wall holds them: it holds at `from`, not
    /// at `to`, and there is one change between.
    pub fn held_until(&self, mut from: f64, mut to: f64) -> f64 {
        for _ in 0..60 {
            let middle = 0.5 * (from + to);
            if self.holds(middle) {
                from = middle;
            } else {
                to = middle;
            }
        }
        0.5 * (from + to)
    }
}
