//! Which links are closed, and how: the modes that last.

use super::super::impact::{self, Touching};
use super::super::step::{Ending, Step};
use super::super::system::Mode;
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
            Ending::Touch(link) => self.modes[link] = self.closed(link),
            Ending::LiftOff(link) => self.modes[link] = Mode::Flight,
            Ending::SlipEnds(link) => self.modes[link] = Mode::Stick,
            Ending::GripLost(link, sign) => self.modes[link] = Mode::Slide(sign),
            Ending::Cut { magnet, axis, sign } => {
                self.surroundings.magnets[magnet].cut[axis] = sign
            }
        }
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
        let Some(clearance) = self.system.links[link].clearance() else {
            return match self.modes[link] {
                Mode::Stick => any.to_vec(),
                mode => vec![mode],
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
            if self.modes[link] != Mode::Flight {
                impact::keep_place(&self.system, link, &mut self.place);
            }
        }
        impact::keep_speed(&self.system, &self.modes, &self.place, &mut self.speed);
        let since = self.since.value;
        let next = self.surroundings.reach(since, &self.place, &self.speed);
        let until = next - since;
        self.step = Step::new(
            &self.system,
            &self.surroundings,
            &self.modes,
            (&self.place, &self.speed),
            (self.accuracy, until.min(LONGEST * self.units.0)),
        );
        self.cost += self.step.cost;
    }
}
