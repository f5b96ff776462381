//! All walls that the machine touches at once, solved together: retainer rings round the rotor, and hard
//! stops round the rings.
//!
//! In what a link's impulse moves all is linear: the motion into its wall, and the slip along it. Which
//! links press, and which of them slide, is found by trial: a link that would pull is opened, one that
//! would go through is closed, friction that is too large slides, a slip that friction would drive sticks.
//!
//! Friction takes energy, however coarse the step: it ends the slip, but gives no more than what makes the mean of
//! the slips before and after 0, and nothing where the slip turns round by itself.

use super::vector::Vector;
use touchdown_rotor::real::Real;

/// Most links: a contact and a stop in each of four rings.
pub(super) const MOST: usize = 8;
/// Most unknowns: normal and friction of each contact, normal of each stop.
const UNKNOWNS: usize = 12;
/// Trials in which all links change that are wrong, and trials in all; the rest change one link each.
const TOGETHER: usize = 8;
const TRIALS: usize = 40;
/// Part of the largest number of the matrix below which an unknown is told by the others, in units of epsilon.
const TOLD: f64 = 64.0;
/// What the links may move into their walls, or slip, in units of epsilon and the motion without them.
const CLOSE: f64 = 16.0;
/// Passes one after the other.
const TURNS: usize = 16;

/// What a link does.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Grip<R> {
    Open,
    /// Signed friction coefficient: this part of the normal impulse, counter-clockwise.
    Slides(R),
    /// No slip after.
    Sticks,
    /// The slip after is that before, turned round.
    Turns,
}

/// A wall that is touched.
#[derive(Clone, Copy, Debug)]
pub(super) struct Link<R> {
    /// Outward.
    pub(super) normal: Vector<R>,
    /// Motion within the wall without any impulse.
    pub(super) free: Vector<R>,
    /// Motion along the normal that is asked for.
    pub(super) wanted: R,
    /// Of the slip, what is not motion within the wall, without any impulse.
    pub(super) surface: R,
    /// Slip before.
    pub(super) before: R,
    pub(super) friction: R,
    pub(super) grip: Grip<R>,
    /// Impulse towards the centre.
    pub(super) pressed: R,
    /// Along the wall, counter-clockwise.
    pub(super) rubbed: R,
}

impl<R: Real> Link<R> {
    pub(super) fn new(normal: Vector<R>, free: Vector<R>) -> Self {
        Self {
            normal,
            free,
            wanted: R::ZERO,
            surface: R::ZERO,
            before: R::ZERO,
            friction: R::ZERO,
            grip: Grip::Slides(R::ZERO),
            pressed: R::ZERO,
            rubbed: R::ZERO,
        }
    }

    /// Whether friction is not at its limit.
    pub(super) fn is_stuck(&self) -> bool {
        match self.grip {
            Grip::Sticks | Grip::Turns => true,
            Grip::Slides(friction) => friction == R::ZERO && self.friction > R::ZERO,
            Grip::Open => false,
        }
    }

    /// The impulse as a vector.
    pub(super) fn push(&self) -> Vector<R> {
        Vector::new([-self.pressed, self.rubbed]) * self.normal
    }

    /// Friction that goes with a slip like this.
    pub(super) fn sliding(friction: R, slip: R) -> Grip<R> {
        Grip::Slides(if slip > R::ZERO { -friction } else { friction })
    }
}

/// All walls that are touched.
#[derive(Clone, Copy, Debug)]
pub(super) struct Links<R> {
    count: usize,
    link: [Option<Link<R>>; MOST],
    /// Motion of the first by an impulse in the second.
    response: [[Vector<R>; MOST]; MOST],
    /// Of the slip, by a tangential impulse, what is not motion.
    spin: [[R; MOST]; MOST],
}

/// Rows of a linear system with its right side.
type Rows<R> = [[R; UNKNOWNS + 1]; UNKNOWNS];

impl<R: Real> Links<R> {
    pub(super) fn new() -> Self {
        Self {
            count: 0,
            link: [None; MOST],
            response: [[Vector::default(); MOST]; MOST],
            spin: [[R::ZERO; MOST]; MOST],
        }
    }

    /// Adds a link; its place in the order.
    pub(super) fn add(&mut self, link: Link<R>) -> usize {
        let place = self.count;
        if let Some(slot) = self.link.get_mut(place) {
            *slot = Some(link);
            self.count += 1;
        }
        place
    }

    pub(super) fn get(&self, place: usize) -> Option<&Link<R>> {
        self.link.get(place)?.as_ref()
    }

    pub(super) fn get_mut(&mut self, place: usize) -> Option<&mut Link<R>> {
        self.link.get_mut(place)?.as_mut()
    }

    pub(super) fn all(&mut self) -> impl Iterator<Item = &mut Link<R>> {
        self.link.iter_mut().flatten()
    }

    pub(super) fn respond(&mut self, to: usize, from: usize, motion: Vector<R>, spin: R) {
        if let Some(row) = self.response.get_mut(to)
            && let Some(slot) = row.get_mut(from)
        {
            *slot = motion;
        }
        if let Some(row) = self.spin.get_mut(to)
            && let Some(slot) = row.get_mut(from)
        {
            *slot = spin;
        }
    }

    /// Motion with all impulses.
    pub(super) fn motion(&self, place: usize) -> Vector<R> {
        let (Some(link), Some(row)) = (self.get(place), self.response.get(place)) else {
            return Vector::default();
        };
        let others = self.link.iter().flatten().zip(row);
        others.fold(link.free, |sum, (other, response)| {
            sum + *response * other.push()
        })
    }

    /// Of the slip, what is not motion, with all impulses.
    pub(super) fn surface(&self, place: usize) -> R {
        let (Some(link), Some(row)) = (self.get(place), self.spin.get(place)) else {
            return R::ZERO;
        };
        let others = self.link.iter().flatten().zip(row);
        others.fold(link.surface, |sum, (other, response)| {
            sum + *response * other.rubbed
        })
    }

    /// Finds all impulses; false where no set of links that press and slide was found to hold.
    pub(super) fn solve(&mut self) -> bool {
        let close = R::lit(CLOSE) * R::EPSILON * self.size();
        for trial in 0..TRIALS {
            self.solve_linear();
            let mut holds = true;
            for place in 0..self.count {
                let Some(grip) = self.corrected(place, close) else {
                    continue;
                };
                if let Some(Some(link)) = self.link.get_mut(place) {
                    link.grip = grip;
                }
                holds = false;
                if trial >= TOGETHER {
                    break;
                }
            }
            if holds {
                return true;
            }
        }
        false
    }

    /// Size of the motion.
    fn size(&self) -> R {
        let links = self.link.iter().flatten();
        links.fold(R::ZERO, |most, link| {
            most.most(link.free.length() + link.wanted.abs() + link.surface.abs())
        })
    }

    /// What a link does rather; none where it is right.
    fn corrected(&self, place: usize, close: R) -> Option<Grip<R>> {
        let link = self.get(place)?;
        let motion = self.motion(place);
        let slip = link.normal.cross(motion) + self.surface(place);
        let most = link.friction * link.pressed;
        match link.grip {
            Grip::Open => {
                let through = link.normal.dot(motion) - link.wanted > R::ZERO;
                through.then(|| Link::sliding(link.friction, slip))
            }
            _ if link.pressed < R::ZERO => Some(Grip::Open),
            Grip::Sticks | Grip::Turns if link.rubbed.abs() > most => {
                Some(Link::sliding(link.friction, -link.rubbed))
            }
            Grip::Sticks => (link.rubbed * link.before > R::ZERO).then_some(Grip::Turns),
            Grip::Turns => (link.rubbed * link.before < R::ZERO).then_some(Grip::Slides(R::ZERO)),
            Grip::Slides(friction) if friction != R::ZERO => {
                let along = |slip: R| if friction > R::ZERO { slip } else { -slip };
                if along(slip) > close {
                    return Some(Grip::Sticks);
                }
                (along(slip + link.before) > close).then_some(Grip::Turns)
            }
            Grip::Slides(_) => {
                let turns_by_itself = slip * link.before <= close * close;
                (most > R::ZERO && !turns_by_itself).then(|| Link::sliding(link.friction, slip))
            }
        }
    }

    /// The impulses of links that do what they are taken to do.
    pub(super) fn solve_linear(&mut self) {
        // Of each unknown: its link, and the impulse of a unit of it as (-normal, tangential).
        let mut unknowns = [(0, Vector::<R>::default()); UNKNOWNS];
        let mut count = 0;
        for (place, link) in self.link.iter().enumerate() {
            let one = match link.map(|link| link.grip) {
                None | Some(Grip::Open) => continue,
                Some(Grip::Slides(friction)) => Vector::new([-R::ONE, friction]),
                Some(Grip::Sticks | Grip::Turns) => Vector::new([-R::ONE, R::ZERO]),
            };
            let also = matches!(link.map(|link| link.grip), Some(Grip::Sticks | Grip::Turns));
            let slip = Vector::new([R::ZERO, R::ONE]);
            for unit in [Some(one), also.then_some(slip)].into_iter().flatten() {
                if let Some(slot) = unknowns.get_mut(count) {
                    *slot = (place, unit);
                    count += 1;
                }
            }
        }
        let mut rows: Rows<R> = [[R::ZERO; UNKNOWNS + 1]; UNKNOWNS];
        for (row, (place, unit)) in rows.iter_mut().zip(unknowns).take(count) {
            self.fill(row, place, unit.x == R::ZERO, &unknowns, count);
        }
        let found = eliminate(&mut rows, count);
        for link in self.link.iter_mut().flatten() {
            (link.pressed, link.rubbed) = (R::ZERO, R::ZERO);
        }
        for ((place, unit), value) in unknowns.iter().zip(found).take(count) {
            if let Some(Some(link)) = self.link.get_mut(*place) {
                link.pressed += -(unit.x * value);
                link.rubbed += unit.y * value;
            }
        }
    }

    /// The equation of a link: of its slip, or of its motion along the normal.
    fn fill(
        &self,
        row: &mut [R; UNKNOWNS + 1],
        place: usize,
        slips: bool,
        unknowns: &[(usize, Vector<R>); UNKNOWNS],
        count: usize,
    ) {
        let Some(link) = self.get(place) else {
            return;
        };
        for (slot, (from, unit)) in row.iter_mut().zip(unknowns).take(count) {
            let Some(other) = self.get(*from) else {
                continue;
            };
            let moved = self.response[place][*from] * (*unit * other.normal);
            *slot = if slips {
                link.normal.cross(moved) + self.spin[place][*from] * unit.y
            } else {
                link.normal.dot(moved)
            };
        }
        row[UNKNOWNS] = if slips {
            let after = match link.grip {
                Grip::Turns => -link.before,
                _ => R::ZERO,
            };
            after - link.normal.cross(link.free) - link.surface
        } else {
            link.wanted - link.normal.dot(link.free)
        };
    }

    /// Energy that the impulses give, where motions are velocities.
    pub(super) fn gained(&self) -> R {
        (0..self.count).fold(R::ZERO, |sum, place| {
            let Some(link) = self.get(place) else {
                return sum;
            };
            let mean = (link.free + self.motion(place)).times(R::HALF);
            let surface = R::HALF * (link.surface + self.surface(place));
            sum + link.push().dot(mean) + link.rubbed * surface
        })
    }

    /// Sets friction aside.
    pub(super) fn smooth(&mut self) {
        for link in self.all() {
            link.friction = R::ZERO;
            link.grip = Grip::Slides(R::ZERO);
        }
    }

    /// Each takes what comes into it, one after the other: that always ends, and only takes energy.
    pub(super) fn take_in_turn(&mut self) {
        for link in self.all() {
            (link.pressed, link.rubbed, link.wanted) = (R::ZERO, R::ZERO, R::ZERO);
        }
        for _ in 0..TURNS {
            for place in 0..self.count {
                let motion = self.motion(place);
                let own = self.response[place][place].x;
                if let Some(Some(link)) = self.link.get_mut(place) {
                    link.pressed += link.normal.dot(motion).most(R::ZERO) / own;
                }
            }
        }
    }
}

/// Solves by elimination; unknowns that the others tell already are 0.
fn eliminate<R: Real>(rows: &mut Rows<R>, count: usize) -> [R; UNKNOWNS] {
    let mut largest = R::ZERO;
    for row in rows.iter().take(count) {
        for value in row.iter().take(count) {
            largest = largest.most(value.abs());
        }
    }
    let least = R::lit(TOLD) * R::EPSILON * largest;
    // Of each unknown, the row that tells it.
    let mut told = [None; UNKNOWNS];
    let mut next = 0;
    for column in 0..count {
        let mut best = next;
        for row in next..count {
            if rows[row][column].abs() > rows[best][column].abs() {
                best = row;
            }
        }
        if next >= count || rows[best][column].abs() <= least {
            continue;
        }
        rows.swap(best, next);
        let pivot = rows[next];
        for (index, row) in rows.iter_mut().enumerate().take(count) {
            let factor = row[column] / pivot[column];
            if index == next || factor == R::ZERO {
                continue;
            }
            for (value, take) in row.iter_mut().zip(&pivot) {
                *value -= factor * *take;
            }
        }
        told[column] = Some(next);
        next += 1;
    }
    let mut found = [R::ZERO; UNKNOWNS];
    for (column, slot) in found.iter_mut().enumerate().take(count) {
        if let Some(row) = told[column] {
            *slot = rows[row][UNKNOWNS] / rows[row][column];
        }
    }
    found
}
