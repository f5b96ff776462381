//! How a rotor floats: at a place, on the orbit of its unbalance.

/// Radius of an unbalance orbit, m.
pub const ORBIT: f64 = 30e-6;
/// Time to learn noise and place from, s; the monitor has to be armed within 0.15 s.
pub const LEAD: f64 = 0.2;
/// Amplitude of the runout, m.
pub const RUNOUT: f64 = 5e-6;

/// A floating rotor; time 0 is the release.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Levitated {
    /// Middle of the orbit, from the bearing's centre, m.
    pub place: [f64; 2],
    /// Of the orbit, m.
    pub radius: f64,
    /// Of the orbit at time 0, rad.
    pub angle: f64,
    /// At time 0, counter-clockwise positive, rad/s.
    pub spin: f64,
    /// Change of the spin a second, as a part of that at time 0.
    pub sweep: f64,
}

impl Levitated {
    /// rad/s.
    pub fn spin(&self, time: f64) -> f64 {
        self.spin * (1.0 + self.sweep * time)
    }

    /// m.
    pub fn position(&self, time: f64) -> [f64; 2] {
        let (sin, cos) = self.turned(time).sin_cos();
        [
            self.place[0] + self.radius * cos,
            self.place[1] + self.radius * sin,
        ]
    }

    /// m/s.
    pub fn velocity(&self, time: f64) -> [f64; 2] {
        let (sin, cos) = self.turned(time).sin_cos();
        let speed = self.radius * self.spin(time);
        [-speed * sin, speed * cos]
    }

    fn turned(&self, time: f64) -> f64 {
        self.angle + self.spin * time * (1.0 + 0.5 * self.sweep * time)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_velocity_is_that_of_the_position() {
        let orbit = Levitated {
            place: [1e-5, -2e-5],
            radius: 3e-5,
            angle: 0.4,
            spin: -300.0,
            sweep: 0.2,
        };
        let step = 1e-6;
        for time in [-0.7, 0.0, 0.3] {
            let (before, after) = (orbit.position(time - step), orbit.position(time + step));
            let velocity = orbit.velocity(time);
            for axis in 0..2 {
                let slope = (after[axis] - before[axis]) / (2.0 * step);
                assert!((slope - velocity[axis]).abs() < 1e-8, "{time}");
            }
        }
    }
}
