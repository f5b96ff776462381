//! What makes one doubt that a recording is what it is taken for: units, sign, range.

use crate::stream::Row;
use touchdown_base::plain::Number;
use touchdown_scene::Scene;

/// Farthest that a rotor gets from the centre, in clearances; a support gives way.
const FARTHEST: f64 = 3.0;
/// Less than this over a whole recording is less than any noise, in clearances.
const NEAREST: f64 = 2e-3;
/// Least part of the samples beyond the sensors' range that is told.
const SATURATED: f64 = 1e-3;
/// Units that are taken for one another, with the factor between them.
const UNITS: [(&str, f64); 6] = [
    ("mm taken for um", 1e-3),
    ("um taken for mm", 1e3),
    ("mil taken for um", 1.0 / 25.4),
    ("um taken for mil", 25.4),
    ("mm taken for mil", 25.4e-3),
    ("mil taken for mm", 1.0 / 25.4e-3),
];
const SPEEDS: [(&str, f64); 4] = [
    ("Hz taken for rpm", 1.0 / 60.0),
    ("rpm taken for Hz", 60.0),
    ("rad/s taken for rpm", std::f64::consts::TAU / 60.0),
    ("rpm taken for rad/s", 60.0 / std::f64::consts::TAU),
];
/// How near a speed must be to that of the scene to be taken for it in another unit.
const NEAR: f64 = 0.1;

/// Largest values so far.
#[derive(Clone, Debug, Default)]
pub struct Doubt {
    clearance: f64,
    spin: f64,
    /// Of the sensors, m.
    range: f64,
    two_planes: bool,
    samples: u64,
    seen: bool,
    farthest: f64,
    saturated: u64,
    fastest: f64,
    plane_b: bool,
}

impl Doubt {
    /// Before the first row.
    pub fn new(scene: &Scene) -> Self {
        Self {
            clearance: scene.retainer.clearance,
            spin: scene.rotor.spin,
            range: scene.sensors.range,
            two_planes: scene.sensors.planes == 2,
            ..Self::default()
        }
    }

    /// Takes the next row.
    pub fn take(&mut self, row: &Row) {
        self.samples += 1;
        let mut beyond = false;
        for plane in row.positions.as_chunks::<2>().0 {
            let distance = f64::hypot(plane[0], plane[1]);
            // Not so where one is missing.
            if distance > self.farthest {
                self.farthest = distance;
            }
            self.seen |= !distance.is_nan();
            beyond |= plane.iter().any(|it| it.abs() > self.range);
        }
        self.saturated += u64::from(beyond);
        self.plane_b |= !row.positions[2].is_nan();
        let spin = row.spin.unwrap_or(0.0);
        if spin.abs() > self.fastest.abs() {
            self.fastest = spin;
        }
    }

    /// What is doubtful about the rows so far.
    pub fn warnings(&self) -> Vec<String> {
        let mut warnings = Vec::new();
        let ratio = self.farthest / self.clearance;
        if self.samples > 0 && !self.seen {
            warnings.push("not one sample has a position: are these the right columns?".to_owned());
        } else if self.samples > 0 && !(NEAREST..=FARTHEST).contains(&ratio) {
            let would = |it: &&(&str, f64)| (0.2..=1.5).contains(&(ratio / it.1));
            let units = UNITS.iter().find(would);
            let units = units.map_or(String::new(), |(name, _)| format!(" ({name}?)"));
            let (most, clearance) = (Number(self.farthest * 1e6), self.clearance * 1e6);
            warnings.push(format!(
                "the rotor is at most {most:.4} um from the centre, {ratio:.3e} of the clearance of {clearance} um: \
                 are unit and offset right?{units}"
            ));
        }
        let (saturated, samples) = (self.saturated, self.samples);
        if saturated as f64 > SATURATED * samples as f64 {
            let range = format!("beyond the sensors' range of {} um", self.range * 1e6);
            let rule =
                format!("{saturated} of {samples} samples are {range} and are cut off there");
            warnings.push(rule);
        }
        if self.fastest * self.spin < 0.0 {
            let rpm = |spin: f64| spin * 60.0 / std::f64::consts::TAU;
            let (found, told) = (Number(rpm(self.fastest)), rpm(self.spin));
            warnings.push(format!(
                "the speed is {found:.6} rpm, that of the scene {told:.6} rpm: is its sign right?"
            ));
        }
        let ratio = (self.fastest / self.spin).abs();
        let near = |it: &&(&str, f64)| (ratio / it.1 - 1.0).abs() < NEAR;
        if let Some((name, _)) = SPEEDS.iter().find(near) {
            warnings.push(format!("the speed is {ratio:.4} of the scene's: {name}?"));
        }
        if self.two_planes && self.seen && !self.plane_b {
            let rule =
                "it has plane a alone, the scene two planes: falls and impacts are found later";
            warnings.push(rule.to_owned());
        }
        warnings
    }
}
