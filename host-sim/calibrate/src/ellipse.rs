//! The curve that a plane's two channels show of a rotor on the wall, and its fit by orthogonal distance.
//!
//! On a circle of radius r, at angle p from the first axis, the channels read
//!
//! ```text
//! u = zero_u + g_u r cos p,    v = zero_v + g_v r sin(p - skew)
//! ```
//!
//! Sources: S. J. Ahn, W. Rauh, H.-J. Warnecke, "Least-squares orthogonal distances fitting of circle, sphere,
//! ellipse, hyperbola, and parabola" (2001), for the fit; K. Kanatani, "Ellipse fitting with hyperaccuracy" (2006), for
//! the bias that noise on a curve makes.

use crate::linear::{Matrix, Vector, add, inverse, times};

/// Steps after which a fit that has not settled is given up.
const MOST_STEPS: usize = 40;

/// The curve.
#[derive(Clone, Copy, Debug)]
pub struct Ellipse {
    /// Of its centre, by channel, m.
    pub zero: [f64; 2],
    /// Gain times radius, by channel, m.
    pub amplitude: [f64; 2],
    /// rad.
    pub skew: f64,
}

/// A reading beside the curve.
#[derive(Clone, Copy, Debug)]
pub struct Foot {
    /// Angle of the nearest point, rad.
    pub angle: f64,
    /// Outward, m.
    pub distance: f64,
    /// Unit vector outward.
    normal: [f64; 2],
    /// 1/m.
    curvature: f64,
}

impl Ellipse {
    /// The conic of least algebraic error through five points or more; `None` where that is no ellipse.
    pub fn through(points: &[[f64; 2]]) -> Option<Self> {
        let count = points.len() as f64;
        let mean = [0, 1].map(|k| points.iter().map(|it| it[k]).sum::<f64>() / count);
        let from_mean = |p: &[f64; 2]| [p[0] - mean[0], p[1] - mean[1]];
        let square = points.iter().map(from_mean).map(|[u, v]| u * u + v * v);
        let scale = (square.sum::<f64>() / count).sqrt();
        let (mut normal, mut right) = ([[0.0; 5]; 5], [0.0; 5]);
        for [u, v] in points
            .iter()
            .map(from_mean)
            .map(|it| it.map(|it| it / scale))
        {
            let row = [u * u - v * v, u * v, u, v, 1.0];
            add(&mut normal, &mut right, &row, -u * u - v * v);
        }
        let [t, b, d, e, f] = times(&inverse(normal)?, &right);
        let (a, c) = (1.0 + t, 1.0 - t);
        let minor = 4.0 * a * c - b * b;
        if a <= 0.0 || c <= 0.0 || minor <= 1e-6 {
            return None;
        }
        let zero = [(b * e - 2.0 * c * d) / minor, (b * d - 2.0 * a * e) / minor];
        let level = -(f + 0.5 * (d * zero[0] + e * zero[1]));
        let sin = 0.5 * b / (a * c).sqrt();
        let amplitude = [a, c].map(|it| scale * (level / (it * (1.0 - sin * sin))).sqrt());
        (level > 0.0).then(|| Self {
            zero: [mean[0] + scale * zero[0], mean[1] + scale * zero[1]],
            amplitude,
            skew: sin.asin(),
        })
    }

    /// The point at an angle.
    pub fn point(&self, angle: f64) -> [f64; 2] {
        let [a, b] = self.amplitude;
        [
            self.zero[0] + a * angle.cos(),
            self.zero[1] + b * (angle - self.skew).sin(),
        ]
    }

    /// The nearest point to a reading not far from the curve.
    pub fn foot(&self, [u, v]: [f64; 2]) -> Foot {
        let [a, b] = self.amplitude;
        let (x, w) = ((u - self.zero[0]) / a, (v - self.zero[1]) / b);
        let (sin, cos) = self.skew.sin_cos();
        let mut angle = ((w + x * sin) / cos).atan2(x);
        let mut foot = self.beside(angle, [u, v]);
        // Newton's; each doubles the digits.
        for _ in 0..3 {
            angle += foot.1;
            foot = self.beside(angle, [u, v]);
        }
        foot.0
    }

    /// The same at a given angle, and how far from there the nearest point is, rad.
    fn beside(&self, angle: f64, [u, v]: [f64; 2]) -> (Foot, f64) {
        let [a, b] = self.amplitude;
        let ((sin, cos), (sin_b, cos_b)) = (angle.sin_cos(), (angle - self.skew).sin_cos());
        let [tu, tv] = [-a * sin, b * cos_b];
        let [su, sv] = [-a * cos, -b * sin_b];
        let way = [u - self.zero[0] - a * cos, v - self.zero[1] - b * sin_b];
        let square = tu * tu + tv * tv;
        let length = square.sqrt();
        let normal = [tv / length, -tu / length];
        let along = way[0] * tu + way[1] * tv;
        let slope = square - way[0] * su - way[1] * sv;
        let step = if slope > 0.0 { along / slope } else { 0.0 };
        let foot = Foot {
            angle,
            distance: way[0] * normal[0] + way[1] * normal[1],
            normal,
            curvature: (tu * sv - tv * su) / (square * length),
        };
        (foot, step)
    }

    /// How the curve goes outward at a foot with each parameter: both zeros and amplitudes, and the skew.
    fn growth(&self, foot: &Foot) -> Vector {
        let [n, m] = foot.normal;
        let (sin, cos) = (foot.angle - self.skew).sin_cos();
        let skew = -self.amplitude[1] * cos;
        [n, m, n * foot.angle.cos(), m * sin, m * skew]
    }

    fn moved(&self, by: &Vector) -> Self {
        Self {
            zero: [self.zero[0] + by[0], self.zero[1] + by[1]],
            amplitude: [self.amplitude[0] + by[2], self.amplitude[1] + by[3]],
            skew: self.skew + by[4],
        }
    }

    /// If it can be one of sensors: finite, of amplitudes like each other, and axes that are not in line.
    pub fn sound(self) -> Option<Self> {
        let [a, b] = self.amplitude;
        let all = [self.zero[0], self.zero[1], a, b, self.skew];
        let finite = all.iter().all(|it| it.is_finite());
        let alike = a > 0.2 * b && b > 0.2 * a && b > 0.0;
        (finite && alike && self.skew.abs() < 0.5).then_some(self)
    }

    /// The most likely curve for these readings of white noise, by Gauss and Newton from this one; its covariance for
    /// noise of 1 m, and the residuals.
    ///
    /// Noise of variance s^2 across a curve of radius R of curvature puts the mean s^2/(2 R) outside it.
    pub fn fit(mut self, readings: &[[f64; 2]]) -> Option<Fitted> {
        let mut variance = 0.0;
        for _ in 0..MOST_STEPS {
            let (mut normal, mut right) = ([[0.0; 5]; 5], [0.0; 5]);
            let mut residuals = Vec::with_capacity(readings.len());
            for reading in readings {
                let foot = self.foot(*reading);
                let residual = foot.distance - 0.5 * variance * foot.curvature;
                let growth = self.growth(&foot);
                add(&mut normal, &mut right, &growth, residual);
                residuals.push(residual);
            }
            let free = (readings.len() as f64 - 5.0).max(1.0);
            let before = variance;
            variance = residuals.iter().map(|it| it * it).sum::<f64>() / free;
            let cofactor = inverse(normal)?;
            let step = times(&cofactor, &right);
            self = self.moved(&step).sound()?;
            let settled = (0..5).all(|k| {
                let least = 1e-4 * (variance * cofactor[k][k]).sqrt() + 1e-13;
                step[k].abs() <= least
            });
            if settled && (variance - before).abs() <= 1e-4 * variance {
                return Some(Fitted {
                    ellipse: self,
                    cofactor,
                    residuals,
                });
            }
        }
        None
    }
}

/// What a fit found.
#[derive(Clone, Debug)]
pub struct Fitted {
    /// The curve.
    pub ellipse: Ellipse,
    /// Covariance of its parameters for noise of 1 m.
    pub cofactor: Matrix,
    /// In the order of the readings, m.
    pub residuals: Vec<f64>,
}
