//! The rotor, its retainer, and how it starts.

use super::diagnostic::Diagnostic;
use super::file::{RetainerTable, RotorTable, StartTable};
use super::rule::{Keys, MILLI, ON_THE_WALL, RPM};
use super::{Retainer, Rotor, Start, limits};
use touchdown_base::plain::Number;

/// Checks `[rotor]`, of which the numbers are within their limits.
pub fn rotor(table: &RotorTable) -> Result<Rotor, Diagnostic> {
    let (mass, radius) = (table.mass_kg, MILLI * table.radius_mm);
    let solid = 0.5 * mass * radius * radius;
    let polar_inertia = table.polar_inertia_kg_m2.unwrap_or(solid);
    if !limits::INERTIA_RATIO.contains(&(polar_inertia / solid)) {
        let (low, high) = limits::INERTIA_RATIO.into_inner();
        let is = Number(polar_inertia);
        let rule = format!(
            "polar_inertia_kg_m2 must be {low} to {high} times that of a solid cylinder ({solid:.3e}), is {is}"
        );
        return Err(Diagnostic::new("rotor", "polar_inertia_kg_m2", rule));
    }
    Ok(Rotor {
        mass,
        radius,
        polar_inertia,
        spin: RPM * table.speed_rpm,
    })
}

impl From<&RetainerTable> for Retainer {
    fn from(table: &RetainerTable) -> Self {
        Self {
            clearance: MILLI * table.clearance_mm,
            friction: table.friction,
            restitution: table.restitution,
        }
    }
}

/// A free start must be within `clearance`, m.
pub(super) fn start(table: &StartTable, clearance: f64) -> Result<Start, Diagnostic> {
    const KEYS: Keys = Keys("start");
    let free = [
        ("x_mm", table.x_mm),
        ("y_mm", table.y_mm),
        ("vx_mm_s", table.vx_mm_s),
        ("vy_mm_s", table.vy_mm_s),
    ];
    let wall = [
        ("angle_deg", table.angle_deg),
        ("tangential_mm_s", table.tangential_mm_s),
    ];
    let first = |keys: &[(&'static str, Option<f64>)]| {
        let given = keys.iter().find(|(_, value)| value.is_some());
        given.map(|(key, _)| *key)
    };
    if let Some(wall_key) = first(&wall) {
        if let Some(free_key) = first(&free) {
            let rule = format!(
                "{wall_key} starts the rotor on the wall, {free_key} starts it free: give one kind"
            );
            return Err(KEYS.broken(wall_key, rule));
        }
        return Ok(Start::Wall {
            angle: table.angle_deg.unwrap_or(0.0).to_radians(),
            tangential: MILLI * table.tangential_mm_s.unwrap_or(0.0),
        });
    }
    let [x, y, vx, vy] = free.map(|(_, value)| MILLI * value.unwrap_or(0.0));
    let distance = x.hypot(y);
    if distance > clearance * (1.0 + ON_THE_WALL) {
        let key = if x.abs() > y.abs() { "x_mm" } else { "y_mm" };
        let [distance, clearance] = [distance, clearance].map(|it| Number(it / MILLI));
        let rule = format!(
            "the start is outside the gap: {distance} mm from the centre, the clearance is {clearance} mm"
        );
        return Err(KEYS.broken(key, rule));
    }
    Ok(Start::Free {
        position: [x, y],
        velocity: [vx, vy],
    })
}
