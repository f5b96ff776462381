//! The forces of closed links: from the conditions that they keep, at the level of accelerations.

use super::jet::{Jet, dot, solve};
use super::mode::Mode;
use super::system::{Hold, Law, System};

/// Accelerations under the links' forces.
pub struct Forces {
    /// Of the coordinates.
    pub acceleration: Vec<Jet>,
    /// Normal force of each link, N.
    pub normal: Vec<Jet>,
    /// Friction of each link without slip, N.
    pub grip: Vec<Jet>,
    /// What the links' forces are made of, without their signs, N.
    pub size: f64,
}

/// An unknown force and the condition that it keeps.
struct Unknown {
    link: usize,
    grips: bool,
    /// The condition's direction, and its part of the turning.
    row: ([Jet; 2], f64),
    /// The force's direction, and its part of the turning.
    force: ([Jet; 2], f64),
    target: Jet,
}

impl Forces {
    /// Of a motion as far as it is known.
    pub fn new(
        system: &System,
        law: &impl Law,
        modes: &[Mode],
        place: &[Jet],
        speed: &[Jet],
    ) -> Self {
        let mut acceleration = law.forces(place, speed);
        for (force, mobility) in acceleration.iter_mut().zip(&system.mobility) {
            *force = *force * *mobility;
        }
        let mut unknowns = Vec::new();
        for (index, (link, mode)) in system.links.iter().zip(modes).enumerate() {
            match (link.hold, *mode) {
                (_, Mode::Flight) => {}
                (
                    Hold::Wall {
                        clearance,
                        friction,
                        ..
                    },
                    mode,
                ) => {
                    let [x, y] = link.lateral(place).map(|q| q * (1.0 / clearance));
                    let w = link.lateral(speed);
                    let (inward, along) = ([-x, -y], [-y, x]);
                    let rubbed = match mode {
                        Mode::Slide(sign) => -sign * friction,
                        _ => 0.0,
                    };
                    let rubbing = [0, 1].map(|k| inward[k] + along[k] * rubbed);
                    unknowns.push(Unknown {
                        link: index,
                        grips: false,
                        row: (inward, 0.0),
                        force: (rubbing, rubbed),
                        target: dot(&w, &w) * (1.0 / clearance),
                    });
                    if mode == Mode::Stick {
                        unknowns.push(Unknown::without_slip(index, along));
                    }
                }
                (Hold::Brake(_), Mode::Stick) => {
                    unknowns.push(Unknown::without_slip(index, [Jet::ZERO; 2]));
                }
                (Hold::Brake(limit), Mode::Slide(sign)) => {
                    for (arm, i) in link.arms.iter().zip(system.first_spin()..) {
                        let braked = -sign * limit * arm * system.mobility[i];
                        acceleration[i] = acceleration[i] + Jet::constant(braked);
                    }
                }
            }
        }
        let (mut matrix, mut right, mut size) = (Vec::new(), Vec::new(), 0.0);
        for Unknown {
            link, row, target, ..
        } in &unknowns
        {
            let against = |other: &Unknown| {
                let lateral = system.lateral(*link, other.link);
                let turning = system.turning(*link, other.link) * row.1 * other.force.1;
                dot(&row.0, &other.force.0) * lateral + Jet::constant(turning)
            };
            let line: Vec<Jet> = unknowns.iter().map(against).collect();
            let link_at = &system.links[*link];
            let free = link_at.lateral(&acceleration);
            let turning = link_at.turning(&acceleration) * row.1;
            right.push(*target - dot(&row.0, &free) - turning);
            let diagonal = system.lateral(*link, *link) + system.turning(*link, *link) * row.1;
            let parts: f64 = (0..system.first_spin())
                .map(|i| (link_at.shares[i / 2] * acceleration[i].value()).abs())
                .sum();
            size += (target.value().abs() + parts + turning.value().abs()) / diagonal;
            matrix.push(line);
        }
        let mut result = Self {
            acceleration,
            normal: vec![Jet::ZERO; modes.len()],
            grip: vec![Jet::ZERO; modes.len()],
            size,
        };
        for (unknown, force) in unknowns.iter().zip(solve(matrix, right)) {
            result.apply(system, unknown, force);
        }
        result
    }

    fn apply(&mut self, system: &System, unknown: &Unknown, force: Jet) {
        let link = &system.links[unknown.link];
        let vector = unknown.force.0.map(|direction| force * direction);
        for i in 0..system.first_spin() {
            let part = link.shares[i / 2] * system.mobility[i];
            if part != 0.0 {
                self.acceleration[i] = self.acceleration[i] + vector[i % 2] * part;
            }
        }
        for (arm, i) in link.arms.iter().zip(system.first_spin()..) {
            let part = arm * system.mobility[i] * unknown.force.1;
            self.acceleration[i] = self.acceleration[i] + force * part;
        }
        let list = if unknown.grips {
            &mut self.grip
        } else {
            &mut self.normal
        };
        list[unknown.link] = force;
    }
}

impl Unknown {
    fn without_slip(link: usize, along: [Jet; 2]) -> Self {
        Self {
            link,
            grips: true,
            row: (along, 1.0),
            force: (along, 1.0),
            target: Jet::ZERO,
        }
    }
}
