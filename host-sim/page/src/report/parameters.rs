//! What was assumed: parameters, limits of the model, versions.

use maud::{Markup, html};
use std::f64::consts::PI;
use touchdown_chart::text::{si, significant};
use touchdown_run::explain::numbers::{scales, speeds};
use touchdown_scene::parts::{parts, removable};
use touchdown_scene::scales::validity;
use touchdown_scene::{Removable, Scene};

/// Physical and dimensionless parameters and those of the run.
pub fn parameters(scene: &Scene) -> Markup {
    let machine = &scene.machine();
    let rpm = significant(scene.rotor.spin * 30.0 / PI, 6);
    let turn = match scene.rotor.spin {
        0.0 => "",
        0.0.. => ", counter-clockwise",
        _ => ", clockwise",
    };
    let inertia = significant(machine.polar_inertia, 5);
    let gravity = significant(machine.gravity, 5);
    let physical = [
        ("Mass", si(machine.mass, "kg")),
        ("Rotor radius at the retainer", si(machine.radius, "m")),
        ("Polar inertia", format!("{inertia}\u{a0}kg\u{a0}m\u{b2}")),
        ("Radial clearance", si(machine.clearance, "m")),
        ("Spin at the release", format!("{rpm}\u{a0}rpm{turn}")),
        ("Gravity", format!("{gravity}\u{a0}m/s\u{b2}")),
    ];
    let run = [
        ("Duration", si(scene.run.duration, "s")),
        ("Sample rate", si(scene.run.sample_rate, "Hz")),
        (
            "Sensor noise, standard deviation",
            si(scene.sensors.noise, "m"),
        ),
        ("Noise seed", scene.run.seed.to_string()),
        ("Model precision", scene.model.precision.to_string()),
        ("Model output interval", si(scene.model.step, "s")),
    ];
    html! {
        div.pair {
            div { (list("Rotor and retainer", &physical)) }
            div { (list("Run", &run)) }
        }
        div.pair {
            div { (list("Dimensionless numbers and scales", &scales(scene))) }
            div { (list("Speeds and times", &speeds(scene))) }
        }
    }
}

fn list(name: &str, rows: &[(&str, String)]) -> Markup {
    html! {
        h3 { (name) }
        table.list { tbody { @for (name, value) in rows { tr { th scope="row" { (name) } td.number { (value) } } } } }
    }
}

/// What the model leaves out; `forces`: it gives impacts a force and a duration.
pub fn limits(scene: &Scene, forces: bool) -> Markup {
    let parts = parts(scene);
    let out = parts.iter().filter(|part| !part.modelled);
    let is_fixed = !removable(scene).contains(&Removable::Mount);
    html! {
        ul {
            @for part in out { li { (part.name) ": " (part.reason) "." } }
            @if let Some(validity) = validity(scene) { li { (validity) } }
            @if is_fixed {
                li { "In reality the support caps the whirl frequency. Whirl speeds and the loads computed from them are therefore upper bounds." }
            }
            @if forces {
                li { "In the reference an impact takes no time; the model's contact force is that of an elastic wall with damping, without tangential compliance or plastic flow." }
            } @else {
                li { "An impact takes no time: impulses are given, contact forces and contact durations are not." }
            }
            li { "Friction is Coulomb's, with one constant coefficient; restitution does not depend on speed." }
            li { "Truth here is the reference solution of the same equations, not a measurement." }
        }
    }
}

pub fn versions() -> Markup {
    html! { dl.versions { div { dt { "touchdown" } dd { (env!("CARGO_PKG_VERSION")) } } } }
}
