//! A wall that gives way: N = K d^n (1 + a d'/V) at the depth d, never pulling (Hunt and Crossley, 1975).
//!
//! V is the speed at which the contact was entered, and a that damping which takes an impact without other forces to the
//! coefficient of restitution. Friction is Coulomb's, on that force.
//!
//! Cut-off: d^n has no series at 0, so the force is 0 up to a depth of 1e-9 of the clearance, and again below half of it.

use super::forces::Unknown;
use super::jet::Jet;
use super::jet::dot;
use super::system::{Hold, Link, Mode, System};
use super::tape::Term;

/// Depth from which the wall presses, in clearances.
const ENTRY: f64 = 1e-9;
/// Depth below which it does so no longer.
const EXIT: f64 = 0.5e-9;
/// Restitution that one below it is taken as.
const LEAST_RESTITUTION: f64 = 0.02;
/// Halvings of the damping's bracket: down to rounding.
const HALVINGS: u32 = 100;

/// How a wall gives way.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Press {
    /// K, N/m^n.
    pub stiffness: f64,
    /// n: 1 for a spring, 1.5 for Hertz' point.
    pub exponent: f64,
    /// Least speed that an entry is damped as, m/s.
    pub slowest: f64,
}

/// A wall that gives way, and whether something is in it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Soft {
    /// Radius of the wall at rest, m.
    pub clearance: f64,
    /// Coulomb's coefficient.
    pub friction: f64,
    press: Press,
    /// a.
    damping: f64,
    /// Of what is in the wall: a over the speed at which it entered, s/m.
    within: Option<f64>,
}

/// What presses at a wall, or did: series.
pub struct Pressed<'t> {
    /// Number of the link.
    pub link: usize,
    /// m.
    pub depth: Term<'t>,
    /// 1 + a d'/V: the wall presses while it is positive.
    pub push: Term<'t>,
    /// m/s.
    pub slip: Term<'t>,
    /// Of the depth alone, N.
    pub spring: Term<'t>,
    /// N.
    pub normal: Term<'t>,
    rate: Term<'t>,
    inward: [Term<'t>; 2],
    along: [Term<'t>; 2],
    /// Rate of slip that the turning of its direction gives, m/s^2.
    turned: Term<'t>,
}

impl Soft {
    /// Nothing is in it.
    pub fn new(clearance: f64, friction: f64, restitution: f64, press: Press) -> Self {
        Self {
            clearance,
            friction,
            press,
            damping: damping(restitution),
            within: None,
        }
    }

    /// Something enters at this speed, m/s.
    pub fn enter(&mut self, closing: f64) {
        self.within = Some(self.damping / closing.max(self.press.slowest));
    }

    /// What was in it has left.
    pub fn leave(&mut self) {
        self.within = None;
    }

    /// Whether something is in it.
    pub fn is_within(&self) -> bool {
        self.within.is_some()
    }

    /// Radius at which it is entered, m.
    pub fn entry(&self) -> f64 {
        self.clearance * (1.0 + ENTRY)
    }

    /// Falls below zero where it is left.
    pub fn exit(&self, depth: Jet) -> Jet {
        depth + Jet::constant(-EXIT * self.clearance)
    }

    /// Energy stored in it, J.
    pub fn potential(&self, link: &Link, place: &[f64]) -> f64 {
        let [x, y] = link.lateral(place);
        let depth = f64::hypot(x, y) - self.clearance;
        if depth <= 0.0 {
            return 0.0;
        }
        let power = self.press.exponent + 1.0;
        self.press.stiffness * depth.powf(power) / power
    }

    /// What presses, or did before it is left.
    fn pressed<'t>(
        &self,
        (link, of): (usize, &Link),
        mode: Mode,
        place: &[Term<'t>],
        speed: &[Term<'t>],
    ) -> Option<Pressed<'t>> {
        let constant = |value| place[0].constant(value);
        let within = self.within?;
        let (q, w) = (of.lateral(place), of.lateral(speed));
        let distance = dot(&q, &q).power(0.5);
        let nearness = distance.power(-1.0);
        let [x, y] = q.map(|part| part * nearness);
        let along = [-y, x];
        let depth = distance - constant(self.clearance);
        let (rate, passing) = (dot(&[x, y], &w), dot(&along, &w));
        let push = rate * within + constant(1.0);
        let (spring, normal) = match mode {
            Mode::Flight => (constant(0.0), constant(0.0)),
            _ => {
                let spring = depth.power(self.press.exponent) * self.press.stiffness;
                (spring, spring * push)
            }
        };
        Some(Pressed {
            link,
            depth,
            push,
            slip: passing + of.turning(speed),
            spring,
            normal,
            rate,
            inward: [-x, -y],
            along,
            turned: passing * rate * nearness,
        })
    }
}

impl<'t> Pressed<'t> {
    /// All of a system.
    pub fn all(
        system: &System,
        modes: &[Mode],
        place: &[Term<'t>],
        speed: &[Term<'t>],
    ) -> Vec<Self> {
        let links = system.links.iter().enumerate();
        let pressed = |(index, link): (usize, &Link)| match link.hold {
            Hold::Soft(soft) => soft.pressed((index, link), modes[index], place, speed),
            _ => None,
        };
        links.filter_map(pressed).collect()
    }

    /// Adds its force to the accelerations.
    pub fn push(&self, system: &System, mode: Mode, acceleration: &mut [Term<'t>]) {
        let link = &system.links[self.link];
        let rubbed = match mode {
            Mode::Flight => return,
            Mode::Slide(sign) => -sign * link.friction(),
            Mode::Stick => 0.0,
        };
        let force = [0, 1].map(|k| (self.inward[k] + self.along[k] * rubbed) * self.normal);
        for i in 0..system.first_spin() {
            let part = link.shares[i / 2] * system.mobility[i];
            if part != 0.0 {
                acceleration[i] = acceleration[i] + force[i % 2] * part;
            }
        }
        for (arm, i) in link.arms.iter().zip(system.first_spin()..) {
            let part = arm * system.mobility[i] * rubbed;
            if part != 0.0 {
                acceleration[i] = acceleration[i] + self.normal * part;
            }
        }
    }

    /// The unknown friction that keeps it from slipping.
    pub fn grip(&self) -> Unknown<'t> {
        Unknown::without_slip(self.link, self.along, self.turned)
    }

    /// Time in which the depth changes by itself, s.
    pub fn time(&self) -> f64 {
        (self.depth.value() / self.rate.value()).abs()
    }
}

/// The damping a that gives a restitution e: (1 + e) a = ln((1 + a)/(1 - e a)).
fn damping(restitution: f64) -> f64 {
    let e = restitution.max(LEAST_RESTITUTION);
    if e >= 1.0 {
        return 0.0;
    }
    let (mut low, mut high) = (0.0, 1.0 / e);
    for _ in 0..HALVINGS {
        let a = 0.5 * (low + high);
        if a.ln_1p() - (-e * a).ln_1p() > (1.0 + e) * a {
            high = a;
        } else {
            low = a;
        }
    }
    0.5 * (low + high)
}
