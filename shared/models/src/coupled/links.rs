//! All walls that the machine touches at once, solved together: retainer rings round the rotor, and hard
//! stops round the rings.
//!
//! In what a link's impulse moves all is linear: the motion into its wall, and the slip along it. Which
//! links press, and which of them slide, is found by trial: a link that would pull is opened, one that
//! would go through is closed, friction that is too large slides, a slip that friction would drive sticks.
//!
//! Friction takes energy, however coarse the step: it ends the slip, but gives no more than what makes the mean of
//! the slips before and after 0, and nothing where the slip turns round by itself.

use super::vector::{Mobility, Vector};
use touchdown_rotor::real::Real;

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
    /// Further motion along the normal by the impulse: the wall gives way.
    pub(super) softness: R,
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
            softness: R::ZERO,
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

/// All walls that are touched, each at its place: [`contact`] or [`stop`] of its ring.
#[derive(Clone, Copy, Debug)]
pub(super) struct Links<R, const N: usize> {
    link: Pairs<Option<Link<R>>, N>,
    /// Motion of the first by an impulse in the second; of the slip, by a tangential one, what is not motion.
    response: Pairs<Pairs<(Mobility<R>, R), N>, N>,
    /// Linear systems solved.
    pub(super) systems: u32,
}

/// For each link; `N` rings have a contact and a stop each.
type Pairs<T, const N: usize> = [[T; 2]; N];

/// Place of a ring's contact in the order of all links.
pub(super) const fn contact(ring: usize) -> usize {
    2 * ring
}

/// Place of its stop.
pub(super) const fn stop(ring: usize) -> usize {
    2 * ring + 1
}

/// For each unknown: normal and friction of the contacts, normal of the stops.
type Unknowns<T, const N: usize> = [[T; 3]; N];

impl<R: Real, const N: usize> Links<R, N> {
    pub(super) fn new() -> Self {
        Self {
            link: [[None; 2]; N],
            response: [[[[(Mobility::default(), R::ZERO); 2]; N]; 2]; N],
            systems: 0,
        }
    }

    /// Each, and its place.
    fn links(&self) -> impl Iterator<Item = (usize, &Link<R>)> {
        let places = self.link.as_flattened().iter().enumerate();
        places.filter_map(|(place, link)| Some((place, link.as_ref()?)))
    }

    pub(super) fn put(&mut self, place: usize, link: Link<R>) {
        if let Some(slot) = self.link.as_flattened_mut().get_mut(place) {
            *slot = Some(link);
        }
    }

    pub(super) fn get(&self, place: usize) -> Option<&Link<R>> {
        self.link.as_flattened().get(place)?.as_ref()
    }

    /// The link that presses there.
    pub(super) fn pressing(&self, place: usize) -> Option<&Link<R>> {
        self.get(place).filter(|it| it.grip != Grip::Open)
    }

    pub(super) fn get_mut(&mut self, place: usize) -> Option<&mut Link<R>> {
        self.link.as_flattened_mut().get_mut(place)?.as_mut()
    }

    pub(super) fn all(&mut self) -> impl Iterator<Item = &mut Link<R>> {
        self.link.as_flattened_mut().iter_mut().flatten()
    }

    pub(super) fn respond(&mut self, to: usize, from: usize, motion: Mobility<R>, spin: R) {
        if let Some(row) = self.response.as_flattened_mut().get_mut(to)
            && let Some(slot) = row.as_flattened_mut().get_mut(from)
        {
            *slot = (motion, spin);
        }
    }

    /// Each link, and what its impulse does at a place.
    fn responses(&self, to: usize) -> impl Iterator<Item = (&Link<R>, &(Mobility<R>, R))> {
        let row = self.response.as_flattened().get(to);
        let row = row.into_iter().flat_map(|it| it.as_flattened());
        let all = self.link.as_flattened().iter().zip(row);
        all.filter_map(|(link, response)| Some((link.as_ref()?, response)))
    }

    /// Motion with all impulses.
    pub(super) fn motion(&self, place: usize) -> Vector<R> {
        let free = self.get(place).map_or(Vector::default(), |it| it.free);
        let others = self.responses(place);
        others.fold(free, |sum, (it, (motion, _))| sum + motion.to(it.push()))
    }

    /// Of the slip, what is not motion, with all impulses.
    pub(super) fn surface(&self, place: usize) -> R {
        let surface = self.get(place).map_or(R::ZERO, |it| it.surface);
        let others = self.responses(place);
        others.fold(surface, |sum, (it, (_, spin))| sum + *spin * it.rubbed)
    }

    /// Finds all impulses; false where no set of links that press and slide was found to hold.
    pub(super) fn solve(&mut self) -> bool {
        let close = R::lit(CLOSE) * R::EPSILON * self.size();
        for trial in 0..TRIALS {
            self.solve_linear();
            let mut holds = true;
            // A wall that its own rounding opens and closes stays open.
            let least = if trial < TOGETHER { R::ZERO } else { close };
            for place in 0..2 * N {
                let Some(grip) = self.corrected(place, close, least) else {
                    continue;
                };
                if let Some(link) = self.get_mut(place) {
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
        self.links().fold(R::ZERO, |most, (_, link)| {
            most.most(link.free.length() + link.wanted.abs() + link.surface.abs())
        })
    }

    /// What a link does rather; none where it is right. An open one is closed by a motion into the wall above `least`.
    fn corrected(&self, place: usize, close: R, least: R) -> Option<Grip<R>> {
        let link = self.get(place)?;
        let motion = self.motion(place);
        let slip = link.normal.cross(motion) + self.surface(place);
        let most = link.friction * link.pressed;
        match link.grip {
            Grip::Open => {
                let through = link.normal.dot(motion) - link.wanted > least;
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
        self.systems += 1;
        // Of each unknown: its link, and the impulse of a unit of it as (-normal, tangential).
        let mut all: Unknowns<(usize, Vector<R>), N> = [[(0, Vector::default()); 3]; N];
        let mut count = 0;
        for (place, link) in self.links() {
            let (one, also) = match link.grip {
                Grip::Open => continue,
                Grip::Slides(friction) => (Vector::new([-R::ONE, friction]), false),
                Grip::Sticks | Grip::Turns => (Vector::new([-R::ONE, R::ZERO]), true),
            };
            let slip = Vector::new([R::ZERO, R::ONE]);
            for unit in [Some(one), also.then_some(slip)].into_iter().flatten() {
                if let Some(slot) = all.as_flattened_mut().get_mut(count) {
                    *slot = (place, unit);
                    count += 1;
                }
            }
        }
        let mut rows = [[[[R::ZERO; 3]; N]; 3]; N];
        let mut right = [[R::ZERO; 3]; N];
        let unknowns = &all.as_flattened()[..count];
        let equations = rows.as_flattened_mut().iter_mut();
        let equations = equations.zip(right.as_flattened_mut());
        for ((row, right), unknown) in equations.zip(unknowns) {
            *right = self.fill(row.as_flattened_mut(), unknown, unknowns);
        }
        let found = solved(rows, right, count);
        for link in self.all() {
            (link.pressed, link.rubbed) = (R::ZERO, R::ZERO);
        }
        for ((place, unit), value) in unknowns.iter().zip(found.as_flattened()) {
            if let Some(link) = self.get_mut(*place) {
                link.pressed += -(unit.x * *value);
                link.rubbed += unit.y * *value;
            }
        }
    }

    /// The equation of an unknown's link, of its slip or of its motion along the normal; its right side.
    fn fill(
        &self,
        row: &mut [R],
        (place, unit): &(usize, Vector<R>),
        unknowns: &[(usize, Vector<R>)],
    ) -> R {
        let (place, slips) = (*place, unit.x == R::ZERO);
        let Some(link) = self.get(place) else {
            return R::ZERO;
        };
        let response = self.response[place / 2][place % 2].as_flattened();
        for (slot, (from, unit)) in row.iter_mut().zip(unknowns) {
            let (Some(other), (motion, spin)) = (self.get(*from), response[*from]) else {
                continue;
            };
            let moved = motion.to(*unit * other.normal);
            *slot = if slips {
                link.normal.cross(moved) + spin * unit.y
            } else {
                link.normal.dot(moved)
            };
        }
        if !slips {
            let wanted = link.wanted - link.normal.dot(link.free);
            if link.softness <= R::ZERO {
                return wanted;
            }
            // In the size of the other rows: a wall that hardly presses is as soft as can be.
            let size = R::ONE / (R::ONE + link.softness);
            for (slot, (from, unit)) in row.iter_mut().zip(unknowns) {
                let gives = if *from == place {
                    link.softness * unit.x
                } else {
                    R::ZERO
                };
                *slot = (*slot + gives) * size;
            }
            return wanted * size;
        }
        let after = match link.grip {
            Grip::Turns => -link.before,
            _ => R::ZERO,
        };
        after - link.normal.cross(link.free) - link.surface
    }

    /// Energy that the impulses give, where motions are velocities.
    pub(super) fn gained(&self) -> R {
        self.links().fold(R::ZERO, |sum, (place, link)| {
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
            for place in 0..2 * N {
                let motion = self.motion(place);
                let (own, _) = self.response[place / 2][place % 2].as_flattened()[place];
                if let Some(link) = self.get_mut(place) {
                    let own = own.own(link.normal);
                    link.pressed += link.normal.dot(motion).most(R::ZERO) / own;
                }
            }
        }
    }
}

/// Solves the first `count` rows by elimination, to the right side; unknowns that the others tell already are 0.
fn solved<R: Real, const N: usize>(
    mut rows: Unknowns<Unknowns<R, N>, N>,
    mut right: Unknowns<R, N>,
    count: usize,
) -> Unknowns<R, N> {
    let (rows, right) = (rows.as_flattened_mut(), right.as_flattened_mut());
    let mut largest = R::ZERO;
    for row in rows.iter().take(count) {
        for value in row.as_flattened().iter().take(count) {
            largest = largest.most(value.abs());
        }
    }
    let least = R::lit(TOLD) * R::EPSILON * largest;
    let mut found = [[R::ZERO; 3]; N];
    // Of each unknown, the row that tells it.
    let mut told = [[None; 3]; N];
    let mut next = 0;
    for column in 0..count {
        let at = |row: &Unknowns<R, N>| row[column / 3][column % 3];
        let mut best = next;
        for row in next..count {
            if at(&rows[row]).abs() > at(&rows[best]).abs() {
                best = row;
            }
        }
        if next >= count || at(&rows[best]).abs() <= least {
            continue;
        }
        rows.swap(best, next);
        right.swap(best, next);
        let (pivot, pivot_right) = (rows[next], right[next]);
        for index in 0..count {
            let factor = at(&rows[index]) / at(&pivot);
            if index == next || factor == R::ZERO {
                continue;
            }
            let values = rows[index].as_flattened_mut().iter_mut();
            for (value, take) in values.zip(pivot.as_flattened()).take(count) {
                *value -= factor * *take;
            }
            right[index] -= factor * pivot_right;
        }
        told[column / 3][column % 3] = Some(next);
        next += 1;
    }
    for column in 0..count {
        if let Some(row) = told[column / 3][column % 3] {
            found[column / 3][column % 3] = right[row] / rows[row][column / 3][column % 3];
        }
    }
    found
}
