//! Impact with restitution and Coulomb's impulse, and the end of the bounce series.
//!
//! Speeds: normal is outward, into the wall; tangential counter-clockwise; surface is radius times
//! spin, so the slip is tangential + surface.

use super::contact::WallState;
use super::scale::Law;

/// Launch speed below which a bounce series is ended by its limit, in units of sqrt(g clearance).
pub const CUTOFF: f64 = 1e-10;
/// The same for a restitution above [`NEARLY_ELASTIC`].
///
/// Such hops hardly decay. Below this height (5e-13 of the clearance) they are contact: no more
/// than about 5e5 hops in a unit of time are flown one by one.
pub const ELASTIC_CUTOFF: f64 = 1e-6;
/// Where the bounces of a series decay too slowly to follow them to the common cut-off.
pub const NEARLY_ELASTIC: f64 = 0.9999;
/// The limit takes the pressing acceleration as constant; this is how much it may change.
const LIMIT_CHANGE: f64 = 1e-5;

/// The launch speed at which a series is ended.
pub fn cutoff(law: &Law) -> f64 {
    if law.restitution > NEARLY_ELASTIC {
        ELASTIC_CUTOFF
    } else {
        CUTOFF
    }
}

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
/// Its duration and its impulse are exact; between its ends the state is interpolated linearly, on
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
        let pressing = wall.pressing(law);
        if launch >= cutoff(law) || pressing <= 0.0 {
            return None;
        }
        let hop = 2.0 * launch / pressing;
        let duration = hop / (1.0 - law.restitution);
        let turn = 1.0 + wall.speed.abs();
        if duration * turn <= LIMIT_CHANGE * pressing {
            let impulse = launch * (1.0 + law.restitution) / (1.0 - law.restitution);
            let fallen = WallState {
                speed: wall.speed - law.gravity * wall.angle.sin() * duration,
                ..wall
            };
            let mut to = rub(law, fallen, impulse);
            to.angle += 0.5 * (wall.speed + to.speed) * duration;
            return Some(Self {
                from: wall,
                to,
                duration,
            });
        }
        let endless = law.restitution > NEARLY_ELASTIC && hop * turn <= LIMIT_CHANGE * pressing;
        endless.then(|| Self::at_once(wall))
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
