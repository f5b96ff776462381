//! Impacts at several links at once: Newton's restitution, Coulomb's impulse. Gauss-Seidel passes find which
//! links press, stick and slide; for those the impulses are one linear system. Also what keeps closed links
//! closed against rounding.

use super::jet::dot;
use super::linear::solve;
use super::seat::Seat;
use super::system::{Hold, Link, Mode, System};

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

    /// Cosine of the angle between the normals.
    pub fn along(&self, other: &Self) -> f64 {
        self.normal[0] * other.normal[0] + self.normal[1] * other.normal[1]
    }

    fn press(&self, system: &System, impulse: f64, speed: &mut [f64]) {
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
            Hold::Brake(_) | Hold::Seat { .. } => 0.0,
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

/// Takes the normal speed of a link.
pub fn arrest(system: &System, link: usize, place: &[f64], speed: &mut [f64]) {
    let touch = Touching::new(system, link, place, speed);
    let impulse = touch.closing / system.lateral(link, link);
    touch.press(system, impulse, speed);
}

/// Takes what is left of normal speed and slip from links that have none.
pub fn keep_speed(system: &System, modes: &[Mode], place: &[f64], speed: &mut [f64]) {
    meet(system, &kept(system, modes, place, speed), speed);
}

/// Gives a ring at rest on its seat this velocity, with what closed links do then.
pub fn set_off(
    system: &System,
    modes: &[Mode],
    (seat, velocity): (usize, [f64; 2]),
    place: &[f64],
    speed: &mut [f64],
) {
    let mut kept = kept(system, modes, place, speed);
    for it in kept.iter_mut().filter(|it| it.link == seat) {
        it.speed -= dot(&it.direction, &velocity);
    }
    meet(system, &kept, speed);
}

/// A condition on the speeds of a link.
struct Kept {
    link: usize,
    direction: [f64; 2],
    /// Part that turns.
    turn: f64,
    /// To be taken, m/s.
    speed: f64,
}

/// That closed links have no normal speed, and those without slip none.
fn kept(system: &System, modes: &[Mode], place: &[f64], speed: &[f64]) -> Vec<Kept> {
    let mut kept = Vec::new();
    let mut keep = |link, direction, turn, speed| {
        kept.push(Kept {
            link,
            direction,
            turn,
            speed,
        });
    };
    for (index, mode) in modes.iter().enumerate() {
        let link = &system.links[index];
        let turning = link.turning(speed);
        match (link.hold, mode) {
            (_, Mode::Flight) | (Hold::Brake(_), Mode::Slide(_)) | (Hold::Seat { .. }, _) => {}
            (Hold::Brake(_), Mode::Stick) => keep(index, [0.0; 2], 1.0, turning),
            (Hold::Wall { .. }, mode) => {
                let touch = Touching::new(system, index, place, speed);
                let [x, y] = touch.normal;
                keep(index, [x, y], 0.0, touch.closing);
                if *mode == Mode::Stick {
                    keep(index, [-y, x], 1.0, touch.slip(system, speed));
                }
            }
        }
    }
    for seat in Seat::all(system).filter(|it| modes[it.link] == Mode::Stick) {
        let rate = system.links[seat.link].lateral(speed);
        for direction in seat.directions(system, modes, place) {
            keep(seat.link, direction, 0.0, dot(&direction, &rate));
        }
    }
    kept
}

/// Takes what is to be taken, by impulses at the links.
fn meet(system: &System, kept: &[Kept], speed: &mut [f64]) {
    let line = |a: &Kept| {
        let against = |b: &Kept| {
            let lateral = system.lateral(a.link, b.link) * dot(&a.direction, &b.direction);
            lateral + system.turning(a.link, b.link) * a.turn * b.turn
        };
        kept.iter().map(against).collect()
    };
    let matrix = kept.iter().map(line).collect();
    let right: Vec<f64> = kept.iter().map(|kept| -kept.speed).collect();
    for (it, impulse) in kept.iter().zip(solve(matrix, &right)) {
        let vector = it.direction.map(|d| d * impulse);
        system.push(it.link, vector, it.turn * impulse, speed);
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

#[cfg(test)]
mod tests {
    use super::super::machine::{Bending, CoupledMachine, Race, Retainer, Ring, Unbalance};
    use super::*;

    /// Of a bending rotor one end slides, the other lands: the speeds of centre, tilt and modes all but cancel at the ends,
    /// and their rounding does not. A moment of a drop of `ufu-rig`.
    #[test]
    fn an_impact_beside_a_sliding_end_is_solved_in_few_passes() {
        let (place, clearance, mass) = (0.286, 2.2e-4, 5.94);
        let retainer = |place, radius| Retainer {
            ring: Ring {
                place,
                radius,
                clearance,
                friction: 0.15,
                restitution: 0.6,
            },
            mount: None,
            race: Some(Race {
                inertia: 8e-6,
                dry_drag: 0.0,
                viscous_drag: 0.0,
            }),
        };
        let mode = |at_rings: [f64; 2]| Bending {
            rate: 656.0,
            damping_ratio: 0.0,
            modal_mass: mass,
            at_rings: at_rings.to_vec(),
            at_magnets: Vec::new(),
            at_centre: 0.0,
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
            let mut speed = before.map(|it| it * part);
            let mut touching = [0, 1].map(|link| Touching::new(&system, link, &at, &speed));
            let passes = strike(&system, &mut touching, &mut speed);
            assert!(passes <= 64, "{trial}: {passes} passes");
        }
    }
}
