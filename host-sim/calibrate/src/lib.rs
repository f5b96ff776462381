//! A commissioning check: zero, gain and skew of the sensors, from readings of a rotor that was led round the retainer.
//! `docs/use/calibrate.md`.

pub mod ellipse;
pub mod page;
mod wall;

use nalgebra::Vector5;
use serde::Serialize;

use ellipse::Fitted;

/// Standard deviations that hold 95 % of a normal distribution.
const SURE: f64 = 1.96;
/// Least part of the wall that has to be touched, degrees, and the step it is counted by.
const LEAST_ARC: f64 = 200.0;
const SECTOR: f64 = 5.0;
/// Samples that make a sector touched.
const TOUCHED: usize = 3;
/// Most 95 % error: of zeros, % of the radius; of gains and radius, %; of the skew, 0.01 rad.
const MOST_ERROR: f64 = 2.0;
/// Most residual, rms, % of the radius.
const MOST_RESIDUAL: f64 = 3.0;
/// Most readings of a plane that are kept.
const KEPT: usize = 1 << 17;
/// Parts of a recording whose means are compared.
const PARTS: usize = 50;

/// Readings of a plane, every second thinned out as often as they are many.
#[derive(Clone, Debug, Default)]
pub struct Readings {
    /// Those that are kept, m.
    pub kept: Vec<[f64; 2]>,
    seen: usize,
}

impl Readings {
    /// Takes the next, m.
    pub fn push(&mut self, reading: [f64; 2]) {
        let every = (self.seen / KEPT + 1).next_power_of_two();
        if self.seen.is_multiple_of(every) {
            self.kept.push(reading);
        }
        self.seen += 1;
        if self.kept.len() == KEPT {
            self.kept = self.kept.iter().copied().step_by(2).collect();
        }
    }
}

/// A number with its 95 % error; SI.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Value {
    /// As it was found.
    pub value: f64,
    /// 0 where it was given.
    pub error: f64,
}

/// What was found of a plane.
#[derive(Clone, Debug, Serialize)]
pub struct Plane {
    /// Readings of each channel at the retainer's centre, m.
    pub zero_m: [Value; 2],
    /// Reading over displacement of each channel.
    pub gain: [Value; 2],
    /// Of the second channel over the first; needs no scale.
    pub gain_ratio: Value,
    /// rad.
    pub skew_rad: Value,
    /// Radial clearance, m.
    pub radius_m: Value,
    /// Distance of the readings from the curve, rms, m.
    pub residual_m: f64,
    /// Variance of the residual's means over that of independent ones; errors contain its root.
    pub correlation: f64,
    /// Part of the wall that was touched, degrees.
    pub arc_deg: f64,
    /// Samples of which the plane was on the wall.
    pub on_wall: usize,
    /// Samples used.
    pub samples: usize,
    /// The curve through the readings on the wall.
    #[serde(skip)]
    pub fitted: Fitted,
}

/// A plane of a recording.
#[derive(Clone, Debug, Serialize)]
pub struct Checked {
    /// a or b.
    #[serde(skip)]
    pub name: &'static str,
    /// What was found, if anything was.
    #[serde(flatten)]
    pub plane: Option<Plane>,
    /// Why it must not be used.
    pub refused: Option<String>,
    /// What it was found in.
    #[serde(skip)]
    pub readings: Readings,
}

/// Finds zero, gain and skew of a plane whose converter has this resolution, m; why that cannot be. An ellipse alone does
/// not tell gain from radius: the radial `clearance`, m, is believed, or without it the gain of the first channel.
pub fn plane(
    readings: &[[f64; 2]],
    resolution: f64,
    clearance: Option<f64>,
) -> Result<Plane, String> {
    let fitted = wall::find(readings, resolution)?;
    let correlation = correlation(&fitted.residuals, fitted.square);
    let covariance = fitted.square * correlation * fitted.cofactor;
    let value = |value: f64, variance: f64| Value {
        value,
        error: SURE * variance.sqrt(),
    };
    let given = |it| value(it, 0.0);
    let over = |number: usize, unit: f64| {
        let variance = covariance[(number, number)];
        value(fitted.ellipse.0[number] / unit, variance / (unit * unit))
    };
    let [_, _, a, b, _] = fitted.ellipse.0;
    let growth = Vector5::new(0.0, 0.0, -b / a, 1.0, 0.0) / a;
    let gain_ratio = value(b / a, growth.dot(&(covariance * growth)));
    let (gain, radius_m) = match clearance {
        Some(r) => ([over(2, r), over(3, r)], given(r)),
        None => ([given(1.0), gain_ratio], over(2, 1.0)),
    };
    Ok(Plane {
        zero_m: [over(0, 1.0), over(1, 1.0)],
        gain,
        gain_ratio,
        skew_rad: over(4, 1.0),
        radius_m,
        residual_m: fitted.square.sqrt(),
        correlation,
        arc_deg: arc(&fitted.residuals),
        on_wall: fitted.residuals.len(),
        samples: readings.len(),
        fitted,
    })
}

impl Plane {
    /// Why it must not be used, if so.
    pub fn why_not(&self) -> Option<String> {
        let [_, _, a, b, _] = self.fitted.ellipse.0;
        let of_radius = |it: f64| 100.0 * (it / (0.5 * (a + b)));
        let of_itself = |it: Value| 100.0 * (it.error / it.value);
        let errors = [
            ("zero", of_radius(self.zero_m[0].error)),
            ("zero", of_radius(self.zero_m[1].error)),
            ("gain", of_itself(self.gain[0])),
            ("gain", of_itself(self.gain[1])),
            ("radius", of_itself(self.radius_m)),
            ("skew", 100.0 * self.skew_rad.error),
        ];
        let (arc, residual) = (self.arc_deg, of_radius(self.residual_m));
        Some(if arc < LEAST_ARC {
            format!(
                "{arc:.0} degrees of the wall were touched, {LEAST_ARC} are the fewest: lead the rotor further round"
            )
        } else if residual > MOST_RESIDUAL {
            let um = 1e6 * self.residual_m;
            format!(
                "the residual is {um:.2} um, {residual:.1} % of the radius, {MOST_RESIDUAL} % is the most: the readings are no ellipse"
            )
        } else {
            let (name, error) = errors.into_iter().find(|it| it.1 > MOST_ERROR)?;
            format!(
                "the 95 % error of the {name} is {error:.1} %, {MOST_ERROR} % is the most: lead the rotor round for longer"
            )
        })
    }
}

/// Variance of means of parts, fewer than the residuals, over what independent residuals (mean square given) make; 1 at least.
fn correlation(residuals: &[[f64; 2]], square: f64) -> f64 {
    let length = residuals.len() / PARTS;
    let parts = residuals.chunks_exact(length);
    let independent = square * (parts.len() * length) as f64;
    let sums = parts.map(|it| it.iter().map(|[_, it]| it).sum::<f64>());
    (sums.map(|it| it * it).sum::<f64>() / independent).max(1.0)
}

/// Of the wall, degrees.
fn arc(residuals: &[[f64; 2]]) -> f64 {
    let mut sectors = [0; (360.0 / SECTOR) as usize];
    for [angle, _] in residuals {
        let sector = angle.to_degrees().rem_euclid(360.0) / SECTOR;
        sectors[sector as usize % sectors.len()] += 1;
    }
    SECTOR * sectors.iter().filter(|it| **it >= TOUCHED).count() as f64
}
