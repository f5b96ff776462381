//! A commissioning check: zero, gain and skew of the sensors, from readings of a rotor that was led round the retainer.
//! `docs/use/calibrate.md`.

pub mod ellipse;
mod linear;
pub mod page;
pub mod wall;

use serde::Serialize;

use ellipse::{Ellipse, Fitted};
use linear::{dot, times};

/// Standard deviations that hold 95 % of a normal distribution.
const SURE: f64 = 1.96;
/// Least part of the wall that has to be touched, degrees, and the step it is counted by.
pub const LEAST_ARC: f64 = 200.0;
const SECTOR: f64 = 5.0;
/// Samples that make a sector touched.
const TOUCHED: usize = 3;
/// Most 95 % error of zeros, of gains and radius, as a part, and of the skew, rad.
pub const MOST_ERROR: f64 = 0.02;
/// Most residual, rms, as a part of the radius.
pub const MOST_RESIDUAL: f64 = 0.03;
/// Most readings of a plane that are kept.
const KEPT: usize = 1 << 17;
/// Parts of a recording whose means are compared.
const PARTS: usize = 50;

/// Readings of a plane, every second thinned out as often as they are many.
#[derive(Clone, Debug, Default)]
pub struct Readings {
    kept: Vec<[f64; 2]>,
    thinned: u32,
    seen: usize,
}

impl Readings {
    /// Takes the next, m.
    pub fn push(&mut self, reading: [f64; 2]) {
        if self.seen.is_multiple_of(1 << self.thinned) {
            self.kept.push(reading);
        }
        self.seen += 1;
        if self.kept.len() == KEPT {
            self.kept = self.kept.iter().copied().step_by(2).collect();
            self.thinned += 1;
        }
    }

    /// Those that are kept, m.
    pub fn kept(&self) -> &[[f64; 2]] {
        &self.kept
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
    /// Why it must not be used.
    pub refused: Option<String>,
    /// The curve.
    #[serde(skip)]
    pub ellipse: Ellipse,
    /// Angle (rad) and residual (m) of each reading on the wall.
    #[serde(skip)]
    pub residuals: Vec<[f64; 2]>,
}

/// A plane of a recording.
#[derive(Clone, Debug)]
pub struct Checked {
    /// a or b.
    pub name: &'static str,
    /// What was found, or why nothing was.
    pub plane: Result<Plane, String>,
    /// What it was found in.
    pub readings: Readings,
}

impl Checked {
    /// Why the plane's values must not be used.
    pub fn refused(&self) -> Option<&String> {
        match &self.plane {
            Ok(plane) => plane.refused.as_ref(),
            Err(why) => Some(why),
        }
    }
}

/// Finds zero, gain and skew of a plane whose converter has this resolution, m; why that cannot be. An ellipse alone does
/// not tell gain from radius: the radial `clearance`, m, is believed, or without it the gain of the first channel.
pub fn plane(
    readings: &[[f64; 2]],
    resolution: f64,
    clearance: Option<f64>,
) -> Result<Plane, String> {
    let (on_wall, fitted) = wall::find(readings, resolution)?;
    let Fitted {
        ellipse,
        cofactor,
        residuals,
    } = fitted;
    let square = mean(residuals.iter().map(|it| it * it));
    let correlation = correlation(&residuals, square);
    let [a, b] = ellipse.amplitude;
    let value = |value: f64, by: [f64; 5]| {
        let variance = square * correlation * dot(&by, &times(&cofactor, &by));
        let error = SURE * variance.sqrt();
        Value { value, error }
    };
    let given = |value| Value { value, error: 0.0 };
    let ratio = value(b / a, [0.0, 0.0, -b / (a * a), 1.0 / a, 0.0]);
    let (gain, radius) = match clearance {
        Some(r) => {
            let first = value(a / r, [0.0, 0.0, 1.0 / r, 0.0, 0.0]);
            let second = value(b / r, [0.0, 0.0, 0.0, 1.0 / r, 0.0]);
            ([first, second], given(r))
        }
        None => {
            let radius = value(a, [0.0, 0.0, 1.0, 0.0, 0.0]);
            ([given(1.0), ratio], radius)
        }
    };
    let angles = on_wall.iter().map(|&it| ellipse.foot(readings[it]).angle);
    let residuals: Vec<_> = angles
        .zip(&residuals)
        .map(|(angle, it)| [angle, *it])
        .collect();
    let mut found = Plane {
        zero_m: [
            value(ellipse.zero[0], [1.0, 0.0, 0.0, 0.0, 0.0]),
            value(ellipse.zero[1], [0.0, 1.0, 0.0, 0.0, 0.0]),
        ],
        gain,
        gain_ratio: ratio,
        skew_rad: value(ellipse.skew, [0.0, 0.0, 0.0, 0.0, 1.0]),
        radius_m: radius,
        residual_m: square.sqrt(),
        correlation,
        arc_deg: arc(&residuals),
        on_wall: on_wall.len(),
        samples: readings.len(),
        refused: None,
        ellipse,
        residuals,
    };
    found.refused = found.why_not();
    Ok(found)
}

impl Plane {
    fn why_not(&self) -> Option<String> {
        let [a, b] = self.ellipse.amplitude;
        let amplitude = 0.5 * (a + b);
        let (arc, residual) = (self.arc_deg, self.residual_m);
        let percent = |part: f64| 100.0 * part;
        let errors = [
            ("zero", self.zero_m[0].error / amplitude),
            ("zero", self.zero_m[1].error / amplitude),
            ("gain", self.gain[0].error / self.gain[0].value),
            ("gain", self.gain[1].error / self.gain[1].value),
            ("radius", self.radius_m.error / self.radius_m.value),
            ("skew", self.skew_rad.error),
        ];
        let largest = errors.iter().find(|(_, error)| *error > MOST_ERROR);
        if arc < LEAST_ARC {
            return Some(format!(
                "{arc:.0} degrees of the wall were touched, {LEAST_ARC} are the fewest: lead the rotor further round"
            ));
        }
        if residual > MOST_RESIDUAL * amplitude {
            return Some(format!(
                "the residual is {:.2} um, {:.1} % of the radius, {} % is the most: the readings are no ellipse",
                1e6 * residual,
                percent(residual / amplitude),
                percent(MOST_RESIDUAL)
            ));
        }
        let (name, error) = largest?;
        Some(format!(
            "the 95 % error of the {name} is {:.1} %, {} % is the most: lead the rotor round for longer",
            percent(*error),
            percent(MOST_ERROR)
        ))
    }
}

/// Variance of the means of parts of the recording over what independent residuals (mean square given) make; 1 at least.
fn correlation(residuals: &[f64], square: f64) -> f64 {
    let length = residuals.len() / PARTS;
    if length < 2 || square == 0.0 {
        return 1.0;
    }
    let parts = residuals
        .chunks_exact(length)
        .map(|it| mean(it.iter().copied()));
    let squares = mean(parts.map(|it| it * it));
    (squares * length as f64 / square).max(1.0)
}

fn mean(values: impl Iterator<Item = f64>) -> f64 {
    let (sum, count) = values.fold((0.0, 0), |(sum, count), it| (sum + it, count + 1));
    sum / f64::from(count.max(1))
}

/// Of the wall, degrees.
fn arc(residuals: &[[f64; 2]]) -> f64 {
    let mut sectors = [0; (360.0 / SECTOR) as usize];
    let count = sectors.len();
    for [angle, _] in residuals {
        let turn = angle.rem_euclid(std::f64::consts::TAU) / std::f64::consts::TAU;
        sectors[((turn * count as f64) as usize).min(count - 1)] += 1;
    }
    SECTOR * sectors.iter().filter(|it| **it >= TOUCHED).count() as f64
}
