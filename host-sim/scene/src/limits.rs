//! What a machine can be: limits far beyond any built, inside which all arithmetic stays finite.

use std::ops::RangeInclusive;

use touchdown_base::plain::Number;

use Limit::{AboveZero, Between, Within};

/// What a number must be.
#[derive(Clone, Debug)]
pub enum Limit {
    /// Above 0.
    AboveZero,
    /// In a range that begins at 0 or above; what is on the wrong side of 0 is told so.
    Within(RangeInclusive<f64>),
    /// In a range.
    Between(RangeInclusive<f64>),
}
impl Limit {
    /// The rule that a number breaks, if it does.
    pub(super) fn broken(&self, value: f64) -> Option<String> {
        match self {
            AboveZero if value <= 0.0 => Some("above 0".to_owned()),
            Within(range) if *range.start() > 0.0 && value <= 0.0 => AboveZero.broken(value),
            Within(_) if value < 0.0 => Some("0 or more".to_owned()),
            Within(range) | Between(range) if !range.contains(&value) => {
                let [low, high] = [range.start(), range.end()].map(|it| Number(*it));
                Some(format!("{low} to {high}"))
            }
            _ => None,
        }
    }
}

/// Limits of numbers in a table of a controller's configuration, or in the same of a scene.
pub fn of_machine(table: &str, key: &str) -> Option<Limit> {
    Some(match (table, key) {
        ("rotor", "mass_kg") => Within(MASS_KG),
        ("rotor", "radius_mm") => Within(RADIUS_MM),
        ("rotor", "polar_inertia_kg_m2") => AboveZero,
        ("rotor", "speed_rpm") => Between(SPEED_RPM),
        ("retainer", "clearance_mm") => Within(CLEARANCE_MM),
        ("retainer", "friction") => Within(FRICTION),
        ("retainer", "restitution") => Between(0.0..=1.0),
        ("run", "gravity_m_s2") => Within(0.0..=1e3),
        _ => return None,
    })
}

/// Limits of numbers in a table of a scene, also where that stands in a ring's row.
pub(super) fn of_scene(table: &str, key: &str) -> Option<Limit> {
    Some(match (table, key) {
        ("ring", "radius_mm") => Between(RADIUS_MM),
        ("ring", "clearance_mm") | ("stator", "gap_mm") => Between(CLEARANCE_MM),
        ("ring", "friction") => Between(FRICTION),
        ("ring", "restitution") => Between(0.0..=1.0),
        ("ring" | "magnet", "z_mm") => Between(PLACE_MM),
        ("two_plane", "sensor_z_mm") | ("mode", "at_mm") => Between(PLACE_MM),
        ("support", "mass_kg") | ("mode", "modal_mass_kg") => Within(MASS_KG),
        ("support" | "ball_bearing", "stiffness_n_m") => Within(STIFFNESS_N_M),
        ("support", "vertical_stiffness_n_m" | "stop_stiffness_n_m") => Within(STIFFNESS_N_M),
        ("support", "damping_n_s_m" | "vertical_damping_n_s_m") => Within(DAMPING_N_S_M),
        ("support", "dry_friction_n") => Between(0.0..=1e9),
        ("support", "travel_mm") => Within(1e-3..=100.0),
        ("ball_bearing", "inner_ring_inertia_kg_m2") => Within(1e-12..=1e6),
        ("ball_bearing", "dry_drag_n_m" | "viscous_drag_n_m_s") => Within(0.0..=1e6),
        // Over the speed of the inner ring; 1/2 with balls of no size.
        ("ball_bearing", "cage_ratio") => Between(0.05..=0.49),
        ("ball_bearing", "heat_capacity_j_k") => Within(1e-3..=1e9),
        ("ball_bearing", "heat_loss_w_k") => Within(0.0..=1e6),
        ("ball_bearing", "inner_ring_marks" | "cage_marks") => Between(1.0..=1000.0),
        ("two_plane", "transverse_inertia_kg_m2") => AboveZero,
        ("two_plane", "rotor_length_mm") | ("materials", "length_mm") => Within(0.01..=1e5),
        ("two_plane", "unbalance_g_mm") => Between(0.0..=1e9),
        ("two_plane", "unbalance_deg" | "skew_deg" | "gravity_deg") => Between(ANGLE_DEG),
        ("two_plane", "skew_mrad") => Between(0.0..=100.0),
        ("two_plane", "tilt_mrad" | "tilt_rate_rad_s") => Between(-1e4..=1e4),
        ("two_plane", "elastic_mode_hz") | ("mode", "frequency_hz") => Between(1.0..=1e6),
        ("mode", "damping_ratio") => Between(0.0..=1.0),
        ("mode", "shape") => Between(-1e3..=1e3),
        ("magnet", "damping_n_s_m") => Between(DAMPING_N_S_M),
        ("magnet", "force_n") => Between(-1e9..=1e9),
        ("magnet", "limit_n") => Within(1e-6..=1e9),
        ("magnet", "from_s" | "until_s") => Between(0.0..=86_400.0),
        ("base", "amplitude_mm") => Between(-1e4..=1e4),
        ("base", "frequency_hz") => Between(1e-3..=1e4),
        ("base", "phase_deg") | ("start", "angle_deg") => Between(ANGLE_DEG),
        ("start", "vx_mm_s" | "vy_mm_s" | "tangential_mm_s") => Between(SPEED_MM_S),
        ("run" | "fault", "duration_s") => AboveZero,
        ("run", "inclination_deg") => Between(-90.0..=90.0),
        ("run", "sample_rate_hz") => Between(100.0..=200_000.0),
        ("model", "step_us") => Between(STEP_US),
        ("model", "cutoff_mm_s") => Between(0.0..=1.0),
        // From foam to beyond diamond.
        ("materials", "rotor_modulus_gpa" | "retainer_modulus_gpa") => Within(1e-3..=1e4),
        ("materials", "rotor_poisson" | "retainer_poisson") => Between(0.0..=0.5),
        ("fault", "size") => Between(-1e6..=1e6),
        _ => return of_machine(table, key),
    })
}

/// Mass of a rotor or a ring, kg.
pub const MASS_KG: RangeInclusive<f64> = 1e-6..=1e6;
/// Rotor radius, mm.
pub const RADIUS_MM: RangeInclusive<f64> = 0.01..=1e5;
/// Polar inertia in units of a solid cylinder's.
pub const INERTIA_RATIO: RangeInclusive<f64> = 1e-3..=1e3;
/// Spin, 1/min.
pub const SPEED_RPM: RangeInclusive<f64> = -1e7..=1e7;
/// Radial clearance, mm.
pub const CLEARANCE_MM: RangeInclusive<f64> = 1e-3..=100.0;
/// Coulomb's coefficient.
const FRICTION: RangeInclusive<f64> = 0.0..=100.0;
const ANGLE_DEG: RangeInclusive<f64> = -36e3..=36e3;
/// Speed of a start, each component, mm/s.
pub const SPEED_MM_S: RangeInclusive<f64> = -1e6..=1e6;
/// Least gravity but 0, m/s^2: below it, it sets a time scale longer than any run.
pub const LEAST_GRAVITY_M_S2: f64 = 1e-6;
/// Length of a step, us.
pub const STEP_US: RangeInclusive<f64> = 1.0..=1000.0;
/// Tilt up to which the axis' displacements are small, rad: its sine is off by 1/600 there.
pub const SMALL_TILT: f64 = 0.1;
/// What the fastest motion may turn in a step of fidelity `coupled` that nobody gave, rad: the midpoint rule is
/// late by its square over 12. Beyond five times that much a given step is warned of.
pub const ANGLE_OF_STEP: f64 = 0.1;
/// Longest such step, s: bounces shorter than a step are left out.
pub const RESOLVED: f64 = 1e-5;
/// Most such steps of a run: a few seconds.
pub const STEPS: f64 = 1e5;
/// Stiffness of a support, magnet, stop or ball bearing, N/m.
pub(super) const STIFFNESS_N_M: RangeInclusive<f64> = 1.0..=1e12;
const DAMPING_N_S_M: RangeInclusive<f64> = 0.0..=1e9;
/// Axial, from the centre of mass, mm.
const PLACE_MM: RangeInclusive<f64> = -1e5..=1e5;
/// Polar over transverse inertia; 2 for a thin disc.
pub const GYROSCOPIC_RATIO: RangeInclusive<f64> = 1e-6..=2.0;

#[cfg(test)]
mod tests {
    use super::*;

    /// Of docs/use/scene.md: table, key and range of each row whose range is two numbers.
    fn told() -> Vec<(String, String, RangeInclusive<f64>)> {
        let text = include_str!("../../../docs/use/scene.md");
        let (mut table, mut all) = (String::new(), vec![]);
        for line in text.lines().filter(|it| it.starts_with('|')) {
            let cells: Vec<_> = line.trim_matches('|').split('|').map(str::trim).collect();
            let names = cells[0].split('`').skip(1).step_by(2);
            if cells[0].starts_with("**") {
                table = names
                    .map(|it| it.trim_matches(['[', ']']).to_owned())
                    .collect();
                continue;
            }
            let range = cells.get(3).and_then(|it| it.split_once(" to "));
            let Some((low, high)) = range else { continue };
            // Where keys of several units share a row, the range is the first one's.
            let most = if cells[1].contains(',') { 1 } else { 9 };
            if let (Ok(low), Ok(high)) = (low.parse(), high.parse()) {
                let keys = names.take(most);
                all.extend(keys.map(|key| (table.clone(), key.to_owned(), low..=high)));
            }
        }
        all
    }

    /// Those of sensors, detector and guard are their own.
    #[test]
    fn the_ranges_of_the_documentation_are_these() {
        let mut held = 0;
        for (table, key, range) in told() {
            match of_scene(&table, &key) {
                Some(Between(its) | Within(its)) => assert_eq!(its, range, "[{table}] {key}"),
                Some(AboveZero) => panic!("[{table}] {key} has no range"),
                None => {
                    let elsewhere = ["sensors", "detector", "guard"].contains(&&*table);
                    assert!(elsewhere, "[{table}] {key} has no limit");
                    continue;
                }
            }
            held += 1;
        }
        assert!(held > 40, "{held}");
    }
}
