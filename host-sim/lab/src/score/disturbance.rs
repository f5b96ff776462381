//! What moves a floating rotor, or its sensors' readings, without any loss of levitation.

use std::f64::consts::{PI, TAU};

use rand::Rng;
use rand_chacha::ChaCha8Rng;
use rand_distr::{Distribution, StandardNormal};
use touchdown_base::evenly::direction;
use touchdown_core::sensing::PLANES;

/// What a disturbance adds to the position in each plane, m.
pub type Shift = [[f64; 2]; PLANES];

/// Natural frequency of the closed loop that holds the rotor, rad/s, and its damping.
const LOOP: f64 = TAU * 100.0;
const DAMPING: f64 = 0.5;
/// Standard gravity, m/s^2.
const G: f64 = 9.81;

/// From 0 to 1 in unit time with no jump of acceleration.
pub fn smooth(t: f64) -> f64 {
    let t = t.clamp(0.0, 1.0);
    t * t * t * (10.0 - 15.0 * t + 6.0 * t * t)
}

/// Mains hum of both axes and planes, as magnetic stray fields give.
pub fn hum(time: f64) -> Shift {
    [[2e-6 * (TAU * 50.0 * time).sin(); 2]; PLANES]
}

/// Readings that jump by one count, each channel about once a second, after one sample more of `period` s. `count` is the
/// size of one, m.
pub fn steps(shift: &mut Shift, random: &mut ChaCha8Rng, period: f64, count: f64) -> Shift {
    for shift in shift.iter_mut().flatten() {
        if random.random_bool(period.min(1.0)) {
            *shift = if *shift == 0.0 { count } else { 0.0 };
        }
    }
    *shift
}

/// Rms of the coloured noise, m, and its corner, Hz.
const COLOURED: f64 = 1e-6;
const CORNER: f64 = 500.0;

/// Gaussian noise of a first-order spectrum, each channel its own, after one sample more of `period` s.
pub fn coloured(shift: &mut Shift, random: &mut ChaCha8Rng, period: f64) -> Shift {
    let keep = (-TAU * CORNER * period).exp();
    for shift in shift.iter_mut().flatten() {
        let white: f64 = StandardNormal.sample(random);
        *shift = keep * *shift + COLOURED * (1.0 - keep * keep).sqrt() * white;
    }
    *shift
}

/// A force on the rotor or on its base, per mass, that the controller catches.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kick {
    /// A load that comes at once, and goes at once: up to the rotor's weight.
    Load,
    /// A half sine of 5 ms, up to 2 g.
    Shock,
}

/// Length of a shock, s.
const SHOCK: f64 = 5e-3;
/// From one kick to the next, s.
const EVERY: f64 = 0.5;

/// A rotor held by a loop of second order, at rest at first; twice a second a kick in any direction, or a load's end.
#[derive(Clone, Debug, Default)]
pub struct Held {
    since: f64,
    force: [f64; 2],
    position: [f64; 2],
    velocity: [f64; 2],
}

impl Held {
    /// One sample of `period` s, in which the force is steady: the loop's motion in closed form.
    pub fn next(&mut self, kick: Kick, random: &mut ChaCha8Rng, period: f64) -> Shift {
        self.since += period;
        if self.since >= EVERY {
            self.since = 0.0;
            let most = match kick {
                Kick::Load => G,
                Kick::Shock => 2.0 * G,
            };
            let size = most * random.random_range(0.0..1.0);
            let goes = kick == Kick::Load && self.force != [0.0; 2];
            let new = direction(random).map(|part| size * part);
            self.force = if goes { [0.0; 2] } else { new };
        }
        let now = match kick {
            Kick::Load => 1.0,
            Kick::Shock if self.since < SHOCK => (PI * self.since / SHOCK).sin(),
            Kick::Shock => 0.0,
        };
        let damped = LOOP * (1.0 - DAMPING * DAMPING).sqrt();
        let decay = (-DAMPING * LOOP * period).exp();
        let (sin, cos) = (damped * period).sin_cos();
        for axis in 0..2 {
            // About the place where the force is balanced.
            let middle = now * self.force[axis] / (LOOP * LOOP);
            let (x, v) = (self.position[axis] - middle, self.velocity[axis]);
            let b = (v + DAMPING * LOOP * x) / damped;
            let out = decay * (x * cos + b * sin);
            self.position[axis] = middle + out;
            self.velocity[axis] = -DAMPING * LOOP * out + decay * damped * (b * cos - x * sin);
        }
        [self.position; PLANES]
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use rand_chacha::rand_core::SeedableRng;

    /// Against its own equation, x'' + 2 D w x' + w^2 x = f.
    #[test]
    fn the_loop_is_of_second_order() {
        let mut random = ChaCha8Rng::seed_from_u64(1);
        let mut held = Held::default();
        let period = 1e-5;
        let mut x = Vec::new();
        for _ in 0..60_000 {
            x.push(held.next(Kick::Load, &mut random, period)[0][0]);
        }
        let [before, at, after] = [55_000, 55_001, 55_002].map(|k: usize| x[k]);
        let acceleration = (after - 2.0 * at + before) / (period * period);
        let speed = (after - before) / (2.0 * period);
        let force = acceleration + 2.0 * DAMPING * LOOP * speed + LOOP * LOOP * at;
        assert!((force / held.force[0] - 1.0).abs() < 1e-3, "{force}");
    }
}
