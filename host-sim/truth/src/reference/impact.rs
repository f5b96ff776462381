//! Impact with restitution and Coulomb's impulse, and the end of the bounce series.
//!
//! Speeds: normal is outward, into the wall; tangential counter-clockwise; surface is radius times
//! spin, so the slip is tangential + surface.

use super::scale::Law;
use super::wall::WallState;

/// Launch speed below which a bounce series is ended by its limit, in units of sqrt(g clearance).
pub const CUTOFF: f64 = 1e-10;
/// Above this restitution a series takes too many hops to end by its own decay.
const NEARLY_ELASTIC: f64 = 1.0 - 1e-5;
/// Hops of a nearly elastic rotor as low as this and as short as [`VANISHING_TIME`] are contact, in
/// parts of the clearance.
///
/// It bounds the hops that are flown: 1000 in a unit of time, or 220 in a turn of fast whirl.
const VANISHING_HEIGHT: f64 = 1e-4;
/// In units of time.
const VANISHING_TIME: f64 = 1e-3;
/// The limit of a series takes the pressing acceleration as constant: how much it may change over
/// the rest of the series, relative.
const SERIES_CHANGE: f64 = 1e-5;
/// The same over a vanishing hop.
const HOP_CHANGE: f64 = 1e-2;

/// The wall state after a normal impulse (per mass): friction up to sticking.
pub fn rub(law: &Law, wall: WallState, impulse: f64) -> WallState {
    let slip = wall.speed + wall.surface;
    let stick = -slip * law.inertia / (1.0 + law.inertia);
    let limit = law.friction * impulse;
    if stick.abs() <= limit {
        let speed = wall.speed + stick;
        WallState {
            speed,
            surface: -speed,
            ..wall
        }
    } else {
        let rubbed = limit.copysign(stick);
        WallState {
            speed: wall.speed + rubbed,
            surface: wall.surface + rubbed / law.inertia,
            ..wall
        }
    }
}

/// The rest of a bounce series too low to be flown hop by hop, up to permanent contact.
///
/// Its duration and its impulse are the limits of the series; between its ends the state is interpolated linearly, on
/// the wall.
#[derive(Clone, Copy, Debug)]
pub struct Settling {
    from: WallState,
    /// Where permanent contact begins.
    pub to: WallState,
    /// In units of time.
    pub duration: f64,
}

impl Settling {
    /// Contact at once.
    pub fn at_once(wall: WallState) -> Self {
        Self {
            from: wall,
            to: wall,
            duration: 0.0,
        }
    }

    /// The limit after an impact that launches at `launch` (inward, positive), or `None` where the
    /// flight has to be followed.
    pub fn after(law: &Law, wall: WallState, launch: f64) -> Option<Self> {
        let normal_acceleration = wall.normal_acceleration(law);
        if normal_acceleration <= 0.0 {
            return None;
        }
        let change = (1.0 + wall.speed.abs()) / normal_acceleration;
        let hop = 2.0 * launch / normal_acceleration;
        if law.restitution > NEARLY_ELASTIC {
            let vanishes = 0.25 * launch * hop <= VANISHING_HEIGHT
                && hop <= VANISHING_TIME
                && hop * change <= HOP_CHANGE;
            return vanishes.then(|| Self::at_once(wall));
        }
        let duration = hop / (1.0 - law.restitution);
        if launch >= CUTOFF || duration * change > SERIES_CHANGE {
            return None;
        }
        let impulse = launch * (1.0 + law.restitution) / (1.0 - law.restitution);
        let fallen = WallState {
            speed: wall.speed - law.gravity * wall.angle.sin() * duration,
            ..wall
        };
        let mut to = rub(law, fallen, impulse);
        to.angle += 0.5 * (wall.speed + to.speed) * duration;
        Some(Self {
            from: wall,
            to,
            duration,
        })
    }

    /// The state `elapsed` after the impact.
    pub fn at(&self, elapsed: f64) -> WallState {
        let part = if self.duration > 0.0 {
            elapsed / self.duration
        } else {
            1.0
        };
        let between = |from: f64, to: f64| from + part * (to - from);
        WallState {
            angle: between(self.from.angle, self.to.angle),
            speed: between(self.from.speed, self.to.speed),
            surface: between(self.from.surface, self.to.surface),
            turns: 0.0,
        }
    }
}
