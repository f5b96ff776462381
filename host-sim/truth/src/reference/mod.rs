//! The truth: the rigid model's equations solved event by event, in closed form or by Taylor
//! series, independent of the model under test.
//!
//! Free flight is a parabola, its contact found among the roots of a polynomial; contact is a
//! series of order 24 on which the changes are located. Inside, everything is in units of the
//! clearance and of sqrt(clearance/g).

mod contact;
pub mod coupled;
mod flight;
mod impact;
mod jet;
pub mod press;
pub mod pulse;
mod roots;
mod scale;
mod series;
mod wall;

use crate::Units;
use contact::Contact;
use flight::Flight;
use impact::Settling;
use scale::{Law, Sum, units};
use touchdown_base::history::{Impact, ModelEvent, PhaseKind, RotorState};
pub use touchdown_base::machine::{Machine, Start};
use wall::WallState;

/// A position within this of the wall is on it, in parts of the clearance; likewise a direction.
const ON_WALL: f64 = 8.0 * f64::EPSILON;
/// Below this speed in contact the rotor is still, in units of sqrt(g clearance).
const STILL: f64 = 1e-9;

#[derive(Clone, Debug)]
enum Motion {
    Flight(Flight),
    Settling(Settling),
    Contact(Box<Contact>),
}

impl Motion {
    fn duration(&self) -> f64 {
        match self {
            Self::Flight(flight) => flight.duration,
            Self::Settling(settling) => settling.duration,
            Self::Contact(contact) => contact.duration(),
        }
    }

    /// After an impact, or from a point of the wall without one: the end of the series, a flight,
    /// or contact.
    fn leaving_wall(law: &Law, wall: WallState, launch: f64) -> Self {
        if let Some(settling) = Settling::after(law, wall, launch) {
            Self::Settling(settling)
        } else if launch > 0.0 || Contact::new(law, wall).lifts_off_at_once() {
            Self::Flight(Flight::from_wall(law, wall, launch))
        } else {
            Self::Settling(Settling::at_once(wall))
        }
    }
}

/// A drop, followed from its release.
#[derive(Clone, Debug)]
pub struct Reference {
    machine: Machine,
    law: Law,
    scale: Units,
    motion: Motion,
    /// Start of the motion, s.
    since: Sum,
    in_series: bool,
}

impl Reference {
    /// At the release; `spin` is counter-clockwise, rad/s.
    pub fn new(machine: &Machine, start: &Start, spin: f64) -> Self {
        let scale = units(machine, start, spin);
        let law = Law::of(machine);
        let surface = machine.radius * spin / scale.speed;
        let motion = match *start {
            Start::Free { position, velocity } => released(
                &law,
                position.map(|p| p / scale.length),
                velocity.map(|v| v / scale.speed),
                surface,
            ),
            Start::Wall { angle, tangential } => {
                let speed = tangential / scale.speed;
                Motion::Settling(Settling::at_once(WallState {
                    angle,
                    speed,
                    surface,
                    turns: 0.0,
                }))
            }
        };
        Self {
            machine: *machine,
            law,
            scale,
            motion,
            since: Sum::default(),
            in_series: false,
        }
    }

    /// Advances to `time` (finite, s since the release; times must not decrease), reporting every
    /// happening on the way in order.
    pub fn advance(&mut self, time: f64, on_event: &mut impl FnMut(ModelEvent)) -> RotorState {
        loop {
            let elapsed = (self.since.up_to(time) / self.scale.time).max(0.0);
            let duration = self.motion.duration();
            if elapsed < duration || !time.is_finite() {
                return self.state(time, elapsed);
            }
            self.since.add(duration * self.scale.time);
            self.pass(on_event);
        }
    }

    /// Phase at the current time; the bounce series goes on until permanent contact.
    pub fn phase(&self) -> PhaseKind {
        match &self.motion {
            Motion::Flight(_) if !self.in_series => PhaseKind::FreeFall,
            Motion::Flight(_) | Motion::Settling(_) => PhaseKind::Impact,
            Motion::Contact(contact) if contact.rolls() => PhaseKind::Rolling,
            Motion::Contact(_) => PhaseKind::Sliding,
        }
    }

    /// Speed below which a rotor in contact is still, m/s.
    pub fn still_speed(&self) -> f64 {
        STILL * self.scale.speed
    }

    fn pass(&mut self, on_event: &mut impl FnMut(ModelEvent)) {
        let time = self.since.value;
        match &mut self.motion {
            Motion::Flight(flight) => {
                let (wall, normal_speed) = flight.landing();
                self.land(wall, normal_speed, on_event);
            }
            Motion::Settling(settling) => {
                let contact = Contact::new(&self.law, settling.to);
                let rolling = contact.rolls();
                on_event(ModelEvent::ContactStart { time, rolling });
                self.in_series = false;
                self.motion = Motion::Contact(Box::new(contact));
            }
            Motion::Contact(contact) => {
                let change = contact.pass(time);
                if let Some(ModelEvent::LiftOff(_)) = change {
                    let flight = Flight::from_wall(&self.law, contact.wall(), 0.0);
                    self.motion = Motion::Flight(flight);
                }
                change.into_iter().for_each(on_event);
            }
        }
    }

    fn land(&mut self, wall: WallState, normal_speed: f64, on_event: &mut impl FnMut(ModelEvent)) {
        let impulse = (1.0 + self.law.restitution) * normal_speed;
        let launch = self.law.restitution * normal_speed;
        let wall = impact::rub(&self.law, wall, impulse);
        if normal_speed > 0.0 {
            self.in_series = true;
            on_event(ModelEvent::Impact(Impact {
                state: self.on_wall(self.since.value, &wall, -launch),
                normal_speed: normal_speed * self.scale.speed,
                normal_impulse: self.machine.mass * impulse * self.scale.speed,
                pulse: None,
            }));
        }
        self.motion = Motion::leaving_wall(&self.law, wall, launch);
    }

    fn state(&self, time: f64, elapsed: f64) -> RotorState {
        match &self.motion {
            Motion::Flight(flight) => {
                let (position, velocity) = flight.at(elapsed);
                self.si(time, position, velocity, flight.surface, 0.0)
            }
            Motion::Settling(settling) => self.on_wall(time, &settling.at(elapsed), 0.0),
            Motion::Contact(contact) => self.on_wall(time, &contact.at(elapsed), 0.0),
        }
    }

    fn on_wall(&self, time: f64, wall: &WallState, normal: f64) -> RotorState {
        let (position, velocity) = wall.motion(normal);
        self.si(time, position, velocity, wall.surface, wall.turns)
    }

    fn si(&self, time: f64, p: [f64; 2], v: [f64; 2], surface: f64, turns: f64) -> RotorState {
        RotorState {
            time,
            position: p.map(|p| p * self.scale.length),
            velocity: v.map(|v| v * self.scale.speed),
            spin: surface * self.scale.speed / self.machine.radius,
            turns_in_contact: turns,
        }
    }
}

/// The first motion of a free start.
fn released(law: &Law, position: [f64; 2], velocity: [f64; 2], surface: f64) -> Motion {
    let distance = f64::hypot(position[0], position[1]);
    if distance < 1.0 - ON_WALL {
        return Motion::Flight(Flight::from_inside(law, position, velocity, surface));
    }
    let wall = WallState::from_cartesian(position, velocity, surface);
    let outward = (position[0] * velocity[0] + position[1] * velocity[1]) / distance;
    let rounding = ON_WALL * f64::hypot(velocity[0], velocity[1]);
    if outward > rounding {
        Motion::Flight(Flight::ended(law, wall, outward))
    } else if outward < -rounding {
        Motion::Flight(Flight::from_wall(law, wall, -outward))
    } else {
        Motion::leaving_wall(law, wall, 0.0)
    }
}

/// Translation, spin and height, J.
pub fn energy(machine: &Machine, state: &RotorState) -> f64 {
    let [vx, vy] = state.velocity;
    0.5 * machine.mass * (vx * vx + vy * vy)
        + 0.5 * machine.polar_inertia * state.spin * state.spin
        + machine.mass * machine.gravity * state.position[1]
}
