//! The scales and the numbers that decide how a scene goes.

use std::f64::consts::PI;

use super::Row;
use touchdown_scene::Scene;

/// Clearance, laws and units.
pub fn scales(scene: &Scene) -> Vec<Row> {
    let machine = scene.machine();
    let clearance = machine.clearance;
    let beta = machine.polar_inertia / (machine.mass * machine.radius * machine.radius);
    let mut rows = vec![
        ("rho0, clearance", format!("{:.6} mm", clearance * 1e3)),
        ("mu, friction", machine.friction.to_string()),
        ("eps, restitution", machine.restitution.to_string()),
        ("beta = J/(m r^2)", format!("{beta:.6}")),
    ];
    if machine.gravity > 0.0 {
        let speed = (machine.gravity * clearance).sqrt();
        let time = (clearance / machine.gravity).sqrt();
        let surface = machine.radius * scene.rotor.spin / speed;
        rows.extend([
            ("T = sqrt(rho0/g)", millis(time)),
            ("V = sqrt(g rho0)", format!("{:.4} mm/s", speed * 1e3)),
            ("W0 = r spin/V", format!("{surface:.2}")),
        ]);
    } else {
        rows.push(("T, V, W0", "none: no gravity".to_owned()));
    }
    rows
}

/// How fast it falls, swings and whirls.
pub fn speeds(scene: &Scene) -> Vec<Row> {
    let machine = scene.machine();
    let (gravity, clearance, mu) = (machine.gravity, machine.clearance, machine.friction);
    if gravity == 0.0 {
        let how = "flight is straight; any contact goes round";
        return vec![("without gravity", how.to_owned())];
    }
    let fall = (2.0 * clearance / gravity).sqrt();
    let hit = (2.0 * gravity * clearance).sqrt();
    let swing = (gravity / clearance).sqrt() / (2.0 * PI);
    let mut rows = vec![
        ("fall from the centre", millis(fall)),
        ("speed at the wall then", format!("{:.4} mm/s", hit * 1e3)),
        ("swing at the bottom, sliding", format!("{swing:.3} Hz")),
    ];
    // Contact kept over the top, started at the bottom, friction driving all the way.
    let factor = 3.0 * (1.0 + (-2.0 * PI * mu).exp()) / (1.0 + 4.0 * mu * mu) - 1.0;
    if factor > 0.0 {
        let rate = (gravity / clearance * factor).sqrt();
        let speed = rate * clearance;
        let above = format!("{rate:.2} rad/s, {:.4} mm/s along the wall", speed * 1e3);
        rows.push(("whirl from the bottom above", above));
        if mu > 0.0 {
            let growth = millis(clearance / (mu * speed));
            rows.push(("its growth time rho0/(mu v)", growth));
        }
    }
    if machine.restitution < 1.0 {
        let last = (1.0 + machine.restitution) / (1.0 - machine.restitution);
        rows.push(("straight drop at rest after", millis(hit / gravity * last)));
    }
    rows
}

fn millis(seconds: f64) -> String {
    format!("{:.4} ms", seconds * 1e3)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn whirl_speed_of_the_rig() {
        let speeds = speeds(&Scene::load("rig").unwrap());
        let whirl = speeds
            .iter()
            .find(|it| it.0 == "whirl from the bottom above");
        let (_, text) = whirl.unwrap();
        assert!(text.starts_with("334.59 rad/s"), "{text}");
    }
}
