//! Impacts at several links at once: Newton's restitution, Coulomb's impulse, by Gauss-Seidel to
//! convergence. Also what keeps closed links closed against rounding.

use super::jet::{Jet, solve};
use super::step::Mode;
use super::system::{Hold, Link, System};

/// Passes over all links; for a light ring between the rotor and its stop thousands are needed.
const MAX_PASSES: usize = 100_000;
/// Change of speeds at which the passes end, in parts of the speeds.
const ROUNDING: f64 = 4.0 * f64::EPSILON;

/// A link that takes part.
#[derive(Clone, Copy, Debug)]
pub struct Touching {
    /// Its number.
    pub link: usize,
    /// Outward.
    pub normal: [f64; 2],
    /// Speed into the wall before, m/s.
    pub closing: f64,
    /// Normal impulse, N s.
    pub impulse: f64,
    rubbed: f64,
}

impl Touching {
    /// Before the impact.
    pub fn new(system: &System, link: usize, place: &[f64], speed: &[f64]) -> Self {
        let [x, y] = system.links[link].lateral(place);
        let distance = f64::hypot(x, y);
        let normal = [x / distance, y / distance];
        let touching = Self {
            link,
            normal,
            closing: 0.0,
            impulse: 0.0,
            rubbed: 0.0,
        };
        Self {
            closing: touching.outward(system, speed),
            ..touching
        }
    }

    /// Speed into the wall.
    pub fn outward(&self, system: &System, speed: &[f64]) -> f64 {
        let w = system.links[self.link].lateral(speed);
        w[0] * self.normal[0] + w[1] * self.normal[1]
    }

    /// Slip; that of a brake has no lateral part.
    pub fn slip(&self, system: &System, speed: &[f64]) -> f64 {
        let link = &system.links[self.link];
        let w = link.lateral(speed);
        w[1] * self.normal[0] - w[0] * self.normal[1] + link.turning(speed)
    }

    fn press(&self, system: &System, impulse: f64, speed: &mut [f64]) {
        let vector = self.normal.map(|n| -n * impulse);
        system.push(self.link, vector, 0.0, speed);
    }

    fn rub(&self, system: &System, impulse: f64, speed: &mut [f64]) {
        let vector = [-self.normal[1] * impulse, self.normal[0] * impulse];
        system.push(self.link, vector, impulse, speed);
    }
}

/// The impact: afterwards no link closes, and each that took an impulse leaves with its restitution.
pub fn strike(system: &System, touching: &mut [Touching], speed: &mut [f64]) {
    let largest = |size: &dyn Fn(&Link) -> f64| {
        let sizes = touching.iter().map(|touch| size(&system.links[touch.link]));
        ROUNDING * sizes.fold(0.0, f64::max)
    };
    let slip_rounding = largest(&|link| link.slip_size(speed));
    let rounding = largest(&|link| {
        let [x, y] = link.lateral(speed);
        f64::hypot(x, y)
    });
    for _ in 0..MAX_PASSES {
        let mut settled = true;
        for touch in touching.iter_mut() {
            let link = &system.links[touch.link];
            let Hold::Wall {
                friction,
                restitution,
                ..
            } = link.hold
            else {
                continue;
            };
            let wanted = -restitution * touch.closing.max(0.0);
            let lateral = system.lateral(touch.link, touch.link);
            let step = (touch.outward(system, speed) - wanted) / lateral;
            let step = step.max(-touch.impulse);
            touch.impulse += step;
            touch.press(system, step, speed);
            let mobility = lateral + system.turning(touch.link, touch.link);
            let most = friction * touch.impulse;
            let rubbed = touch.rubbed - touch.slip(system, speed) / mobility;
            let rubbed = rubbed.clamp(-most, most);
            let rub = rubbed - touch.rubbed;
            touch.rubbed = rubbed;
            touch.rub(system, rub, speed);
            settled &=
                (step * lateral).abs() <= rounding && (rub * mobility).abs() <= slip_rounding;
        }
        if settled || touching.len() == 1 {
            return;
        }
    }
}

/// Takes what is left of normal speed and slip from links that have none.
pub fn keep_speed(system: &System, modes: &[Mode], place: &[f64], speed: &mut [f64]) {
    // Direction, part that turns, and speed of each condition.
    let mut kept = Vec::new();
    for (index, mode) in modes.iter().enumerate() {
        let link = &system.links[index];
        let turning = link.turning(speed);
        match (link.hold, mode) {
            (_, Mode::Flight) | (Hold::Brake(_), Mode::Slide(_)) => {}
            (Hold::Brake(_), Mode::Stick) => kept.push((index, [0.0; 2], 1.0, turning)),
            (Hold::Wall { .. }, mode) => {
                let touch = Touching::new(system, index, place, speed);
                let [x, y] = touch.normal;
                kept.push((index, [x, y], 0.0, touch.closing));
                if *mode == Mode::Stick {
                    kept.push((index, [-y, x], 1.0, touch.slip(system, speed)));
                }
            }
        }
    }
    let line = |(a, [ax, ay], at, _): &(usize, [f64; 2], f64, f64)| {
        let against = |(b, [bx, by], bt, _): &(usize, [f64; 2], f64, f64)| {
            let lateral = system.lateral(*a, *b) * (ax * bx + ay * by);
            Jet::start(lateral + system.turning(*a, *b) * at * bt)
        };
        kept.iter().map(against).collect()
    };
    let matrix = kept.iter().map(line).collect();
    let right = kept.iter().map(|kept| Jet::start(-kept.3)).collect();
    for ((link, direction, turn, _), impulse) in kept.iter().zip(solve(matrix, right)) {
        let impulse = impulse.value();
        system.push(*link, direction.map(|d| d * impulse), turn * impulse, speed);
    }
}

/// Puts a link's displacement on its wall.
pub fn keep_place(system: &System, index: usize, place: &mut [f64]) {
    let link = &system.links[index];
    let Some(clearance) = link.clearance() else {
        return;
    };
    let [x, y] = link.lateral(place);
    let distance = f64::hypot(x, y);
    let inward = (distance - clearance) / distance / system.lateral(index, index);
    system.push(index, [-x * inward, -y * inward], 0.0, place);
}
