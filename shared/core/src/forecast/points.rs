//! The runs' starts: the estimate, and two to either side of it in each of four uncertain quantities
//! (sigma points). With equal weights they have the estimate's mean and covariance.

use crate::forecast::run::{Fate, Leg, Run};
use crate::forecast::{Estimate, Forecast, Place};
use crate::vector::length;
use touchdown_rotor::Start;
use touchdown_rotor::real::{Poly32, sqrt};

/// Velocity along two axes, friction, restitution.
const QUANTITIES: usize = 4;
/// The middle, and two for each quantity.
pub(crate) const POINTS: usize = 1 + 2 * QUANTITIES;
/// Largest restitution of a run: a series that does not end has no forecast.
const MOST_RESTITUTION: f32 = 0.98;

impl Forecast {
    /// The run of one point; its fate, where that is plain from the start.
    pub(crate) fn begin(&self, estimate: &Estimate, point: usize) -> Result<Run, Fate> {
        // Standard deviations from the mean: sqrt(POINTS/2).
        let far = sqrt(0.5 * POINTS as f32);
        let offset = |quantity: usize| match point.checked_sub(1) {
            Some(index) if index / 2 == quantity => {
                if index % 2 == 0 {
                    far
                } else {
                    -far
                }
            }
            _ => 0.0,
        };
        let known = 1.0 + estimate.clear_impacts;
        let restitution_error = self.tuning.restitution_error / sqrt(known);
        let restitution = estimate.restitution + offset(3) * restitution_error;
        let mut model = self.model;
        model.law.friction *= Poly32((1.0 + offset(2) * self.tuning.friction_error).max(0.0));
        model.law.restitution = Poly32(restitution.clamp(0.0, MOST_RESTITUTION));
        let scales = &self.scales;
        let error = estimate.speed_error / scales.speed;
        let spin = estimate.spin / scales.spin;
        let (start, leg) = match estimate.place {
            Place::Air { position, velocity } => {
                let position = position.map(|x| x / scales.length);
                let [u, v] = velocity.map(|v| v / scales.speed);
                let velocity = [u + offset(0) * error, v + offset(1) * error];
                let start = Start::Free {
                    position: inside(position).map(Poly32),
                    velocity: velocity.map(Poly32),
                };
                (start, Leg::default())
            }
            Place::Wall {
                outward: [sin, minus_cos],
                speed,
                age,
                turned,
            } => (
                Start::Wall {
                    sin: Poly32(sin),
                    cos: Poly32(-minus_cos),
                    tangential: Poly32(speed / scales.speed + offset(0) * error),
                },
                Leg {
                    begun: Some(-age / scales.time),
                    turned,
                },
            ),
        };
        Run::start(model, &start, spin, leg)
    }
}

/// Noise may show a rotor beyond the wall.
fn inside(position: [f32; 2]) -> [f32; 2] {
    let radius = length(position);
    if radius > 1.0 {
        position.map(|it| it / radius)
    } else {
        position
    }
}
