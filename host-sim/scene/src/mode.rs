//! `[[mode]]`: the bending modes of the free rotor.

use serde::Deserialize;

use super::diagnostic::Diagnostic;
use super::rule::{Keys, MILLI};

/// Most modes.
pub const MODES: usize = 3;
/// k L of the free-free modes of a uniform beam: roots of cos x cosh x = 1.
const FREE_FREE: [f64; MODES] = [
    4.730_040_744_862_704,
    7.853_204_624_095_838,
    10.995_607_838_001_671,
];

/// A bending mode of the free rotor.
#[derive(Clone, Debug, PartialEq)]
pub struct Mode {
    /// rad/s.
    pub speed: f64,
    /// Of critical damping, in the frame that does not turn.
    pub damping_ratio: f64,
    /// kg.
    pub mass: f64,
    /// How the axis is bent.
    pub shape: Shape,
}

/// Displacement of the axis in a mode.
#[derive(Clone, Debug, PartialEq)]
pub enum Shape {
    /// Linear between (m from the centre of mass, displacement), constant beyond.
    Points(Vec<[f64; 2]>),
    /// That of a uniform beam about its middle: k L, and its length, m.
    Beam([f64; 2]),
}

impl Mode {
    /// Displacement at a place, m from the centre of mass.
    pub fn at(&self, place: f64) -> f64 {
        match &self.shape {
            Shape::Points(points) => linear(points, place),
            Shape::Beam([root, length]) => beam(*root, (place / length + 0.5).clamp(0.0, 1.0)),
        }
    }
}

fn linear(points: &[[f64; 2]], place: f64) -> f64 {
    let after = points.iter().position(|[at, _]| *at >= place);
    match after {
        Some(0) => points[0][1],
        Some(k) => {
            let ([from, low], [to, high]) = (points[k - 1], points[k]);
            low + (high - low) * (place - from) / (to - from)
        }
        None => points.last().map_or(0.0, |[_, value]| *value),
    }
}

/// Free-free mode at the part `x` of the length: its mean square is 1, so its mass is the beam's.
fn beam(root: f64, x: f64) -> f64 {
    let ratio = (root.cosh() - root.cos()) / (root.sinh() - root.sin());
    let at = root * x;
    at.cosh() + at.cos() - ratio * (at.sinh() + at.sin())
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct ModeTable {
    frequency_hz: f64,
    #[serde(default)]
    damping_ratio: f64,
    modal_mass_kg: Option<f64>,
    shape: Option<Vec<f64>>,
    at_mm: Option<Vec<f64>>,
    #[serde(default)]
    beam: bool,
}

const KEYS: Keys = Keys("mode");

/// All of them; `length` of the rotor, mm.
pub(super) fn all_modes(
    tables: &[ModeTable],
    mass: f64,
    length: Option<f64>,
) -> Result<Vec<Mode>, Diagnostic> {
    let check = |row, table: &ModeTable| table.check(row, mass, length);
    KEYS.rows("frequency_hz", tables, MODES, check)
}

impl ModeTable {
    fn check(&self, row: usize, mass: f64, length: Option<f64>) -> Result<Mode, Diagnostic> {
        Ok(Mode {
            speed: std::f64::consts::TAU * self.frequency_hz,
            damping_ratio: self.damping_ratio,
            mass: self.modal_mass_kg.unwrap_or(mass),
            shape: self.shape(row, length)?,
        })
    }

    fn shape(&self, row: usize, length: Option<f64>) -> Result<Shape, Diagnostic> {
        let broken = |key, rule: &str| Err(KEYS.broken(key, rule));
        match (&self.shape, &self.at_mm, self.beam) {
            (None, None, true) => match length {
                Some(length) => Ok(Shape::Beam([FREE_FREE[row], MILLI * length])),
                None => broken("beam", "beam = true needs rotor_length_mm in [two_plane]"),
            },
            (Some(shape), Some(places), false) => {
                if shape.len() != places.len() || shape.is_empty() {
                    let rule = "shape and at_mm must have the same length, 1 or more";
                    return broken("shape", rule);
                }
                if places.windows(2).any(|pair| pair[0] >= pair[1]) {
                    return broken("at_mm", "at_mm must rise from number to number");
                }
                let points = places.iter().zip(shape);
                let points = points.map(|(place, value)| [MILLI * place, *value]);
                Ok(Shape::Points(points.collect()))
            }
            _ => broken(
                "frequency_hz",
                "a mode needs shape and at_mm, or beam = true",
            ),
        }
    }
}
