//! Taylor series of the motion in permanent contact.

use super::scale::Law;
use super::wall::WallState;

/// Order of the series.
pub const ORDER: usize = 24;
/// Size of the last terms, in parts of the quantity: the step follows from it.
const LAST_TERM: f64 = 1e-18;
/// Longest step, in units of the fastest of the motions (about radians).
const LONGEST: f64 = 8.0;

/// Coefficients in rising order.
pub type Coefficients = [f64; ORDER + 1];

/// What friction does.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Grip {
    /// Slip of this sign.
    Slip(f64),
    /// No slip.
    Roll,
}

/// The motion from one moment on, in parts of `span`.
#[derive(Clone, Copy, Debug)]
pub struct Series {
    /// Time that the series is good for.
    pub span: f64,
    /// From the bottom, counter-clockwise.
    pub angle: Coefficients,
    /// Tangential speed.
    pub speed: Coefficients,
    /// Radius times spin.
    pub surface: Coefficients,
    /// Normal force per mass.
    pub normal_acceleration: Coefficients,
    /// Tangential weight per mass.
    pub weight: Coefficients,
}

impl Series {
    /// Expands about a state.
    pub fn new(law: &Law, wall: &WallState, grip: Grip) -> Self {
        let rolling = law.gravity / (1.0 + law.inertia);
        let (pull, spin_up, rub) = match grip {
            Grip::Slip(sign) => (-law.gravity, 0.0, -sign * law.friction),
            Grip::Roll => (-rolling, rolling, 0.0),
        };
        let rate = match wall.speed.abs().max(law.gravity.sqrt()) {
            0.0 => 1.0,
            rate => rate,
        };
        let zero = [0.0; ORDER + 1];
        let (mut angle, mut speed, mut surface) = (zero, zero, zero);
        let (mut sine, mut cosine, mut normal_acceleration) = (zero, zero, zero);
        (angle[0], speed[0], surface[0]) = (wall.angle, wall.speed, wall.surface);
        (sine[0], cosine[0]) = wall.angle.sin_cos();
        for k in 0..=ORDER {
            let (mut square, mut turned_sine, mut turned_cosine) = (0.0, 0.0, 0.0);
            for i in 0..=k {
                let other = speed[k - i];
                square += speed[i] * other;
                turned_sine += cosine[i] * other;
                turned_cosine -= sine[i] * other;
            }
            normal_acceleration[k] = square + law.gravity * cosine[k];
            if k < ORDER {
                let part = 1.0 / (rate * (k + 1) as f64);
                let rubbed = rub * normal_acceleration[k];
                angle[k + 1] = part * speed[k];
                speed[k + 1] = part * (pull * sine[k] + rubbed);
                surface[k + 1] = part * (spin_up * sine[k] + rubbed / law.inertia);
                sine[k + 1] = part * turned_sine;
                cosine[k + 1] = part * turned_cosine;
            }
        }
        let reach = [
            reach(&angle, 1.0),
            reach(&speed, rate),
            reach(&surface, rate.max(wall.surface.abs())),
        ]
        .into_iter()
        .fold(LONGEST, f64::min);
        let mut series = Self {
            span: reach / rate,
            angle,
            speed,
            surface,
            normal_acceleration,
            weight: sine.map(|s| law.gravity * s),
        };
        for coefficients in [
            &mut series.angle,
            &mut series.speed,
            &mut series.surface,
            &mut series.normal_acceleration,
            &mut series.weight,
        ] {
            let mut power = 1.0;
            for c in coefficients {
                *c *= power;
                power *= reach;
            }
        }
        series
    }
}

/// How far a series goes until its last terms matter.
fn reach(coefficients: &Coefficients, size: f64) -> f64 {
    [ORDER - 1, ORDER]
        .map(|k| (LAST_TERM * size / coefficients[k].abs()).powf(1.0 / k as f64))
        .into_iter()
        .fold(f64::INFINITY, f64::min)
}
