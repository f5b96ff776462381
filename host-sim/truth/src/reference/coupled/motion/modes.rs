//! Which links are closed, and how: the modes that last.

use super::super::impact::Touching;
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
            Ending::Left(link) => self.leave(link),
            Ending::PressedAgain(link) => self.modes[link] = self.closed(link),
            Ending::LiftOff(link) => self.modes[link] = Mode::Flight,
            Ending::SlipEnds(link) => match self.seat(link) {
                Some(seat) if !seat.stops(&self.system, &self.speed, self.slowest()) => {}
                _ => self.modes[link] = Mode::Stick,
            },
            Ending::GripLost(link, sign) => {
                if self.seat(link).is_some() {
                    self.set_off(link);
                }
                self.modes[link] = Mode::Slide(sign);
            }
            Ending::Cut { magnet, axis, sign } => {
                self.surroundings.magnets[magnet].cut[axis] = sign
            }
        }
    }

    fn close(&mut self, link: usize) {
        let closing = Touching::new(&self.system, link, &self.place, &self.speed).closing;
        if let Hold::Soft(soft) = &mut self.system.links[link].hold {
            soft.enter(closing);
        }
        self.modes[link] = self.closed(link);
    }

    fn leave(&mut self, link: usize) {
        if let Hold::Soft(soft) = &mut self.system.links[link].hold {
            soft.leave();
        }
        self.modes[link] = Mode::Flight;
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
        let set_off = (link, velocity);
        keep::set_off(
            &self.system,
            &self.modes,
            set_off,
            &self.place,
            &mut self.speed,
        );
    }

    fn keep_speed(&mut self) {
        keep::keep_speed(&self.system, &self.modes, &self.place, &mut self.speed);
    }

    /// Rings that slide no faster than the cut-off are at rest; whether there are any.
    fn seats_stop(&mut self) -> bool {
        let mut any = false;
        for seat in SeatLink::all(&self.system) {
            let slow = seat.speed(&self.system, &self.speed) <= self.slowest();
            if slow && self.modes[seat.link] != Mode::Stick {
                self.modes[seat.link] = Mode::Stick;
                any = true;
            }
        }
        any
    }

    /// How a link that touches goes on: with slip or without.
    pub(super) fn closed(&self, link: usize) -> Mode {
        if self.system.links[link].friction() == 0.0 {
            return Mode::Slide(0.0);
        }
        let slip = Touching::new(&self.system, link, &self.place, &self.speed)
            .slip(&self.system, &self.speed);
        let rounding = NO_SLIP * self.system.links[link].slip_size(&self.speed);
        if slip.abs() <= rounding {
            Mode::Stick
        } else {
            Mode::Slide(slip.signum())
        }
    }

    pub(super) fn distance(&self, link: usize) -> f64 {
        let [x, y] = self.system.links[link].lateral(&self.place);
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
            if let Ending::Touch(link) = self.step.ending {
                let touch = Touching::new(&self.system, link, &self.place, &self.speed);
                if touch.closing > self.cutoff(link) {
                    return;
                }
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
        let links = 0..self.modes.len();
        let choices: Vec<Vec<Mode>> = links.map(|link| self.choices(link)).collect();
        let sets = choices.iter().map(Vec::len).product();
        for set in 0..sets {
            if self.given_up().is_some() {
                return false;
            }
            let mut rest: usize = set;
            for (mode, choices) in self.modes.iter_mut().zip(&choices) {
                *mode = choices[rest % choices.len()];
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
            return match (self.system.links[link].hold, self.modes[link]) {
                (Hold::Brake(_), Mode::Stick) => any.to_vec(),
                (_, mode) => vec![mode],
            };
        };
        let touch = Touching::new(&self.system, link, &self.place, &self.speed);
        let apart = self.distance(link) < (1.0 - ON_WALL) * clearance;
        if apart || touch.closing.abs() > self.cutoff(link) {
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
        for link in 0..self.modes.len() {
            let rigid = self.system.links[link].rigid().is_some();
            if rigid && self.modes[link] != Mode::Flight {
                keep::keep_place(&self.system, link, &mut self.place);
            }
        }
        self.keep_speed();
        if self.seats_stop() {
            self.keep_speed();
        }
        let since = self.since.value;
        let next = self.surroundings.reach(since, &self.place, &self.speed);
        let until = next - since;
        self.step = Step::new(
            &self.system,
            &self.surroundings,
            &self.modes,
            (&self.place, &self.speed),
            Bounds {
                accuracy: self.accuracy,
                longest: until.min(LONGEST * self.units.0),
                speed: self.units.1,
                slowest: self.slowest(),
            },
        );
        self.cost += self.step.cost;
    }
}
