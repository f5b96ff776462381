//! The forces of walls that give way, as series.

use super::super::jet::dot;
use super::system::{Coordinates, Hold, Link, Mode, System};
use super::tape::Term;
use super::unknown::Unknown;

/// What presses at a wall, or did: series.
pub struct SoftForce<'t> {
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
    /// Whether it is a ring's stop.
    pub is_stop: bool,
    rate: Term<'t>,
    inward: [Term<'t>; 2],
    along: [Term<'t>; 2],
    /// Rate of slip that the turning of its direction gives, m/s^2.
    turned: Term<'t>,
}

impl<'t> SoftForce<'t> {
    /// What presses at this wall, or did before it is left.
    fn at(
        (link, of): (usize, &Link),
        Coordinates { place, speed }: &Coordinates<Term<'t>>,
    ) -> Option<Self> {
        let Hold::Soft(soft) = of.hold else {
            return None;
        };
        let constant = |value| place[0].constant(value);
        let within = soft.within?;
        let (q, w) = (of.lateral(place), of.lateral(speed));
        let distance = dot(&q, &q).power(0.5);
        let nearness = distance.power(-1.0);
        let [x, y] = q.map(|part| part * nearness);
        let along = [-y, x];
        let depth = distance - constant(soft.clearance);
        let (rate, passing) = (dot(&[x, y], &w), dot(&along, &w));
        let push = rate * within + constant(1.0);
        let (spring, normal) = match of.mode {
            Mode::Flight => (constant(0.0), constant(0.0)),
            _ => {
                let spring = soft.spring(depth);
                (spring, spring * push)
            }
        };
        Some(Self {
            link,
            depth,
            push,
            slip: passing + of.turning(speed),
            spring,
            normal,
            is_stop: soft.is_stop,
            rate,
            inward: [-x, -y],
            along,
            turned: passing * rate * nearness,
        })
    }

    /// All of a system.
    pub fn all(system: &System, now: &Coordinates<Term<'t>>) -> Vec<Self> {
        let links = system.links.iter().enumerate();
        links.filter_map(|link| Self::at(link, now)).collect()
    }

    /// Adds its force to the accelerations.
    pub fn push(&self, system: &System, acceleration: &mut [Term<'t>]) {
        let link = &system.links[self.link];
        let rubbed = match link.mode {
            Mode::Flight => return,
            Mode::Slide(sign) => -sign * link.friction(),
            Mode::Stick => 0.0,
        };
        let force = [0, 1].map(|k| (self.inward[k] + self.along[k] * rubbed) * self.normal);
        for (i, part) in system.moved(self.link) {
            acceleration[i] = acceleration[i] + force[i % 2] * part;
        }
        for (i, part) in system.turned(self.link, rubbed) {
            acceleration[i] = acceleration[i] + self.normal * part;
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
