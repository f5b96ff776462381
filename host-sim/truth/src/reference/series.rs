//! Taylor series of the motion in permanent contact.

use super::jet::Jet;
use super::scale::Law;
use super::wall::WallState;

/// Order of the series.
const ORDER: usize = 24;
/// Size of the last terms, in parts of the quantity: the step follows from it.
const LAST_TERM: f64 = 1e-18;
/// Longest step, in units of the fastest of the motions (about radians).
const LONGEST: f64 = 8.0;

/// Of a quantity.
pub type Terms = Jet<{ ORDER + 1 }>;

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
    pub angle: Terms,
    /// Tangential speed.
    pub speed: Terms,
    /// Radius times spin.
    pub surface: Terms,
    /// Normal force per mass.
    pub normal_acceleration: Terms,
    /// Tangential weight per mass.
    pub weight: Terms,
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
        let start = |value| Terms::constant(value).0;
        let (mut angle, mut speed, mut surface) =
            (start(wall.angle), start(wall.speed), start(wall.surface));
        let (sine, cosine) = wall.angle.sin_cos();
        let (mut sine, mut cosine) = (start(sine), start(cosine));
        let mut normal_acceleration = start(0.0);
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
        let [angle, speed, surface] = [angle, speed, surface].map(Jet);
        let sizes = [1.0, rate, rate.max(wall.surface.abs())];
        let reach = [angle, speed, surface].into_iter().zip(sizes);
        let reach = reach.map(|(terms, size)| terms.reach(LAST_TERM * size));
        let reach = reach.fold(LONGEST, f64::min);
        let scaled = |terms: Terms| terms.scaled(reach);
        Self {
            span: reach / rate,
            angle: scaled(angle),
            speed: scaled(speed),
            surface: scaled(surface),
            normal_acceleration: scaled(Jet(normal_acceleration)),
            weight: scaled(Jet(sine) * law.gravity),
        }
    }
}
