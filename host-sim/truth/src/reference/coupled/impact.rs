//! Impacts at several links at once: Newton's restitution, Coulomb's impulse. Gauss-Seidel passes find which
//! links press, stick and slide; for those the impulses are one linear system.

use super::super::jet::dot;
use super::linear::solve;
use super::system::{Coordinates, Hold, Link, System};

/// Passes over all links; thousands are needed for a light ring between the rotor and its stop where no
/// linear system is the answer.
const MAX_PASSES: u32 = 100_000;
/// Passes before the first linear system; each further one after as many again.
const FIRST_PASSES: u32 = 16;
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
    pub fn new(system: &System, link: usize, now: &Coordinates) -> Self {
        let [x, y] = system.links[link].lateral(&now.place);
        let distance = f64::hypot(x, y);
        let mut touching = Self {
            link,
            normal: [x / distance, y / distance],
            closing: 0.0,
            impulse: 0.0,
            rubbed: 0.0,
        };
        touching.closing = touching.outward(system, &now.speed);
        touching
    }

    /// Speed into the wall.
    pub fn outward(&self, system: &System, speed: &[f64]) -> f64 {
        dot(&system.links[self.link].lateral(speed), &self.normal)
    }

    /// Slip; that of a brake has no lateral part.
    pub fn slip(&self, system: &System, speed: &[f64]) -> f64 {
        let link = &system.links[self.link];
        let w = link.lateral(speed);
        w[1] * self.normal[0] - w[0] * self.normal[1] + link.turning(speed)
    }

    /// Cosine of the angle between the normals.
    pub fn along(&self, other: &Self) -> f64 {
        dot(&self.normal, &other.normal)
    }

    /// An impulse into the wall.
    pub fn press(&self, system: &System, impulse: f64, speed: &mut [f64]) {
        let vector = self.normal.map(|n| -n * impulse);
        system.push(self.link, vector, 0.0, speed);
    }

    fn rub(&self, system: &System, impulse: f64, speed: &mut [f64]) {
        let vector = [-self.normal[1] * impulse, self.normal[0] * impulse];
        system.push(self.link, vector, impulse, speed);
    }

    /// Impulses along normal and slip.
    fn give(&self, system: &System, [pressed, rubbed]: [f64; 2], speed: &mut [f64]) {
        self.press(system, pressed, speed);
        self.rub(system, rubbed, speed);
    }

    /// Speed into the wall with which it leaves where it presses.
    fn leaves(&self, system: &System) -> f64 {
        match system.links[self.link].hold {
            Hold::Wall { restitution, .. } => -restitution * self.closing.max(0.0),
            Hold::Brake(_) | Hold::Seat { .. } | Hold::Soft(_) => 0.0,
        }
    }
}

/// The impact: afterwards no link closes, and each that took an impulse leaves with its restitution.
/// Gives the passes that it took.
pub fn strike(system: &System, touching: &mut [Touching], speed: &mut [f64]) -> u32 {
    let before = speed.to_vec();
    let sizes = Sizes::of(system, touching, speed);
    for pass in 1..=MAX_PASSES {
        let mut settled = true;
        for touch in touching.iter_mut() {
            settled &= relax(system, touch, speed, &sizes);
        }
        if settled || touching.len() == 1 {
            return pass;
        }
        if pass >= FIRST_PASSES
            && pass.is_power_of_two()
            && let Some((impulses, after)) = at_once(system, touching, &before, &sizes)
        {
            for (touch, [pressed, rubbed]) in touching.iter_mut().zip(impulses) {
                (touch.impulse, touch.rubbed) = (pressed, rubbed);
            }
            speed.copy_from_slice(&after);
            return pass;
        }
    }
    MAX_PASSES
}

/// Largest speeds before, along the normals and of the slips, in parts of which rounding counts.
struct Sizes {
    normal: f64,
    slip: f64,
}

impl Sizes {
    fn of(system: &System, touching: &[Touching], speed: &[f64]) -> Self {
        let largest = |size: &dyn Fn(&Link) -> f64| {
            let sizes = touching.iter().map(|touch| size(&system.links[touch.link]));
            sizes.fold(0.0, f64::max)
        };
        Self {
            normal: largest(&|link| link.lateral_size(speed)),
            slip: largest(&|link| link.slip_size(speed)),
        }
    }

    /// Rounding of normal speed and slip at a link whose impulses change its own speeds by so much.
    fn rounding(&self, pressed: f64, rubbed: f64) -> [f64; 2] {
        [
            ROUNDING * (self.normal + pressed.abs()),
            ROUNDING * (self.slip + rubbed.abs()),
        ]
    }
}

/// Solves one link with the others as they are; whether that changes nothing.
fn relax(system: &System, touch: &mut Touching, speed: &mut [f64], sizes: &Sizes) -> bool {
    let lateral = system.lateral(touch.link, touch.link);
    let step = (touch.outward(system, speed) - touch.leaves(system)) / lateral;
    let step = step.max(-touch.impulse);
    touch.impulse += step;
    touch.press(system, step, speed);
    let mobility = lateral + system.turning(touch.link, touch.link);
    let most = system.links[touch.link].friction() * touch.impulse;
    let rubbed = touch.rubbed - touch.slip(system, speed) / mobility;
    let rubbed = rubbed.clamp(-most, most);
    let rub = rubbed - touch.rubbed;
    touch.rubbed = rubbed;
    touch.rub(system, rub, speed);
    let [normal, slip] = sizes.rounding(touch.impulse * lateral, rubbed * mobility);
    (step * lateral).abs() <= normal && (rub * mobility).abs() <= slip
}

/// The impulses, along normal and slip, with which the links go on pressing, sticking and sliding as they do, and
/// the speeds after them; none where these do not fit together.
fn at_once(
    system: &System,
    touching: &[Touching],
    before: &[f64],
    sizes: &Sizes,
) -> Option<(Vec<[f64; 2]>, Vec<f64>)> {
    // Who, the unknown's parts along normal and slip, and whether its condition is on the slip.
    let mut unknowns = Vec::new();
    for touch in touching.iter().filter(|touch| touch.impulse > 0.0) {
        let friction = system.links[touch.link].friction();
        if touch.rubbed.abs() < friction * touch.impulse {
            unknowns.push((touch, [1.0, 0.0], false));
            unknowns.push((touch, [0.0, 1.0], true));
        } else {
            unknowns.push((touch, [1.0, touch.rubbed.signum() * friction], false));
        }
    }
    let line = |(touch, _, slips): &(&Touching, [f64; 2], bool)| {
        let effect = |(other, parts, _): &(&Touching, [f64; 2], bool)| {
            let mut change = vec![0.0; before.len()];
            other.give(system, *parts, &mut change);
            match slips {
                true => touch.slip(system, &change),
                false => touch.outward(system, &change),
            }
        };
        unknowns.iter().map(effect).collect()
    };
    let missing = |(touch, _, slips): &(&Touching, [f64; 2], bool)| match slips {
        true => -touch.slip(system, before),
        false => touch.leaves(system) - touch.outward(system, before),
    };
    let matrix = unknowns.iter().map(line).collect();
    let right: Vec<f64> = unknowns.iter().map(missing).collect();
    let solution = solve(matrix, &right);
    let mut after = before.to_vec();
    let mut impulses = vec![[0.0; 2]; touching.len()];
    for ((touch, parts, _), size) in unknowns.iter().zip(solution) {
        let given = parts.map(|part| part * size);
        touch.give(system, given, &mut after);
        for (impulse, of) in impulses.iter_mut().zip(touching) {
            if of.link == touch.link {
                *impulse = [0, 1].map(|k| impulse[k] + given[k]);
            }
        }
    }
    let fits = |(touch, [pressed, rubbed]): (&Touching, &[f64; 2])| {
        let lateral = system.lateral(touch.link, touch.link);
        let mobility = lateral + system.turning(touch.link, touch.link);
        let most = system.links[touch.link].friction() * pressed;
        let [normal, slip] = sizes.rounding(pressed * lateral, rubbed * mobility);
        touch.outward(system, &after) - touch.leaves(system) <= normal
            && pressed * lateral >= -normal
            && (rubbed.abs() - most) * mobility <= slip
            && touch.slip(system, &after) * rubbed <= slip * rubbed.abs()
    };
    let all = touching.iter().zip(&impulses).all(fits);
    all.then_some((impulses, after))
}

#[cfg(test)]
mod tests {
    use super::super::machine::{CoupledMachine, Retainer};
    use super::*;
    use touchdown_scene::{Mode, Race, Shape, Unbalance};

    /// Of a bending rotor one end slides, the other lands: the speeds of centre, tilt and modes all but cancel at the ends,
    /// and their rounding does not. A moment of a drop of `ufu-rig`.
    #[test]
    fn an_impact_beside_a_sliding_end_is_solved_in_few_passes() {
        let (place, clearance, mass) = (0.286, 2.2e-4, 5.94);
        let retainer = |place, radius| Retainer {
            place,
            radius,
            clearance,
            friction: 0.15,
            restitution: 0.6,
            mount: None,
            press: None,
            race: Some(Race {
                inertia: 8e-6,
                dry_drag: 0.0,
                viscous_drag: 0.0,
                cage_ratio: 0.4,
                heat_capacity: 92.0,
                heat_loss: 0.0,
            }),
        };
        let mode = |[a, b]: [f64; 2]| Mode {
            speed: 656.0,
            damping_ratio: 0.0,
            mass,
            shape: Shape::Points(vec![[-place, a], [place, b]]),
        };
        let machine = CoupledMachine {
            mass,
            polar_inertia: 4.8e-3,
            transverse_inertia: 0.186,
            gravity: [0.0; 2],
            retainers: vec![retainer(-place, 0.016), retainer(place, 0.0174)],
            unbalance: Unbalance::default(),
            magnets: Vec::new(),
            bending: vec![mode([1.425, 1.662]), mode([-1.371, 1.617])],
            base: None,
        };
        let system = machine.system(clearance);
        let normals = [
            [-0.22895040722380425, -0.9734380879296095],
            [-0.21250445800597176, -0.9771600970811222],
        ];
        let [a, b] = normals.map(|it: [f64; 2]| it.map(|n| n * clearance));
        let mut at = vec![0.0; 15];
        for k in 0..2 {
            at[k] = 0.5 * (a[k] + b[k]);
            at[2 + k] = 0.5 * (b[k] - a[k]) / place;
        }
        let before = [
            -0.005597368589455885,
            -0.02555737506534341,
            -0.0007178214359863658,
            -0.012062829840908642,
            0.0037600237595092046,
            0.01650903670647604,
            -0.0005157374919957525,
            0.0013945847552864045,
            0.0,
            0.0,
            0.0,
            0.0,
            628.0659278133539,
            74.92331815650158,
            78.63648753736636,
        ];
        for trial in 0..100 {
            let part = 1.0 + 1e-3 * f64::from(trial);
            let mut now = Coordinates {
                place: at.clone(),
                speed: before.map(|it| it * part).to_vec(),
            };
            let mut touching = [0, 1].map(|link| Touching::new(&system, link, &now));
            let passes = strike(&system, &mut touching, &mut now.speed);
            assert!(passes <= 64, "{trial}: {passes} passes");
        }
    }
}
