//! Permanent contact: sliding, rolling, and the changes between them and to flight.

use super::roots::{first_fall, value};
use super::scale::{Law, Sum};
use super::series::{Grip, Series, Terms};
use super::wall::{ROUNDING, WallState};
use std::f64::consts::{PI, TAU};
use touchdown_base::history::ModelEvent;

/// What the rounded `TAU` leaves out.
const TAU_REST: f64 = 2.449_293_598_294_706_4e-16;
/// Changes of grip at one moment before a short step is forced.
const MAX_CHANGES: u32 = 4;
/// Length of the forced step.
const FORCED_STEP: f64 = 1e-7;

/// How a step of the contact ends.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Ending {
    Step,
    SlipEnds,
    GripLost(f64),
    LiftsOff,
}

/// A contact, one step of it at a time.
#[derive(Clone, Debug)]
pub struct Contact {
    law: Law,
    grip: Grip,
    angle: Sum,
    speed: Sum,
    surface: Sum,
    start_angle: f64,
    whole_turns: f64,
    series: Series,
    /// Part of the span until the ending.
    end: f64,
    ending: Ending,
    changes: u32,
}

impl Contact {
    /// Begins at a wall state.
    pub fn new(law: &Law, wall: WallState) -> Self {
        let slip = wall.speed + wall.surface;
        let slips = slip.abs() > ROUNDING * (wall.speed.abs() + wall.surface.abs());
        let surface = if slips { wall.surface } else { -wall.speed };
        let wall = WallState { surface, ..wall };
        let grip = if slips {
            Grip::Slip(slip.signum())
        } else {
            grip_without_slip(law, &wall)
        };
        let mut contact = Self {
            law: *law,
            grip,
            angle: Sum::new(wall.angle),
            speed: Sum::new(wall.speed),
            surface: Sum::new(wall.surface),
            start_angle: wall.angle,
            whole_turns: 0.0,
            series: Series::new(law, &wall, grip),
            end: 0.0,
            ending: Ending::Step,
            changes: 0,
        };
        contact.locate_ending();
        contact
    }

    /// Without slip.
    pub fn rolls(&self) -> bool {
        self.grip == Grip::Roll
    }

    /// The wall falls away at the very start.
    pub fn lifts_off_at_once(&self) -> bool {
        self.ending == Ending::LiftsOff && self.end == 0.0
    }

    /// Until the end of the step.
    pub fn duration(&self) -> f64 {
        self.end * self.series.span
    }

    /// The state within the step.
    pub fn at(&self, elapsed: f64) -> WallState {
        let part = elapsed / self.series.span;
        let angle = self.series.angle.at(part);
        WallState {
            angle,
            speed: self.series.speed.at(part),
            surface: self.series.surface.at(part),
            turns: self.whole_turns + (angle - self.start_angle) / TAU,
        }
    }

    /// Goes to the end of the step, at this time, and begins the next; after a lift-off there is none. What changes there.
    pub fn pass(&mut self, time: f64) -> Option<ModelEvent> {
        let rise = |terms: &Terms| self.end * value(&terms.0[1..], self.end);
        let rises = [&self.series.angle, &self.series.speed, &self.series.surface].map(rise);
        self.angle.add(rises[0]);
        self.speed.add(rises[1]);
        self.surface.add(rises[2]);
        self.changes = if self.end > 0.0 { 0 } else { self.changes + 1 };
        if self.angle.value.abs() > PI {
            let turn = self.angle.value.signum() * (self.angle.value.abs() / TAU).round();
            self.angle.add(-turn * TAU);
            self.angle.add(-turn * TAU_REST);
            self.whole_turns += turn;
        }
        let grip = self.grip;
        match self.ending {
            Ending::Step => {}
            Ending::LiftsOff => return Some(ModelEvent::LiftOff(time)),
            Ending::GripLost(sign) => self.grip = Grip::Slip(sign),
            Ending::SlipEnds => {
                self.surface = Sum::new(-self.speed.value);
                self.grip = grip_without_slip(&self.law, &self.wall());
            }
        }
        if self.grip == Grip::Roll {
            self.surface = Sum::new(-self.speed.value);
        }
        self.series = Series::new(&self.law, &self.wall(), self.grip);
        self.locate_ending();
        match (grip, self.grip) {
            (Grip::Slip(_), Grip::Roll) => Some(ModelEvent::RollingStart(time)),
            (Grip::Roll, Grip::Slip(_)) => Some(ModelEvent::SlidingStart(time)),
            _ => None,
        }
    }

    /// The state at the start of the step.
    pub fn wall(&self) -> WallState {
        WallState {
            angle: self.angle.value,
            speed: self.speed.value,
            surface: self.surface.value,
            turns: 0.0,
        }
    }

    fn locate_ending(&mut self) {
        let (series, wall) = (&self.series, self.wall());
        (self.end, self.ending) = (1.0, Ending::Step);
        let mut earlier = |end: Option<f64>, ending: Ending| {
            if let Some(end) = end.filter(|end| *end < self.end) {
                (self.end, self.ending) = (end, ending);
            }
        };
        match self.grip {
            Grip::Slip(sign) => {
                let rounding = wall.pressing_rounding(&self.law);
                let falls = first_fall(&series.normal_acceleration.0, rounding);
                earlier(falls, Ending::LiftsOff);
                let slip = (series.speed + series.surface) * sign;
                let size = wall.speed.abs() + wall.surface.abs() + self.law.gravity;
                earlier(first_fall(&slip.0, ROUNDING * size), Ending::SlipEnds);
            }
            Grip::Roll => {
                for sign in [-1.0, 1.0] {
                    let margin = grip_margin(&self.law, series, sign);
                    let falls = first_fall(&margin.0, margin_rounding(&self.law, &wall));
                    earlier(falls, Ending::GripLost(sign));
                }
            }
        }
        if self.changes >= MAX_CHANGES && self.ending != Ending::LiftsOff {
            self.end = self.end.max(FORCED_STEP);
        }
    }
}

/// What friction has left before slip of a sign begins, in rolling.
fn grip_margin(law: &Law, rolling: &Series, sign: f64) -> Terms {
    let share = sign * law.inertia / (1.0 + law.inertia);
    rolling.normal_acceleration * law.friction + rolling.weight * share
}

fn margin_rounding(law: &Law, wall: &WallState) -> f64 {
    law.friction * wall.pressing_rounding(law) + ROUNDING * law.gravity
}

/// Rolling, or the slip that begins where friction can't hold it.
fn grip_without_slip(law: &Law, wall: &WallState) -> Grip {
    let rolling = Series::new(law, wall, Grip::Roll);
    let rounding = margin_rounding(law, wall);
    [-1.0, 1.0]
        .into_iter()
        .find(|sign| first_fall(&grip_margin(law, &rolling, *sign).0, rounding) == Some(0.0))
        .map_or(Grip::Roll, Grip::Slip)
}
