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

use crate::linear::{Vector, least_squares};

/// Steps after which a fit that has not settled is given up.
const MOST_STEPS: usize = 40;
/// Newton's, to the nearest point; each doubles the digits.
const FOOT_STEPS: usize = 3;

/// The curve: the zero of each channel, m; the gain of each times the radius, m; the skew, rad.
#[derive(Clone, Copy, Debug)]
pub struct Ellipse(pub Vector);

/// The point of the curve that is nearest to a reading.
pub struct Foot {
    /// rad.
    pub angle: f64,
    /// Of the reading, outward, m.
    pub distance: f64,
    /// 1/m.
    curvature: f64,
    /// How the curve goes outward with each parameter.
    growth: Vector,
}

/// What a fit found.
#[derive(Clone, Debug)]
pub struct Fitted {
    /// The curve.
    pub ellipse: Ellipse,
    /// Covariance of its parameters for noise of 1 m.
    pub cofactor: [Vector; 5],
    /// Angle (rad) and residual (m) of each reading.
    pub residuals: Vec<[f64; 2]>,
    /// Mean square of the residuals, m^2.
    pub square: f64,
}

impl Ellipse {
    /// The conic through five points; `None` where that is no ellipse of sensors.
    pub fn through(points: [[f64; 2]; 5]) -> Option<Self> {
        let mean = [0, 1].map(|k| points.iter().map(|it| it[k]).sum::<f64>() / 5.0);
        let points = points.map(|it| [it[0] - mean[0], it[1] - mean[1]]);
        let square: f64 = points.iter().map(|[u, v]| u * u + v * v).sum();
        let scale = (square / 5.0).sqrt();
        let equations = points.map(|it| {
            let [u, v] = it.map(|it| it / scale);
            ([u * u - v * v, u * v, u, v, 1.0], -u * u - v * v)
        });
        let ([t, b, d, e, f], _) = least_squares(equations)?;
        let (a, c) = (1.0 + t, 1.0 - t);
        let minor = 4.0 * a * c - b * b;
        let [u, v] = [(b * e - 2.0 * c * d) / minor, (b * d - 2.0 * a * e) / minor];
        let level = -(f + 0.5 * (d * u + e * v));
        let sin = 0.5 * b / (a * c).sqrt();
        // No number where it is another conic.
        let [a, b] = [a, c].map(|it| scale * (level / (it * (1.0 - sin * sin))).sqrt());
        Self([mean[0] + scale * u, mean[1] + scale * v, a, b, sin.asin()]).sound()
    }

    /// If it can be one of sensors: finite, of amplitudes like each other, and axes that are not in line.
    fn sound(self) -> Option<Self> {
        let [.., a, b, skew] = self.0;
        let finite = self.0.iter().all(|it| it.is_finite());
        let alike = a > 0.2 * b && b > 0.2 * a && b > 0.0;
        (finite && alike && skew.abs() < 0.5).then_some(self)
    }

    /// The point at an angle.
    pub fn point(&self, angle: f64) -> [f64; 2] {
        let [u, v, a, b, skew] = self.0;
        [u + a * angle.cos(), v + b * (angle - skew).sin()]
    }

    /// The nearest point to a reading not far from the curve.
    pub fn foot(&self, reading: [f64; 2]) -> Foot {
        let [zero_u, zero_v, a, b, skew] = self.0;
        let [u, v] = [reading[0] - zero_u, reading[1] - zero_v];
        let (sin, cos) = skew.sin_cos();
        let mut angle = ((v / b + u / a * sin) / cos).atan2(u / a);
        let mut steps = 0;
        loop {
            let ((sin, cos), (sin_b, cos_b)) = (angle.sin_cos(), (angle - skew).sin_cos());
            let [tu, tv] = [-a * sin, b * cos_b];
            let [su, sv] = [-a * cos, -b * sin_b];
            let way = [u - a * cos, v - b * sin_b];
            let square = tu * tu + tv * tv;
            if steps == FOOT_STEPS {
                let length = square.sqrt();
                let [n, m] = [tv / length, -tu / length];
                return Foot {
                    angle,
                    distance: way[0] * n + way[1] * m,
                    curvature: (tu * sv - tv * su) / (square * length),
                    growth: [n, m, n * cos, m * sin_b, m * (-b * cos_b)],
                };
            }
            let slope = square - way[0] * su - way[1] * sv;
            if slope > 0.0 {
                angle += (way[0] * tu + way[1] * tv) / slope;
            }
            steps += 1;
        }
    }

    /// The most likely curve for these readings of white noise, by Gauss and Newton from this one.
    ///
    /// Noise of variance s^2 across a curve of radius R of curvature puts the mean s^2/(2 R) outside it.
    pub fn fit(mut self, readings: &[[f64; 2]]) -> Option<Fitted> {
        let count = readings.len() as f64;
        let mut variance = 0.0;
        for _ in 0..MOST_STEPS {
            let mut residuals = Vec::with_capacity(readings.len());
            let (step, cofactor) = least_squares(readings.iter().map(|reading| {
                let foot = self.foot(*reading);
                let residual = foot.distance - 0.5 * variance * foot.curvature;
                residuals.push([foot.angle, residual]);
                (foot.growth, residual)
            }))?;
            let before = variance;
            let squares: f64 = residuals.iter().map(|[_, it]| it * it).sum();
            variance = squares / (count - 5.0).max(1.0);
            self.0.iter_mut().zip(step).for_each(|(it, by)| *it += by);
            self = self.sound()?;
            let least = |k: usize| 1e-4 * (variance * cofactor[k][k]).sqrt() + 1e-13;
            let settled = (0..5).all(|k| step[k].abs() <= least(k));
            if settled && (variance - before).abs() <= 1e-4 * variance {
                return Some(Fitted {
                    ellipse: self,
                    cofactor,
                    residuals,
                    square: squares / count,
                });
            }
        }
        None
    }
}
