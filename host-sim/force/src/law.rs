//! The pulse of a mass on a spring, in the spring's own units: d'' = -d^p (1 + a d') from d = 0 at speed 1.
//!
//! p is 1.5 where the bodies touch in a point and 1 along a line; a is the damping that gives a
//! restitution. With a below 0 it is the pulse of -a backwards in time: a wall that yields pushes late.

/// Steps up to the elastic pulse's peak, about.
const STEPS: f64 = 60.0;
/// Points that are handed out.
const POINTS: usize = 64;
/// Steps at most; most damping keeps the mass at the wall for less.
const MOST_STEPS: usize = 1000;
/// Greatest damping: a restitution of 0.2.
pub const DAMPING: f64 = 4.0;
/// Of a line and of a point.
pub const EXPONENTS: [f64; 2] = [1.0, 1.5];

/// A pulse whose greatest force is 1, at time 0, and whose width at half of it is 1.
#[derive(Clone, Debug)]
pub struct Law {
    /// Force at equal steps, from touch to release.
    pub force: Vec<f64>,
    /// Of the touch, below 0.
    pub start: f64,
    /// From touch to release.
    pub duration: f64,
}

impl Law {
    /// Out of range, the nearest in range.
    pub fn new(exponent: f64, damping: f64) -> Self {
        let p = exponent.clamp(EXPONENTS[0], EXPONENTS[1]);
        let a = damping.abs().min(DAMPING);
        let deepest = (0.5 * (p + 1.0)).powf(1.0 / (p + 1.0));
        let step = 1.5 * deepest / STEPS;
        let force = |d: f64, v: f64| d.max(0.0).powf(p) * (1.0 + a * v);
        let slope = |d: f64, v: f64| (v, -force(d, v));
        let (mut d, mut v) = (0.0, 1.0);
        let mut forces = vec![0.0];
        let mut release = 0.0;
        for _ in 0..MOST_STEPS {
            let k1 = slope(d, v);
            let k2 = slope(d + 0.5 * step * k1.0, v + 0.5 * step * k1.1);
            let k3 = slope(d + 0.5 * step * k2.0, v + 0.5 * step * k2.1);
            let k4 = slope(d + step * k3.0, v + step * k3.1);
            let next = d + step / 6.0 * (k1.0 + 2.0 * (k2.0 + k3.0) + k4.0);
            if next <= 0.0 {
                release = d / (d - next);
                break;
            }
            v += step / 6.0 * (k1.1 + 2.0 * (k2.1 + k3.1) + k4.1);
            d = next;
            forces.push(force(d, v));
        }
        Self::of(&forces, release, damping < 0.0)
    }

    /// From forces at steps of 1 and the part of a step from the last to the release.
    fn of(forces: &[f64], release: f64, backwards: bool) -> Self {
        let length = (forces.len() - 1) as f64 + release;
        let at = |time: f64| {
            let k = time.floor() as usize;
            let part = time - time.floor();
            let now = forces.get(k).copied().unwrap_or(0.0);
            let next = forces.get(k + 1).copied().unwrap_or(0.0);
            now + part * (next - now)
        };
        let top = highest(forces);
        // The parabola through the greatest and its neighbours.
        let (before, after) = (at(top.saturating_sub(1) as f64), at((top + 1) as f64));
        let (tilt, bend) = (0.5 * (after - before), 2.0 * forces[top] - before - after);
        let peak_time = top as f64 + tilt / bend;
        let peak = forces[top] + 0.5 * tilt * tilt / bend;
        let half = 0.5 * peak;
        let crossing = |k: usize| {
            let (low, high) = (at(k as f64), at((k + 1) as f64));
            k as f64 + (half - low) / (high - low)
        };
        let rise = (0..top).rev().find(|&k| forces[k] < half).unwrap_or(0);
        let fall = (top..forces.len()).find(|&k| at((k + 1) as f64) < half);
        let fall = fall.unwrap_or(top);
        let width = crossing(fall) - crossing(rise);
        let time = |k: usize| (k as f64 + 0.5) / POINTS as f64 * length;
        let mut force: Vec<f64> = (0..POINTS).map(|k| at(time(k)) / peak).collect();
        let mut start = -peak_time;
        if backwards {
            force.reverse();
            start = peak_time - length;
        }
        Self {
            force,
            start: start / width,
            duration: length / width,
        }
    }

    /// Middles of the steps and their force.
    pub fn points(&self) -> impl Iterator<Item = (f64, f64)> + '_ {
        let part = self.duration / self.force.len() as f64;
        let time = move |k: usize| self.start + (k as f64 + 0.5) * part;
        let forces = self.force.iter().enumerate();
        forces.map(move |(k, force)| (time(k), *force))
    }
}

/// Index of the greatest, of several of them the last.
pub fn highest(force: &[f64]) -> usize {
    let by_force = |a: &usize, b: &usize| force[*a].total_cmp(&force[*b]);
    (0..force.len()).max_by(by_force).unwrap_or(0)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// p = 1, a = 0: half a sine, whose width at half is 2/3 of it.
    #[test]
    fn a_spring_gives_half_a_sine() {
        let law = Law::new(1.0, 0.0);
        assert!((law.duration - 1.5).abs() < 2e-3, "{}", law.duration);
        assert!((law.start + 0.75).abs() < 2e-3, "{}", law.start);
        for (time, force) in law.points() {
            let right = (std::f64::consts::PI * (time - law.start) / law.duration).sin();
            assert!((force - right).abs() < 2e-3, "{time}: {force} {right}");
        }
    }

    #[test]
    fn damping_below_zero_is_backwards() {
        let (on, back) = (Law::new(1.5, 0.7), Law::new(1.5, -0.7));
        assert!((on.duration - back.duration).abs() < 1e-12);
        assert!((on.start + on.duration + back.start).abs() < 1e-12);
        let pairs = on.force.iter().zip(back.force.iter().rev());
        assert!(pairs.into_iter().all(|(a, b)| a == b));
    }
}
