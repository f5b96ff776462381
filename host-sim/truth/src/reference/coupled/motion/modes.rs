//! Which links are closed, and how: the modes that last.

use super::super::keep;
use super::super::seat::{SLOWEST, SeatLink};
use super::super::step::{Bounds, Ending, Step};
use super::super::system::{Hold, Mode};
use super::{Motion, ON_WALL};

/// Slip below this part of the speeds that it is made of is none.
const NO_SLIP: f64 = 64.0 * f64::EPSILON;
/// Changes of mode at one moment before all sets of modes are tried.
const MAX_CHANGES: u32 = 8;
/// Longest step, in units of time.
const LONGEST: f64 = 1.0;
/// Length of a step forced where no set of modes lasts, in units of time; doubled with each that
/// follows on another.
pub const FORCED_STEP: f64 = 1e-7;
/// Longest of them.
const LONGEST_FORCED: f64 = 1e-3;

impl Motion {
    pub(super) fn change(&mut self, ending: Ending) {
        match ending {
            Ending::Step => {}
            Ending::Touch(link) => self.close(link),
            Ending::Left(link) => {
                if let Hold::Soft(soft) = &mut self.system.links[link].hold {
                    soft.within = None;
                }
                self.set(link, Mode::Flight);
            }
            Ending::PressedAgain(link) => self.set(link, self.closed(link)),
            Ending::LiftOff(link) => self.set(link, Mode::Flight),
            Ending::SlipEnds(link) => match self.seat(link) {
                Some(seat) if !seat.stops(&self.system, &self.now.speed, self.slowest()) => {}
                _ => self.set(link, Mode::Stick),
            },
            Ending::GripLost(link, sign) => {
                if self.seat(link).is_some() {
                    self.set_off(link);
                }
                self.set(link, Mode::Slide(sign));
            }
            Ending::Cut { magnet, axis, sign } => {
                self.surroundings.magnets[magnet].cut[axis] = sign
            }
        }
    }

    /// A link goes on like this.
    pub(super) fn set(&mut self, link: usize, mode: Mode) {
        self.system.links[link].mode = mode;
    }

    fn close(&mut self, link: usize) {
        let closing = self.touch(link).closing;
        if let Hold::Soft(soft) = &mut self.system.links[link].hold {
            soft.enter(closing);
        }
        self.set(link, self.closed(link));
    }

    fn seat(&self, link: usize) -> Option<SeatLink> {
        SeatLink::all(&self.system).find(|seat| seat.link == link)
    }

    /// Speed at which a sliding ring is at rest, m/s.
    fn slowest(&self) -> f64 {
        SLOWEST * self.units.1
    }

    /// A ring that its seat holds no longer begins to slide.
    fn set_off(&mut self, link: usize) {
        let held = self.step.held(link, self.step.end);
        let velocity = SeatLink::set_off(held, self.slowest());
        keep::set_off(&self.system, link, velocity, &mut self.now);
    }

    /// Rings that slide no faster than the cut-off are at rest; whether there are any.
    fn seats_stop(&mut self) -> bool {
        let slow = |seat: &SeatLink| {
            let speed = seat.speed(&self.system, &self.now.speed);
            speed <= self.slowest()
        };
        let slow: Vec<_> = SeatLink::sliding(&self.system).filter(slow).collect();
        for seat in &slow {
            self.set(seat.link, Mode::Stick);
        }
        !slow.is_empty()
    }

    /// How a link that touches goes on: with slip or without.
    pub(super) fn closed(&self, link: usize) -> Mode {
        if self.system.links[link].friction() == 0.0 {
            return Mode::Slide(0.0);
        }
        let slip = self.touch(link).slip(&self.system, &self.now.speed);
        let rounding = NO_SLIP * self.system.links[link].slip_size(&self.now.speed);
        if slip.abs() <= rounding {
            Mode::Stick
        } else {
            Mode::Slide(slip.signum())
        }
    }

    pub(super) fn distance(&self, link: usize) -> f64 {
        let [x, y] = self.system.links[link].lateral(&self.now.place);
        f64::hypot(x, y)
    }

    /// Begins the next step, with the modes that are possible now.
    pub(super) fn settle(&mut self) {
        for _ in 0..MAX_CHANGES {
            self.begin();
            if self.step.end > 0.0 {
                self.forced = FORCED_STEP;
                return;
            }
            if let Ending::Touch(link) = self.step.ending
                && self.touch(link).closing > self.cutoff(link)
            {
                return;
            }
            self.change(self.step.ending);
        }
        if self.search() {
            return;
        }
        let part = self.forced * self.units.0 / self.step.span;
        (self.step.end, self.step.ending) = (part.min(1.0), Ending::Step);
        self.forced = (2.0 * self.forced).min(LONGEST_FORCED);
    }

    /// Tries all modes of the links that touch until a set of them lasts.
    fn search(&mut self) -> bool {
        let choices = self.each(|link, _| self.choices(link));
        let sets = choices.iter().map(Vec::len).product();
        for set in 0..sets {
            if self.given_up().is_some() {
                return false;
            }
            let mut rest: usize = set;
            for (link, choices) in self.system.links.iter_mut().zip(&choices) {
                link.mode = choices[rest % choices.len()];
                rest /= choices.len();
            }
            self.begin();
            if self.step.end > 0.0 {
                self.forced = FORCED_STEP;
                return true;
            }
        }
        false
    }

    fn choices(&self, link: usize) -> Vec<Mode> {
        let any = [Mode::Stick, Mode::Slide(1.0), Mode::Slide(-1.0)];
        let Some(clearance) = self.system.links[link].rigid() else {
            let link = &self.system.links[link];
            return match (link.hold, link.mode) {
                (Hold::Brake(_), Mode::Stick) => any.to_vec(),
                (_, mode) => vec![mode],
            };
        };
        let apart = self.distance(link) < (1.0 - ON_WALL) * clearance;
        if apart || self.touch(link).closing.abs() > self.cutoff(link) {
            return vec![Mode::Flight];
        }
        let mut choices = match self.closed(link) {
            Mode::Stick => any.to_vec(),
            mode => vec![mode],
        };
        choices.push(Mode::Flight);
        choices
    }

    fn begin(&mut self) {
        for (number, link) in self.system.links.iter().enumerate() {
            if link.rigid().is_some() && link.mode != Mode::Flight {
                keep::keep_place(&self.system, number, &mut self.now.place);
            }
        }
        keep::keep_speed(&self.system, &mut self.now);
        if self.seats_stop() {
            keep::keep_speed(&self.system, &mut self.now);
        }
        let since = self.since.value;
        let until = self.surroundings.reach(since, &self.now) - since;
        let bounds = Bounds {
            accuracy: self.accuracy,
            longest: until.min(LONGEST * self.units.0),
            speed: self.units.1,
        };
        self.step = Step::new(&self.system, &self.surroundings, &self.now, bounds);
        self.cost += self.step.cost;
    }
}
