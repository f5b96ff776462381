//! What a scene models, what it leaves out, and the numbers that decide how it goes.

use std::f64::consts::PI;
use std::fmt::Write;

use super::{Contact, Rung, Scene, Start};
use crate::model_run::compliance;
use crate::sensors::SensorsConfig;

/// The explanation, for people.
pub fn explain(scene: &Scene) -> String {
    let mut text = format!("{}\n", scene.heading());
    if let Some(source) = &scene.source {
        text += &format!("source: {source}\n");
    }
    section(&mut text, "Model", &model(scene));
    if scene.model.rung == Rung::Hertz {
        section(&mut text, "Contact", &contact(scene));
    }
    section(&mut text, "Left out", &left_out(scene.model.rung));
    section(&mut text, "Scales", &scales(scene));
    section(&mut text, "Speeds and times", &speeds(scene));
    section(&mut text, "Sensors", &sensors(&scene.sensors, scene));
    text
}

type Row = (&'static str, String);

fn section(text: &mut String, title: &str, rows: &[Row]) {
    let _ = write!(text, "\n{title}\n");
    for (name, value) in rows {
        let _ = writeln!(text, "  {name:<37}{value}");
    }
}

fn model(scene: &Scene) -> Vec<Row> {
    let precision = scene.model.precision.name();
    let step = scene.model.step * 1e6;
    let (rung, wall, step) = match scene.model.rung {
        Rung::Rigid => (
            "rigid: impacts take no time",
            "slide, roll and lift-off on a fixed ring",
            format!("{step:.4} us, output only: impacts lie between steps"),
        ),
        Rung::Moreau => (
            "moreau: impacts take no time, and lie in the middle of a step",
            "slide, roll and lift-off on a fixed ring",
            format!("{step:.4} us; times are off by about as much an impact"),
        ),
        Rung::Hertz => (
            "hertz: impacts have a force and take time",
            "slide, roll and lift-off on a fixed, soft ring",
            format!("{step:.4} us; the limits stand below"),
        ),
    };
    let start = match scene.start {
        Start::Free { .. } => "released in the gap, after 0.2 s of levitation",
        Start::Wall { .. } => "on the wall; the detector starts cold",
    };
    vec![
        ("rung", rung.to_owned()),
        ("scheme", scene.model.scheme.name().to_owned()),
        ("degrees of freedom", "3: x, y, spin".to_owned()),
        (
            "impact",
            "restitution; Coulomb friction up to sticking".to_owned(),
        ),
        ("contact", wall.to_owned()),
        ("number format", precision.to_owned()),
        ("step", step),
        ("start", start.to_owned()),
        (
            "truth",
            "independent event-located solution in f64".to_owned(),
        ),
    ]
}

fn contact(scene: &Scene) -> Vec<Row> {
    let exponent = match scene.materials.contact {
        Contact::Point => "1.5",
        Contact::Line { .. } => "1",
    };
    let Ok(compliance) = compliance(scene) else {
        return Vec::new();
    };
    let micros = |seconds: f64| format!("{:.4} us", seconds * 1e6);
    vec![
        ("shape", scene.materials.contact.name().to_owned()),
        (
            "K, force is K d^n",
            format!("{:.6e} N/m^{exponent}", compliance.stiffness),
        ),
        (
            "fastest impact: force, depth",
            format!(
                "{:.1} N, {:.4} um",
                compliance.peak_force,
                compliance.deepest * 1e6
            ),
        ),
        ("omega_c, there", format!("{:.1} rad/s", compliance.rate)),
        ("T_c, its duration", micros(compliance.contact_time)),
        (
            "steps: accurate, longest",
            format!(
                "{}, {}",
                micros(compliance.accurate_step()),
                micros(compliance.longest_step())
            ),
        ),
    ]
}

fn left_out(rung: Rung) -> Vec<Row> {
    let parts = [
        ("contact force and its duration", "rung hertz"),
        ("retainer's mass, spring, inner ring", "rung support"),
        ("tilt, gyroscopic effect, unbalance", "rung two-plane"),
        ("shaft bending, heat, wear", "no rung"),
    ];
    let skipped = usize::from(rung == Rung::Hertz);
    let parts = parts.iter().skip(skipped);
    parts
        .map(|(part, rung)| (*part, (*rung).to_owned()))
        .collect()
}

fn scales(scene: &Scene) -> Vec<Row> {
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
        rows.push((
            "T = sqrt(rho0/g)",
            millis((clearance / machine.gravity).sqrt()),
        ));
        rows.push(("V = sqrt(g rho0)", format!("{:.4} mm/s", speed * 1e3)));
        rows.push((
            "W0 = r spin/V",
            format!("{:.2}", machine.radius * scene.rotor.spin / speed),
        ));
    } else {
        rows.push(("T, V, W0", "none: no gravity".to_owned()));
    }
    rows
}

fn speeds(scene: &Scene) -> Vec<Row> {
    let machine = scene.machine();
    let (gravity, clearance, mu) = (machine.gravity, machine.clearance, machine.friction);
    if gravity == 0.0 {
        return vec![(
            "without gravity",
            "flight is straight; any contact goes round".to_owned(),
        )];
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
        rows.push((
            "whirl from the bottom above",
            format!("{rate:.2} rad/s, {:.4} mm/s along the wall", speed * 1e3),
        ));
        if mu > 0.0 {
            rows.push((
                "its growth time rho0/(mu v)",
                millis(clearance / (mu * speed)),
            ));
        }
    }
    if machine.restitution < 1.0 {
        let last = (1.0 + machine.restitution) / (1.0 - machine.restitution);
        rows.push(("straight drop at rest after", millis(hit / gravity * last)));
    }
    rows
}

fn sensors(config: &SensorsConfig, scene: &Scene) -> Vec<Row> {
    let resolution = config.resolution();
    // A uniform error of one count has this standard deviation.
    let noise = config.noise.hypot(resolution / 12_f64.sqrt());
    let channels = f64::from(config.planes);
    let bandwidth = config.bandwidth.map_or_else(
        || "not modelled".to_owned(),
        |corner| format!("{corner} Hz"),
    );
    let mut rows = vec![
        ("planes", config.planes.to_string()),
        ("sample rate", format!("{} Hz", scene.run.sample_rate)),
        ("range", format!("+-{} um", short(config.range * 1e6))),
        (
            "one count",
            format!("{:.4} um ({} bits)", resolution * 1e6, config.bits),
        ),
        (
            "noise of a channel",
            format!("{:.4} um rms with rounding", noise * 1e6),
        ),
        (
            "noise of the mean position",
            format!("{:.4} um rms", noise * 1e6 / channels.sqrt()),
        ),
        ("bandwidth", bandwidth),
        ("speed signal", yes(config.speed)),
        ("levitation signal", yes(config.levitation_signal)),
    ];
    let distorts = config.runout > 0.0
        || config.nonlinearity != 0.0
        || config
            .offset
            .iter()
            .chain(&config.gain_error)
            .any(|value| *value != 0.0);
    let distortion = if distorts {
        "as the scene asks"
    } else {
        "none"
    };
    rows.push(("runout, gain, offset, curve", distortion.to_owned()));
    rows
}

fn millis(seconds: f64) -> String {
    format!("{:.4} ms", seconds * 1e3)
}

fn short(value: f64) -> f64 {
    (value * 1e6).round() / 1e6
}

fn yes(wired: bool) -> String {
    if wired { "yes" } else { "no" }.to_owned()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_rig_has_the_known_numbers() {
        let scene = Scene::load("rig").unwrap();
        let text = explain(&scene);
        for number in [
            "334.",
            "7.8206 ms",
            "5.5300 ms",
            "54.2494 mm/s",
            "-1389.84",
            "28.780 Hz",
        ] {
            assert!(text.contains(number), "{number} in\n{text}");
        }
    }

    #[test]
    fn a_scene_without_gravity_is_explained_too() {
        let text = crate::scene::BUILT_IN[0]
            .text
            .replace("duration_s", "gravity_m_s2 = 0\nduration_s");
        assert!(explain(&Scene::parse("s", &text).unwrap()).contains("no gravity"));
    }
}
