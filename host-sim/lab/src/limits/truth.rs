//! What the independent reference says of a scene, and how much of it a precision can know.
//!
//! A path multiplies the rounding of what it starts from. By how much is found with the reference
//! itself: each number of the scene is changed by a little, one after the other.

use super::extreme::{free, wall};
use touchdown_base::history::History;
use touchdown_base::machine::Start;
use touchdown_scene::{Precision, Scene};
use touchdown_truth::{Units, simulate};

/// Impacts of the first series that are compared.
const COMPARED: usize = 40;
/// Weaker impacts, in units of V, are not: in f32 the series ends there.
const WEAKEST: f64 = 1e-5;
/// Relative change of a number of the scene.
const CHANGE: f64 = 1e-9;
/// Largest part of rho0, T and V that rounding may have grown to where impacts are still compared.
const LOST: f64 = 1e-2;

/// The truth of a scene.
pub struct Truth {
    /// As it went.
    pub history: History,
    /// Growth of a relative change up to each of the impacts that are compared.
    growth: Vec<f64>,
    /// The same up to the first permanent contact.
    contact_growth: f64,
    units: Units,
    /// rad/s.
    spin_unit: f64,
}

impl Truth {
    /// Follows `scene`.
    pub fn of(scene: &Scene) -> Self {
        let history = simulate(scene);
        let units = Units::of(scene);
        let surface = (scene.rotor.radius * scene.rotor.spin).abs();
        let mut truth = Self {
            growth: Vec::new(),
            contact_growth: 1.0,
            units,
            spin_unit: surface.max(units.speed) / scene.rotor.radius,
            history,
        };
        // What has no losses never comes to rest on the wall; the reference takes its last hops for it.
        if scene.retainer.restitution == 1.0 {
            truth.history.contact_starts.clear();
        }
        let first_contact = truth.history.contact_starts.first().copied();
        let series = truth
            .history
            .impacts
            .iter()
            .take(COMPARED)
            .take_while(|impact| {
                first_contact.is_none_or(|start| impact.state.time <= start)
                    && impact.normal_speed >= WEAKEST * units.speed
            });
        truth.growth = vec![1.0; series.count()];
        for changed in changed(scene) {
            let other = simulate(&changed);
            for k in 0..truth.growth.len() {
                let error = truth.distance(k, &other).unwrap_or(1.0);
                truth.growth[k] = truth.growth[k].max(error / CHANGE);
            }
            if let (Some(a), Some(b)) = (first_contact, other.contact_starts.first()) {
                let error = (a - b).abs() / units.time;
                truth.contact_growth = truth.contact_growth.max(error / CHANGE);
            }
        }
        truth
    }

    /// Largest error of the impacts, each in parts of its target, 1e-14 + 20 A epsilon in f64 and
    /// 5e-6 + 50 A epsilon/2 in f32; and the number of impacts compared.
    pub fn impact_error(&self, found: &History, precision: Precision) -> (f64, usize) {
        let mut worst = 0.0_f64;
        let mut compared = 0;
        for (k, &growth) in self.growth.iter().enumerate() {
            let (target, lost) = match precision {
                Precision::F64 => (1e-14 + 20.0 * growth * 2.2e-16, growth * 1.1e-16),
                Precision::F32 => (5e-6 + 50.0 * growth * 6e-8, growth * 6e-8),
            };
            if lost > LOST {
                break;
            }
            let error = self.distance(k, found).unwrap_or(f64::INFINITY);
            worst = worst.max(error / target);
            compared += 1;
        }
        (worst, compared)
    }

    /// Error of the first permanent contact, T, and its target; `None` where there is none to compare.
    pub fn contact_error(&self, found: &History, precision: Precision) -> Option<(f64, f64)> {
        let start = self.history.contact_starts.first()?;
        let (target, epsilon) = match precision {
            Precision::F64 => (1e-11, 2.2e-16),
            Precision::F32 => (1e-5, 1.2e-7),
        };
        if self.contact_growth * epsilon > LOST {
            return None;
        }
        let error = found.contact_starts.first().map_or(f64::INFINITY, |found| {
            (found - start).abs() / self.units.time
        });
        Some((error, target + 20.0 * self.contact_growth * epsilon))
    }

    /// Of the impacts of this number, where both have it: the largest of the differences in time (T), position (rho0),
    /// velocity, speed into the wall (V) and spin (of itself or V).
    fn distance(&self, number: usize, other: &History) -> Option<f64> {
        let (a, b) = (
            self.history.impacts.get(number)?,
            other.impacts.get(number)?,
        );
        let apart = |a: [f64; 2], b: [f64; 2]| f64::hypot(a[0] - b[0], a[1] - b[1]);
        let differences = [
            (a.state.time - b.state.time).abs() / self.units.time,
            apart(a.state.position, b.state.position) / self.units.length,
            apart(a.state.velocity, b.state.velocity) / self.units.speed,
            (a.normal_speed - b.normal_speed).abs() / self.units.speed,
            (a.state.spin - b.state.spin).abs() / self.spin_unit,
        ];
        Some(differences.into_iter().fold(0.0, f64::max))
    }
}

/// The scene with each of its numbers changed a little, one at a time.
fn changed(scene: &Scene) -> Vec<Scene> {
    let more = 1.0 + CHANGE;
    let with = |change: &dyn Fn(&mut Scene)| {
        let mut scene = scene.clone();
        change(&mut scene);
        scene
    };
    let mut all = vec![
        with(&|s| s.rotor.spin *= more),
        with(&|s| s.rotor.polar_inertia *= more),
        with(&|s| s.retainer.friction *= more),
        with(&|s| s.retainer.restitution *= 1.0 - CHANGE),
    ];
    match scene.start {
        Start::Free { position, velocity } => {
            let unit = Units::of(scene);
            for axis in 0..2 {
                // Inward, so that a start on the wall stays in the gap.
                let mut position = position;
                position[axis] -= CHANGE * unit.length * position[axis].signum();
                all.push(with(&|s| s.start = free(position, velocity)));
            }
            for axis in 0..2 {
                let mut velocity = velocity;
                velocity[axis] += CHANGE * unit.speed.max(velocity[axis].abs());
                all.push(with(&|s| s.start = free(position, velocity)));
            }
        }
        Start::Wall { angle, tangential } => {
            all.push(with(&|s| s.start = wall(angle + CHANGE, tangential)));
            all.push(with(&|s| s.start = wall(angle, tangential * more)));
        }
    }
    all
}
