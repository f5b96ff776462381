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

use nalgebra::{Matrix5, RowVector5, Vector2, Vector5};

/// Steps after which a fit that has not settled is given up.
const MOST_STEPS: usize = 40;
/// Newton's, to the nearest point; each doubles the digits.
const FOOT_STEPS: usize = 3;

/// The curve: the zero of each channel, m; the gain of each times the radius, m; the skew, rad.
#[derive(Clone, Copy, Debug)]
pub struct Ellipse(pub [f64; 5]);

/// The point of the curve that is nearest to a reading.
pub struct Foot {
    /// rad.
    pub angle: f64,
    /// Of the reading, outward, m.
    pub distance: f64,
    /// 1/m.
    curvature: f64,
    /// How the curve goes outward with each parameter.
    growth: Vector5<f64>,
}

/// What a fit found.
#[derive(Clone, Debug)]
pub struct Fitted {
    /// The curve.
    pub ellipse: Ellipse,
    /// Covariance of its parameters for noise of 1 m.
    pub cofactor: Matrix5<f64>,
    /// Angle (rad) and residual (m) of each reading.
    pub residuals: Vec<[f64; 2]>,
    /// Mean square of the residuals, m^2.
    pub square: f64,
}

impl Ellipse {
    /// The conic through five points; `None` where that is no ellipse of sensors.
    pub fn through(points: [[f64; 2]; 5]) -> Option<Self> {
        let rows = points.map(|[u, v]| RowVector5::new(u * u - v * v, u * v, u, v, 1.0));
        let right = Vector5::from(points.map(|[u, v]| -u * u - v * v));
        let [t, b, d, e, f] = Matrix5::from_rows(&rows).lu().solve(&right)?.into();
        let (a, c) = (1.0 + t, 1.0 - t);
        let minor = 4.0 * a * c - b * b;
        let [u, v] = [(b * e - 2.0 * c * d) / minor, (b * d - 2.0 * a * e) / minor];
        let level = -(f + 0.5 * (d * u + e * v));
        let sin = 0.5 * b / (a * c).sqrt();
        // No number where it is another conic.
        let [a, b] = [a, c].map(|it| (level / (it * (1.0 - sin * sin))).sqrt());
        Self([u, v, a, b, sin.asin()]).sound()
    }

    /// If it can be one of sensors: finite, of amplitudes like each other, and axes that are not in line.
    fn sound(self) -> Option<Self> {
        let [.., a, b, skew] = self.0;
        let finite = self.0.iter().all(|it| it.is_finite());
        let alike = a > 0.2 * b && b > 0.2 * a && b > 0.0;
        (finite && alike && skew.abs() < 0.5).then_some(self)
    }

    /// The point at an angle, from the zeros, and the way on per rad.
    fn at(&self, angle: f64) -> [Vector2<f64>; 2] {
        let [.., a, b, skew] = self.0;
        let point = Vector2::new(a * angle.cos(), b * (angle - skew).sin());
        let along = Vector2::new(-a * angle.sin(), b * (angle - skew).cos());
        [point, along]
    }

    /// The point at an angle.
    pub fn point(&self, angle: f64) -> [f64; 2] {
        let [point, _] = self.at(angle);
        [self.0[0] + point.x, self.0[1] + point.y]
    }

    /// The nearest point to a reading not far from the curve.
    pub fn foot(&self, reading: [f64; 2]) -> Foot {
        let [zero_u, zero_v, a, b, skew] = self.0;
        let reading = Vector2::from(reading) - Vector2::new(zero_u, zero_v);
        let [u, v] = [reading.x / a, reading.y / b];
        let mut angle = ((v + u * skew.sin()) / skew.cos()).atan2(u);
        for _ in 0..FOOT_STEPS {
            let [point, along] = self.at(angle);
            let way = reading - point;
            // The second derivative of the point is its opposite.
            let slope = along.norm_squared() + way.dot(&point);
            if slope > 0.0 {
                angle += way.dot(&along) / slope;
            }
        }
        let [point, along] = self.at(angle);
        let outward = Vector2::new(along.y, -along.x).normalize();
        let [n, m] = outward.into();
        Foot {
            angle,
            distance: outward.dot(&(reading - point)),
            curvature: outward.dot(&point) / along.norm_squared(),
            growth: Vector5::new(n, m, n * point.x / a, m * point.y / b, -m * along.y),
        }
    }

    /// The most likely curve for these readings of white noise, by Gauss and Newton from this one.
    ///
    /// Noise of variance s^2 across a curve of radius R of curvature puts the mean s^2/(2 R) outside it.
    pub fn fit(mut self, readings: &[[f64; 2]]) -> Option<Fitted> {
        let count = readings.len() as f64;
        let mut variance = 0.0;
        for _ in 0..MOST_STEPS {
            let (mut normal, mut right) = (Matrix5::zeros(), Vector5::zeros());
            let mut residuals = Vec::with_capacity(readings.len());
            for reading in readings {
                let foot = self.foot(*reading);
                let residual = foot.distance - 0.5 * variance * foot.curvature;
                residuals.push([foot.angle, residual]);
                normal += foot.growth * foot.growth.transpose();
                right += residual * foot.growth;
            }
            let cofactor = normal.try_inverse()?;
            let step = cofactor * right;
            let before = variance;
            let squares: f64 = residuals.iter().map(|[_, it]| it * it).sum();
            variance = squares / (count - 5.0).max(1.0);
            self = Self((step + Vector5::from(self.0)).into()).sound()?;
            let least = |k| 1e-4 * (variance * cofactor[(k, k)]).sqrt() + 1e-13;
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
