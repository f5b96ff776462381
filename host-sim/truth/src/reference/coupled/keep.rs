//! What keeps closed links closed against rounding, and sets off what a seat no longer holds.

use super::super::jet::dot;
use super::impact::Touching;
use super::linear::solve;
use super::seat::SeatLink;
use super::system::{Coordinates, Hold, Mode, System};

/// Takes the normal speed of a link.
pub fn arrest(system: &System, link: usize, now: &mut Coordinates) {
    let touch = Touching::new(system, link, now);
    let impulse = touch.closing / system.lateral(link, link);
    touch.press(system, impulse, &mut now.speed);
}

/// Takes what is left of normal speed and slip from links that have none.
pub fn keep_speed(system: &System, now: &mut Coordinates) {
    meet(system, &kept(system, now), &mut now.speed);
}

/// Gives a ring at rest on its seat this velocity, with what closed links do then.
pub fn set_off(system: &System, seat: usize, velocity: [f64; 2], now: &mut Coordinates) {
    let mut kept = kept(system, now);
    for it in kept.iter_mut().filter(|it| it.link == seat) {
        it.speed -= dot(&it.direction, &velocity);
    }
    meet(system, &kept, &mut now.speed);
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
fn kept(system: &System, now: &Coordinates) -> Vec<Kept> {
    let speed = &now.speed;
    let mut kept = Vec::new();
    let mut keep = |link, direction, turn, speed| {
        kept.push(Kept {
            link,
            direction,
            turn,
            speed,
        });
    };
    for (index, link) in system.links.iter().enumerate() {
        match (link.hold, link.mode) {
            (_, Mode::Flight)
            | (Hold::Brake(_) | Hold::Soft(_), Mode::Slide(_))
            | (Hold::Seat { .. }, _) => {}
            (Hold::Soft(_), Mode::Stick) => {
                let touch = Touching::new(system, index, now);
                let [x, y] = touch.normal;
                keep(index, [-y, x], 1.0, touch.slip(system, speed));
            }
            (Hold::Brake(_), Mode::Stick) => keep(index, [0.0; 2], 1.0, link.turning(speed)),
            (Hold::Wall { .. }, mode) => {
                let touch = Touching::new(system, index, now);
                let [x, y] = touch.normal;
                keep(index, [x, y], 0.0, touch.closing);
                if mode == Mode::Stick {
                    keep(index, [-y, x], 1.0, touch.slip(system, speed));
                }
            }
        }
    }
    for seat in SeatLink::all(system) {
        let link = &system.links[seat.link];
        if link.mode != Mode::Stick {
            continue;
        }
        let rate = link.lateral(speed);
        for direction in seat.directions(system, &now.place) {
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
