//! The rotor, its retainer, and how it starts.

use super::diagnostic::Diagnostic;
use super::file::{RetainerTable, RotorTable, StartTable};
use super::rule::{Keys, MILLI, ON_THE_WALL, RPM};
use super::{Retainer, Rotor, Start, limits};
use touchdown_base::plain::Number;

/// Checks `[rotor]`.
pub fn rotor(table: &RotorTable) -> Result<Rotor, Diagnostic> {
    const KEYS: Keys = Keys("rotor");
    let mass = KEYS.within("mass_kg", table.mass_kg, limits::MASS_KG)?;
    let radius = MILLI * KEYS.within("radius_mm", table.radius_mm, limits::RADIUS_MM)?;
    let solid = 0.5 * mass * radius * radius;
    let polar_inertia = table.polar_inertia_kg_m2.unwrap_or(solid);
    KEYS.above_zero("polar_inertia_kg_m2", polar_inertia)?;
    if !limits::INERTIA_RATIO.contains(&(polar_inertia / solid)) {
        let (low, high) = limits::INERTIA_RATIO.into_inner();
        let is = Number(polar_inertia);
        let rule = format!(
            "polar_inertia_kg_m2 must be {low} to {high} times that of a solid cylinder ({solid:.3e}), is {is}"
        );
        return Err(KEYS.broken("polar_inertia_kg_m2", rule));
    }
    let speed = KEYS.between("speed_rpm", table.speed_rpm, limits::SPEED_RPM)?;
    Ok(Rotor {
        mass,
        radius,
        polar_inertia,
        spin: RPM * speed,
    })
}

/// Checks `[retainer]`.
pub fn retainer(table: &RetainerTable) -> Result<Retainer, Diagnostic> {
    const KEYS: Keys = Keys("retainer");
    let clearance = KEYS.within("clearance_mm", table.clearance_mm, limits::CLEARANCE_MM)?;
    Ok(Retainer {
        clearance: MILLI * clearance,
        friction: KEYS.within("friction", table.friction, limits::FRICTION)?,
        restitution: KEYS.between("restitution", table.restitution, 0.0..=1.0)?,
    })
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
        let angle = table.angle_deg.unwrap_or(0.0);
        let angle = KEYS.between("angle_deg", angle, limits::ANGLE_DEG)?;
        let speed = table.tangential_mm_s.unwrap_or(0.0);
        let speed = KEYS.between("tangential_mm_s", speed, limits::SPEED_MM_S)?;
        return Ok(Start::Wall {
            angle: angle.to_radians(),
            tangential: MILLI * speed,
        });
    }
    for (key, speed) in &free[2..] {
        KEYS.between(key, speed.unwrap_or(0.0), limits::SPEED_MM_S)?;
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
